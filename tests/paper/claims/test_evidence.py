"""In invented data nearly all claims are reproduced. Changes of the data change verdicts."""

import numpy as np
import pytest
from helpers.changes import assign, each, power, put, renamed, scale, share, unstable
from helpers.made_up import (
    LINEAR,
    PEAKS,
    damped_branches,
    damper,
    parameters,
    policies,
    quiet_size,
    subharmonic,
    world,
)
from helpers.made_up_orbits import branch, branches

from chatterjee1995.claims.claim import DIFFERENT, NOT_REPRODUCED, REPRODUCED
from chatterjee1995.claims.verdicts import CLAIMS, claims
from chatterjee1995.reading.datasets import ELASTIC
from impact_damper.data.datasets import flag

BY_NUMBER = {claim.number: claim for claim in CLAIMS}
PEAK = PEAKS[0.215]


@pytest.fixture
def data():
    return world()


def test_all_are_reproduced_in_a_world_made_so():
    table = claims(world()).set_index("number")
    expected = dict.fromkeys(BY_NUMBER, REPRODUCED) | {"15": DIFFERENT}
    expected |= {f"S{k}": "the print is consistent" for k in range(1, 4)}
    expected["S4"] = "the printed value is a right rounding"
    expected["S5"] = "a printed value is wrong"
    expected["S6"] = "the values chosen are consistent"
    assert table.verdict.to_dict() == expected


def unstable_balance(ratio):
    """Return the change that makes (7) unstable near the frequency `ratio` Wp."""

    def change(data):
        old = data["harmonic_balance"]["figure_03b"]
        kept = np.abs(old.frequency / LINEAR[1.0] - ratio) > 0.01
        stability = old.stability.where(kept, flag("stability", "unstable"))
        data["harmonic_balance"]["figure_03b"] = old.assign(stability=stability)

    return change


def orbits_times(factor, names=ELASTIC, variable="orbit_displacement"):
    """Return the change that multiplies a variable of exact orbits by a factor."""
    return each(names, lambda name: scale("branches", name, **{variable: factor}))


def optima_times(factor):
    """Return the change that multiplies `analytical_optimum` by a factor. It was (optimum)/1.05."""
    return each(world()["optimum"], lambda name: scale("optimum", name, analytical_optimum=factor))


def copied(name, source):
    """Return the change that gives the curve `name` the branches of the curve `source`."""
    return put("branches", name, world()["branches"][source])


FEW = each(ELASTIC, lambda name: scale("response", name, contacts=0.5))
WIDE = each(ELASTIC, lambda name: scale("harmonic_balance", name, edge_frequency=[0.2, 1]))
RISE = scale("optimum", "0.215_0.12_1.0", quiet_displacement=1.5, optimum_displacement=1.5)
THIRD = put("branches", "figure_08", damped_branches("figure_08", third=0.8))
# Number of a claim, a change of the data, and the verdict after this change.
CHANGES = [
    ("1", scale("harmonic_balance", "figure_03a_rule", quiet_amplitude=1000), NOT_REPRODUCED),
    ("2", scale("harmonic_balance", "figure_05a", rigid_amplitude=1.1), NOT_REPRODUCED),
    ("3", unstable_balance(1.08), NOT_REPRODUCED),
    ("3", unstable("figure_05a", 1.08, 1.2), DIFFERENT),
    ("4", scale("harmonic_balance", "figure_03b", band_width=0.78), NOT_REPRODUCED),
    ("4", assign("design_orbit", "figure_03b", orbit_multiplier_real=1.01), DIFFERENT),
    ("4", scale("harmonic_balance", "figure_03b", reduction=0.89), NOT_REPRODUCED),
    ("5", assign("branches", "figure_05b", orbit_contacts=3.0), NOT_REPRODUCED),
    ("6", FEW, NOT_REPRODUCED),
    ("6", assign("response", "figure_05b", outcome=flag("outcome", "chaotic")), DIFFERENT),
    ("6", orbits_times(0.9, variable="orbit_amplitude"), NOT_REPRODUCED),
    ("7", scale("branches", "figure_05a", orbit_phase_relative=0.5), NOT_REPRODUCED),
    ("8", scale("collisions", "figure_05a", colliding=0.995), DIFFERENT),
    ("9", scale("optimum", "0.215_0.12_1.0", optimum_clearance=0.9), NOT_REPRODUCED),
    ("9", RISE, DIFFERENT),
    ("9", optima_times(0.87), DIFFERENT),
    ("10", copied("figure_05b", "figure_05c"), NOT_REPRODUCED),
    ("11", copied("figure_10", "figure_05c"), NOT_REPRODUCED),
    ("11", scale("optimum", "0.215_0.12_0.75", quiet_displacement=1.5), DIFFERENT),
    ("12", share("figure_13", "quiet", 0.001), NOT_REPRODUCED),
    ("13", share("figure_15", "quiet", 0.0), NOT_REPRODUCED),
    ("14", scale("migration", "figure_13", within_share=0.4), DIFFERENT),
    ("15", renamed("response", "figure_10", restitution=0.2), NOT_REPRODUCED),
    ("16", orbits_times(1.2), REPRODUCED),
    ("16", orbits_times(1.3, ["figure_08"]), DIFFERENT),
    ("16", WIDE, NOT_REPRODUCED),
    ("17", scale("optimum", "0.215_0.18_1.0", quiet_displacement=1.08), DIFFERENT),
    ("17", scale("branches", "figure_05c", orbit_displacement=10), NOT_REPRODUCED),
    ("18", THIRD, DIFFERENT),
    ("19", scale("migration", "figure_16", reached_share=0.9), DIFFERENT),
    ("S1", power, NOT_REPRODUCED),
    ("S2", renamed("harmonic_balance", "figure_03a", clearance=1.57), NOT_REPRODUCED),
    ("S4", renamed("harmonic_balance", "figure_05a", clearance=2.2), NOT_REPRODUCED),
    ("S6", renamed("harmonic_balance", "figure_08", clearance=1.07), NOT_REPRODUCED),
    ("S6", renamed("optimum", "0.215_0.12_0.75", frequency=1.0), NOT_REPRODUCED),
]


