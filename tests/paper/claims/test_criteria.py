"""Criteria of claims on motions and migration: made-up data on both sides of each border.

The data are those of `helpers.made_up.world`, with which all claims are reproduced. A change makes
a criterion just hold or just fail.

W is the forcing frequency, e the restitution and h the damping of the oscillator. Free means
without the damper. The quiet orbit is the small symmetric periodic motion for which a damper is
designed. The subharmonic is a motion of period 3, that is of three forcing cycles. A motion is
violent if it exceeds half of the free resonance.
"""

import numpy as np
import pandas as pd
import pytest
from helpers.made_up import (
    DAMPERS,
    PEAKS,
    damper,
    parameters,
    quiet_size,
    release_scan,
    subharmonic,
    sweep,
    world,
)
from helpers.made_up_orbits import branch, branches

from chatterjee1995.claims import exact_orbits
from chatterjee1995.claims.claim import DIFFERENT, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED
from chatterjee1995.claims.extract import ELASTIC
from chatterjee1995.claims.verdicts import CLAIMS
from impact_damper.data.datasets import damper_of

BY_NUMBER = {claim.number: claim for claim in CLAIMS}
PEAK = PEAKS[0.215]


@pytest.fixture
def data():
    return world()


def scale(data, stage, name, **factors):
    """Multiply variables of a made-up dataset by factors."""
    old = data[stage][name]
    data[stage][name] = old.assign({key: old[key] * factor for key, factor in factors.items()})


def steepen(data, name, steepness):
    """Give a made-up sweep over the clearance a displacement with a minimum at the optimum.

    The displacement rises linearly on both sides.
    """
    old = data["optimum"][name]
    away = np.abs(old.clearance / old.optimum_clearance - 1)
    data["optimum"][name] = old.assign(quiet_displacement=0.02 * (1 + steepness * away))


def verdict(number, data):
    return BY_NUMBER[number].judge(data)["verdict"]


def damped(name, *parts, mass_ratio):
    """Return made-up branches with a damper: quiet orbits at all frequencies, and `parts`."""
    frequency = np.linspace(0.5, 1.5, 201) * PEAK
    size = quiet_size(frequency, PEAK, mass_ratio)
    phase = np.where(frequency < PEAK, np.pi, 0.0)
    made = parameters(**damper(mass_ratio, PEAK))
    return branches(branch(frequency, size, phase=phase), *parts, parameters=made)


def test_width_in_which_different_values_coexist():
    columns = {"lower": [1.0, 1.5, 1.8, 3.0], "upper": [1.5, 2.0, 2.2, 3.1]}
    part = pd.DataFrame(columns | {"contacts": [2.0, 2.0, 4.0, 4.0]})
    assert exact_orbits.coexisting(part, "contacts") == pytest.approx(0.2)
    assert exact_orbits.coexisting(part[:2], "contacts") == 0
    assert exact_orbits.coexisting(part[:0], "contacts") == 0
    same = pd.concat([part, part.assign(contacts=6.0)])
    assert exact_orbits.coexisting(same, "contacts") == pytest.approx(1.3)


@pytest.mark.parametrize("overlap, expected", [(0.004, REPRODUCED), (0.006, DIFFERENT)])
def test_regions_of_contact_number_overlap(overlap, expected, data):
    """Violent orbits with four contacts end at W = 1.9, those with six begin shortly below."""
    below = np.array([1.0, 1.5, 1.9])
    above = np.array([1.9 - overlap, 1.93, 1.95])
    high = [
        branch(frequency, 0.9 * frequency / (0.215 * PEAK**2), contacts=contacts)
        for frequency, contacts in ((below, 4.0), (above, 6.0))
    ]
    unstable = branch(below, 0.9 * below / (0.215 * PEAK**2), phase=0.0, stable=False)
    data["branches"]["figure_05a"] = damped("figure_05a", *high, unstable, mass_ratio=0.12)
    values = BY_NUMBER["6"].evidence(data)
    assert values["coexisting"] == pytest.approx(overlap)
    assert BY_NUMBER["6"].verdict(values) == expected


@pytest.mark.parametrize("factor, expected", [(0.92, REPRODUCED), (0.9, NOT_REPRODUCED)])
def test_first_harmonics_are_compared_with_harmonic_balance(factor, expected, data):
    for name in ELASTIC:
        scale(data, "branches", name, orbit_amplitude=factor, orbit_displacement=1.0)
    values = BY_NUMBER["6"].evidence(data)
    assert values["harmonic"] == pytest.approx(1 / factor - 1)
    assert values["size"] == pytest.approx(0, abs=1e-6)
    assert BY_NUMBER["6"].verdict(values) == expected


@pytest.mark.parametrize(
    "colliding, expected", [(1, REPRODUCED), (0.9901, DIFFERENT), (0.9899, NOT_REPRODUCED)]
)
def test_starts_that_collide(colliding, expected, data):
    scale(data, "collisions", "figure_05a", colliding=colliding)
    assert verdict("8", data) == expected


