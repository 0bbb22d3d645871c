"""Branches that leave at bifurcations, compared with 80-bit arithmetic and with simulations.

A branch is the curve of the periodic orbits over the forcing frequency W. At a loss of symmetry or
a period doubling another branch leaves it, whose orbits have less symmetry. This branch begins
supercritical if it has as many unstable multipliers (of modulus above 1) as the more stable side of
the first branch, and subcritical if it has one more. A grazing is a contact with zero speed.
"""

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER, polished_orbit
from numpy.testing import assert_allclose
from references import extended

from chatterjee1995.tables import branches as tables
from impact_damper.data.datasets import dataset, decode
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper, Oscillator, describe
from impact_damper.model.settling import Settling
from impact_damper.motions.ensemble import settle
from impact_damper.orbits.branch_datasets import branches_dataset, leaving_variables
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.other_branches import follow_others
from impact_damper.orbits.shooting import find_orbit
from impact_damper.orbits.switching import LEAVING, departure

# For each branch: damping of the oscillator; mass ratio, clearance and restitution of the damper;
# W, state at W T = pi/2 and period of a stable orbit; least and greatest W.
CASES = {
    "elastic": (0.15, (0.4, 0.7, 1.0), 1.0667, (0.0174, 0.6878, -0.3083, -0.2503), 1, (1.0, 1.3)),
    "inelastic": (0.18, (0.3, 0.9, 0.9), 1.3333, (0.5346, 0.4314, 0.0346, -0.6285), 3, (1.1, 1.6)),
}


def followed(case):
    """Return the branch of a case."""
    damping, (mass_ratio, clearance, restitution), value, state, period, span = CASES[case]
    damper = Damper(mass_ratio, clearance, restitution=restitution)

    def family(value):
        return pack(Oscillator(damping), damper, value)

    return follow_branch(family, find_orbit(family(value), state, period), value, span)


@pytest.fixture(scope="module")
def branches():
    return {case: followed(case) for case in CASES}


def polished(p, state, phase, cycles, sign):
    """Return a fixed point, computed in 80 bits, and the derivative of its map, shape (4, 4).

    The map integrates a state over `cycles` forcing cycles and multiplies it by `sign`. Newton's
    method begins at `state`, which is given at the phase W T = `phase`.
    """
    turn = 2 * np.arccos(extended.Real(-1))
    x = np.array(state, extended.Real)
    begin = extended.Real(phase) / extended.Real(p[FREQUENCY])
    end = begin + extended.Real(cycles) * turn / extended.Real(p[FREQUENCY])
    for _ in range(6):
        run = extended.run(p, x, begin, [end])
        flow = sign * run.flow
        defect = sign * run.states[-1] - x
        x = x + np.linalg.solve((np.eye(4) - flow).astype(float), defect.astype(float))
    assert np.max(np.abs(defect)) < 1e-13
    return x, flow.astype(float)


def unstable(matrix):
    """Return the number of eigenvalues outside the unit circle."""
    return int(np.sum(np.abs(np.linalg.eigvals(matrix)) > 1))


@pytest.mark.thorough
@pytest.mark.parametrize("case", CASES)
def test_80_bit_arithmetic_finds_the_orbit_that_leaves_and_its_side(case, branches):
    """Newton's method in 80 bits finds the orbit of the other branch, not one of more symmetry.

    At the frequency of this orbit, the orbit of the first branch has one unstable multiplier more
    than this orbit if the other branch begins supercritical, and one fewer if subcritical.
    """
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    sides = []
    ends = 0, len(branches[case].points) - 1
    for place, event in branches[case].events:
        if event.kind not in LEAVING or place in ends:
            continue
        begun = departure(event)
        orbit, first = begun.point.orbit, event.point.orbit
        # The orbit of the first branch repeats after half of this period, with a change of sign if
        # it is symmetric.
        cycles, sign = orbit.periods / 2, 1 if event.kind == "period_doubling" else -1
        x, whole = polished(orbit.p, orbit.state, orbit.phase, orbit.periods, 1)
        _, half = polished(orbit.p, first.state, first.phase, cycles, sign)
        beyond = sign * extended_state(orbit.p, x, orbit.phase, cycles)
        deviation = np.max(np.abs(beyond - x))
        assert np.max(np.abs(x - orbit.state)) < 0.05 * deviation
        if begun.side in ("supercritical", "subcritical"):
            more = unstable(half) - unstable(whole)
            assert more == (1 if begun.side == "supercritical" else -1)
        sides.append(begun.side)
    assert len(sides) >= 9 and {"supercritical", "subcritical", "beside_grazing"} <= set(sides)