@pytest.mark.parametrize(("number", "change", "verdict"), CHANGES)
def test_verdict_changes_at_the_border(number, change, verdict, data):
    change(data)
    row = BY_NUMBER[number].judge(data)
    assert row["verdict"] == BY_NUMBER[number].verdicts.get(verdict, verdict), row["evidence"]


def test_a_fourth_component_of_the_state_is_counted(data):
    motion = data["motion"]["figure_04"]
    data["motion"]["figure_04"] = motion.assign(relative_velocity=motion.velocity)
    assert BY_NUMBER["S3"].judge(data)["verdict"] == "the print is incomplete"


def damped(*parts, mass_ratio):
    """Return branches with a damper: quiet orbits at all frequencies, and `parts`."""
    frequency = np.linspace(0.5, 1.5, 201) * PEAK
    size, phase = quiet_size(frequency, PEAK, mass_ratio), np.where(frequency < PEAK, np.pi, 0.0)
    made = parameters(**damper(mass_ratio, PEAK))
    return branches(branch(frequency, size, phase=phase), *parts, parameters=made)


@pytest.mark.parametrize(("overlap", "expected"), [(0.004, REPRODUCED), (0.006, DIFFERENT)])
def test_regions_of_contact_number_overlap(overlap, expected, data):
    """Violent orbits with four contacts end at W = 1.9; orbits with six begin shortly below 1.9."""
    below, above = np.array([1.0, 1.5, 1.9]), np.array([1.9 - overlap, 1.93, 1.95])
    high = [
        branch(frequency, 0.9 * frequency / (0.215 * PEAK**2), contacts=contacts)
        for frequency, contacts in ((below, 4.0), (above, 6.0))
    ]
    unstable = branch(below, 0.9 * below / (0.215 * PEAK**2), phase=0.0, stable=False)
    data["branches"]["figure_05a"] = damped(*high, unstable, mass_ratio=0.12)
    values = BY_NUMBER["6"].evidence(data)
    assert values["coexisting"] == pytest.approx(overlap)
    assert BY_NUMBER["6"].verdict(values) == expected


@pytest.mark.parametrize(("fall", "expected"), [(1.06, REPRODUCED), (1.04, NOT_REPRODUCED)])
def test_fall_of_the_subharmonic_at_lower_damping(fall, expected, data):
    """At h = 0.107 no start leads to a subharmonic. At h = 0.215 half lead to a smaller motion."""
    size = float(data["subharmonic"]["figure_05a"].free_subharmonic[0])
    remaining = 2 * (1 - 1 / fall) * size
    data["subharmonic"]["figure_05a"] = subharmonic("figure_05a", damped=remaining)
    values = BY_NUMBER["18"].evidence(data)
    assert values["relative"] == pytest.approx(fall)
    assert BY_NUMBER["18"].verdict(values) == expected


def test_release_phase_decides_in_the_nearest_range_of_all_scans(data):
    values = BY_NUMBER["13"].evidence(data)
    assert (values["quiet_first"], values["quiet_last"]) == (1.65, 1.8)
    for name in ("wide", "close"):
        renamed("release_scan", name, clearance=1.0)(data)
    assert np.isnan(BY_NUMBER["13"].evidence(data)["quiet_first"])


@pytest.mark.parametrize(
    ("within", "by_hold", "expected"),
    [(0.49, None, DIFFERENT), (0, None, NOT_REPRODUCED), (0, 0.011, DIFFERENT)],
)
def test_runs_that_could_arrive_by_the_better_way(within, by_hold, expected, data):
    scale("migration", "figure_15", within_share=within)(data)
    if by_hold is not None:
        found = policies(data["migration"]["figure_15"], 1.7)
        found.policy_success.loc[{"policy": "hold", "bound": "share"}] = by_hold
        data["release_policies"] = {"paper": found}
    values = BY_NUMBER["14"].evidence(data)
    assert values["worst"] == 1.7 and values["best"] == pytest.approx(max(within, by_hold or 0))
    assert BY_NUMBER["14"].verdict(values) == expected