@pytest.mark.parametrize("steepness, expected", [(1.99, REPRODUCED), (2.01, DIFFERENT)])
def test_relative_rise_from_the_optimum(steepness, expected, data):
    """At 10 % from the optimum the made-up displacement has risen by a tenth of its steepness."""
    name = "0.215_0.12_1.0"
    steepen(data, name, steepness)
    values = BY_NUMBER["9"].evidence(data)
    assert values["rise"] == pytest.approx(steepness / 10)
    assert verdict("9", data) == expected


@pytest.mark.parametrize(
    "factor, expected",
    [(0.88, REPRODUCED), (0.87, DIFFERENT), (1.04, REPRODUCED), (1.06, NOT_REPRODUCED)],
)
def test_optimum_over_that_of_harmonic_balance(factor, expected, data):
    """The made-up optimum is 5 % above the optimum by harmonic balance."""
    for name in data["optimum"]:
        scale(data, "optimum", name, analytical_optimum=factor)
    assert verdict("9", data) == expected


@pytest.mark.parametrize("size, expected", [(0.049, REPRODUCED), (0.051, NOT_REPRODUCED)])
def test_displacement_beside_the_optimum_over_the_free_resonance(size, expected, data):
    for name in ("0.215_0.12_1.0", "0.215_0.18_1.0"):
        factor = size / (0.023 * 0.215 * PEAK)
        scale(data, "optimum", name, quiet_displacement=factor, optimum_displacement=factor)
    assert BY_NUMBER["9"].evidence(data)["displaced"] == pytest.approx(size)
    assert verdict("9", data) == expected


@pytest.mark.parametrize("steepness, expected", [(1.49, REPRODUCED), (1.51, DIFFERENT)])
def test_response_is_flatter_with_lower_restitution(steepness, expected, data):
    """The steepness of the made-up displacement with elastic contact is 1.5."""
    name = "0.215_0.12_0.75"
    steepen(data, name, steepness)
    values = BY_NUMBER["11"].evidence(data)
    assert [values["flat"], values["absolute"]] == pytest.approx([steepness / 1.5] * 2)
    assert verdict("11", data) == expected


@pytest.mark.parametrize("factor, expected", [(0.99, REPRODUCED), (1.01, DIFFERENT)])
def test_step_that_raises_the_optimum_is_named(factor, expected, data):
    """From e = 1 to 0.9 the optimum changes by `factor`, and at lower e it falls."""
    middle = sweep(0.215, 0.18, 0.9)
    hard = data["optimum"]["0.215_0.18_1.0"]
    stretch = factor * float(hard.optimum_clearance / middle.optimum_clearance)
    data["optimum"]["middle"] = middle.assign_coords(clearance=stretch * middle.clearance).assign(
        optimum_clearance=stretch * middle.optimum_clearance
    )
    values = BY_NUMBER["11"].evidence(data)
    assert values["step"] == pytest.approx(factor)
    assert (values["step_mass_ratio"], values["step_from"], values["step_to"]) == (0.18, 1, 0.9)
    assert values["rising"] == (factor > 1)
    assert verdict("11", data) == expected


@pytest.mark.parametrize("width, narrow", [(0.0009, True), (0.0011, False)])
def test_narrow_branches_are_reported_by_themselves(width, narrow, data):
    """A branch of period 3 below the band has 1.2 times the free amplitude, over `width` in W."""
    third = branch(np.array([1.7, 1.7 + width]), 0.96, period=3)
    high = branch(np.array([1.0, 1.84]), np.array([1.0, 1.9]), contacts=4.0)
    data["branches"]["figure_05b"] = damped("figure_05b", high, third, mass_ratio=0.25)
    values = BY_NUMBER["10"].evidence(data)
    assert values["light_anywhere"] == pytest.approx(width)
    told, other = ("narrow_ratio", "light_ratio") if narrow else ("light_ratio", "narrow_ratio")
    assert values[told] == pytest.approx(1.2) and np.isnan(values[other])
    assert values["narrow_width"] == pytest.approx(width if narrow else 0)
    assert verdict("10", data) == DIFFERENT


def test_subharmonics_at_lower_damping_are_reported_only(data):
    peak = PEAKS[0.107]
    made = parameters(0.107, **damper(0.12, peak))
    frequency = np.linspace(0.5, 1.5, 201) * peak
    quiet = branch(frequency, quiet_size(frequency, peak, DAMPERS["figure_08"]))
    third = branch(np.linspace(0.8, 1.1, 61) * peak, 0.8, period=3)
    data["branches"]["figure_08"] = branches(quiet, third, parameters=made)
    row = BY_NUMBER["10"].judge(data)
    assert row["verdict"] == REPRODUCED
    assert "all frequencies of its band, with up to 100 %" in row["finding"]