def extended_state(p, state, phase, cycles):
    """Return the state some cycles later, in 80 bits."""
    turn = 2 * np.arccos(extended.Real(-1))
    begin = extended.Real(phase) / extended.Real(p[FREQUENCY])
    end = begin + extended.Real(cycles) * turn / extended.Real(p[FREQUENCY])
    return extended.run(p, state, begin, [end]).states[-1]


@pytest.mark.thorough
def test_a_simulated_motion_goes_over_to_a_supercritical_branch(branches):
    """A motion that starts near an unstable symmetric orbit settles to the asymmetric orbit."""
    branch = branches["inelastic"]
    event = next(
        event
        for _, event in branch.events
        if event.kind == "symmetry_breaking" and abs(event.point.value - 1.508702) < 1e-5
    )
    begun = departure(event)
    assert begun.side == "supercritical" and begun.point.orbit.stable
    value = event.point.value + 2e-3 * np.sign(begun.point.value - event.point.value)
    p = event.point.problem.family(value)
    start = event.point.orbit.strobe_states[0] + np.array([1e-3, 0, 1e-3, 0])
    settling = Settling(tolerance=1e-10, patience=300, limit=6000)
    record = settle(p[None], start[None], settling, from_strobe=True)[0]
    assert record["period"] == 3 and record["asymmetry"] > 1e-3
    followed = follow_branch(
        event.point.problem.family,
        begun.point.orbit,
        begun.point.value,
        tuple(sorted((value, event.point.value + 1e-3 * np.sign(event.point.value - value)))),
    )
    end = next(point for point in followed.points if point.value == value)
    assert_allclose(
        end.orbit.record["maximum_displacement"], record["maximum_displacement"], rtol=1e-5
    )


def test_each_bifurcation_has_an_outcome_and_the_table_counts_them():
    """On the branch of the large orbit of figure 5 (a) a period doubling has another branch.

    `follow_others` follows this branch, and the tables name it.
    """

    def family(value):
        return pack(PAPER, DESIGN, value)

    span = (1.55, 1.8)

    def follow(orbit, value):
        return follow_branch(family, orbit, value, span, 60)

    orbit = find_orbit(family(1.7), polished_orbit("large").state)
    branches = [follow(orbit, 1.7)]
    found = follow_others(branches, follow)
    assert [len(others) for others in found] == [len(branch.events) for branch in branches]
    for branch, others in zip(branches, found, strict=True):
        for (_, event), other in zip(branch.events, others, strict=True):
            assert (other is not None) == (event.kind in LEAVING)
    doubling = next(
        other
        for (_, event), other in zip(branches[0].events, found[0], strict=True)
        if event.kind == "period_doubling"
    )
    assert doubling.outcome == "followed"
    assert branches[doubling.number].points[0].orbit.periods == 2
    assert (doubling.departure.side, doubling.departure.point.orbit.stable) == (
        "supercritical",
        True,
    )
    made = describe(PAPER, DESIGN) | {"parameter": "frequency"}
    data = branches_dataset(branches, float, made, "Branches")
    data = data.assign(dataset(leaving_variables(found), {}, made, "Others").variables)
    outcomes = decode(data.leaving_outcome).values
    kinds = np.isin(decode(data.event_kind).values, LEAVING)
    assert np.all((outcomes != "absent") == kinds)
    table = tables.other_branches({"branches": {"figure_05a": data}})
    assert table["events"].sum() == kinds.sum()
    rows = tables.bifurcations({"branches": {"figure_05a": data}})
    words = rows["other branch"][rows["event"] == "period doubling"]
    assert words.str.contains(f"branch {doubling.number + 1}, supercritical, stable").any()