@pytest.mark.parametrize("fall, expected", [(1.06, REPRODUCED), (1.04, NOT_REPRODUCED)])
def test_fall_of_the_subharmonic_at_lower_damping(fall, expected, data):
    """At h = 0.107 no start leads to a subharmonic; at h = 0.215 half do, to a smaller one."""
    part = 2 * (1 - 1 / fall)
    size = float(data["subharmonic"]["figure_05a"].free_subharmonic[0])
    data["subharmonic"]["figure_05a"] = subharmonic("figure_05a", damped=part * size)
    values = BY_NUMBER["18"].evidence(data)
    assert values["relative"] == pytest.approx(fall)
    assert values["starts"] == 0 and values["starts_high"] == 0.5
    assert verdict("18", data) == expected


def released(data, name, kind, subharmonic):
    """Set the share of releases of a made-up damped motion that lead to the subharmonic."""
    case = data["migration"][name].copy(deep=True)
    row = {"damped": ["unsettled", "quiet"].index(kind)}
    case.release_share.loc[row | {"free_motion": "subharmonic"}] = subharmonic
    case.release_share.loc[row | {"free_motion": "non_resonance"}] = 1 - subharmonic
    data["migration"][name] = case


@pytest.mark.parametrize(
    "kind, share, expected",
    [("unsettled", 0.5, REPRODUCED), ("quiet", 0, REPRODUCED), ("quiet", 1e-3, NOT_REPRODUCED)],
)
def test_release_at_any_phase_concerns_the_settled_motion(kind, share, expected, data):
    released(data, "figure_13", kind, share)
    assert verdict("12", data) == expected


@pytest.mark.parametrize(
    "share, expected",
    [(0.009, NOT_REPRODUCED), (0.011, REPRODUCED), (0.989, REPRODUCED), (0.991, NOT_REPRODUCED)],
)
def test_phase_decides_if_both_outcomes_have_a_share(share, expected, data):
    released(data, "figure_15", "quiet", share)
    assert verdict("13", data) == expected


@pytest.mark.parametrize("share, decides", [(0.009, False), (0.011, True), (0.991, False)])
def test_phase_of_a_motion_of_longer_period_decides(share, decides, data):
    scan = release_scan([1.8, 1.9], [share, 0.0])
    longer = scan.damped_kind.copy(data=np.full_like(scan.damped_kind.values, 3))
    data["release_scan"] = {"wide": scan.assign(damped_kind=longer)}
    values = BY_NUMBER["13"].evidence(data)
    told = [values[f"longer_{end}"] for end in ("first", "last", "least", "most")]
    np.testing.assert_allclose(told, [1.8, 1.8, share, share] if decides else np.full(4, np.nan))


def policies(data, name, by_hold):
    """Add made-up policies to a case; `by_hold` is the share of success of the policy `hold`."""
    from claims.test_policies import policies as made_up_policies

    case = data["migration"][name]
    frequency = {"figure_13": 1.95, "figure_15": 1.7, "figure_16": 1.85}[name]
    found = made_up_policies(case, frequency)
    found.policy_success.loc[{"policy": "hold", "bound": "share"}] = by_hold
    assert float(found.case_mass_ratio[0]) == damper_of(case).mass_ratio
    data.setdefault("release_policies", {})[name] = found


@pytest.mark.parametrize(
    "within, by_hold, expected",
    [
        (0.51, None, REPRODUCED),
        (0.49, None, DIFFERENT),
        (0, None, NOT_REPRODUCED),
        (0, 0.011, DIFFERENT),
        (0, 0.009, NOT_REPRODUCED),
        (0.011, 0, DIFFERENT),
    ],
)
def test_runs_that_could_arrive_by_the_better_way(within, by_hold, expected, data):
    scale(data, "migration", "figure_15", within_share=within)
    if by_hold is not None:
        policies(data, "figure_15", by_hold)
    values = BY_NUMBER["14"].evidence(data)
    assert values["worst"] == 1.7
    assert values["best"] == pytest.approx(max(within, by_hold or 0))
    assert BY_NUMBER["14"].verdict(values) == expected


@pytest.mark.parametrize(
    "third, reached, expected",
    [
        (11, 1, REPRODUCED),
        (9, 1, NOT_REPRODUCED),
        (11, 0.999, DIFFERENT),
        (11, 0.501, DIFFERENT),
        (11, 0.499, NOT_REPRODUCED),
    ],
)
def test_early_releases_reach_period_3(third, reached, expected, data):
    """Of 1000 early releases `third` lead to period 3 and 500 back to resonance."""
    case = data["migration"]["figure_16"].copy(deep=True)
    for motion, count in (
        ("subharmonic", third),
        ("resonance", 500),
        ("non_resonance", 500 - third),
    ):
        case.destination_count.loc[{"damped_motion": "unsettled", "free_motion": motion}] = count
    data["migration"]["figure_16"] = case.assign(reached_share=case.reached_share * reached)
    values = BY_NUMBER["19"].evidence(data)
    assert values["early"] == pytest.approx(third / 1000)
    assert values["of_others"] == pytest.approx(third / 500)
    assert values["by_way"] == 0
    assert BY_NUMBER["19"].verdict(values) == expected


def test_without_any_optimum_the_claims_are_open(data):
    for name in data["optimum"]:
        scale(data, "optimum", name, optimum_clearance=np.nan)
    assert verdict("9", data) == verdict("11", data) == NOT_DECIDABLE
