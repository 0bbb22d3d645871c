"""The number of Floquet multipliers outside the unit circle between the events of a branch.

A branch is the curve of the periodic orbits over a parameter, here the forcing frequency W. Where
no contact appears or vanishes, this number changes by one at a fold, a loss of symmetry or a period
doubling, by two at a Neimark-Sacker point, and nowhere else.
"""

import numpy as np
import pytest

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.orbits.bifurcations import _is_complex_pair, events_between
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.continuation import Problem
from impact_damper.orbits.hidden import hides_bifurcations
from impact_damper.orbits.shooting import find_orbit

CHANGES = {"fold": 1, "symmetry_breaking": 1, "period_doubling": 1, "neimark_sacker": 2}
# Oscillator, damper, period, W, phase and state of an orbit, and the range of W. In the first case
# the product of two real multipliers passes 1, while the other two are a complex pair of modulus
# 0.4.
CASES = {
    "two real multipliers with product 1": (
        Oscillator(0.215),
        Damper(0.25, 1.0),
        (1, 0.7432961316719733, 4.762740615747022),
        [-0.23245946340694948, 0.5343181760462752, 0.008168393638031237, -0.9193139538053496],
        (0.735, 0.75),
    ),
    "Neimark-Sacker point beside a fold": (
        Oscillator(0.215),
        Damper(0.25, 1.0),
        (3, 1.6907707805126098, 4.06651825663814),
        [-0.532516004012801, -0.7257427599967717, -0.06554304369629778, -1.224378733483158],
        (1.690, 1.6925),
    ),
}
# W, phase and state of a symmetric orbit of period 7 with the damper of figure 5 (a). The branch
# has two losses of symmetry at larger W: at 1.661081 and 1.665833.
BEFORE_TWO_LOSSES = (
    1.6607936847446518,
    2.908858122417371,
    [-0.40427670589641235, -0.15225110539453973, 0.27734003610564995, -1.3276315715040206],
)


@pytest.mark.parametrize("case", CASES)
def test_events_account_for_the_multipliers_outside_the_unit_circle(case):
    oscillator, damper, (period, value, phase), state, span = CASES[case]

    def family(frequency):
        return pack(oscillator, damper, frequency)

    branch = follow_branch(family, find_orbit(family(value), state, period, phase), value, span)
    assert branch.lost == 0 and branch.ends == ("range_ends", "range_ends")
    assert len({point.orbit.sequence for point in branch.points}) == 1
    kinds = {place: event.kind for place, event in branch.events}
    count = np.array([np.sum(np.abs(each.orbit.multipliers) > 1) for each in branch.points])
    regular = [k for k in range(len(count)) if k not in kinds]
    for before, after in zip(regular, regular[1:], strict=False):
        between = [CHANGES[kinds[k]] for k in range(before + 1, after)]
        assert count[after] in _reachable(count[before], between), kinds


def _reachable(count, changes):
    """Return the numbers that are reached from `count` by the changes, each up or down."""
    reached = {count}
    for change in changes:
        reached = {each + sign * change for each in reached for sign in (-1, 1)}
    return reached


@pytest.mark.parametrize(
    ("multipliers", "expected"),
    [
        ([-8.75, 0.6 + 0.8j, 0.6 - 0.8j, -0.01], True),
        ([0.6 + 0.8j, 0.6 - 0.8j, 0.1 + 0.2j, 0.1 - 0.2j], True),
        ([50.0, 0.1 + 0.3j, 0.1 - 0.3j, 0.02], False),
        ([30 + 40j, 30 - 40j, 0.012 + 0.016j, 0.012 - 0.016j], False),
    ],
)
def test_only_a_conjugate_pair_on_the_unit_circle_makes_a_torus(multipliers, expected):
    """In the last two cases two multipliers that are not conjugate have the product 1."""
    assert _is_complex_pair(np.array(multipliers, complex)) == expected


def test_a_step_that_hides_two_losses_of_symmetry_is_recognized():
    """The step to W = 1.6665 passes both losses of symmetry, and none of them is located."""
    point, ahead, events = _step_over_losses_of_symmetry(1.6665)
    assert not events and hides_bifurcations(point, ahead, events)


def _step_over_losses_of_symmetry(last):
    """Return the ends of a step that ends at W = `last`, and the events located on the step."""

    def family(frequency):
        return pack(Oscillator(0.215), Damper(0.12, 2.0), frequency)

    first, phase, state = BEFORE_TWO_LOSSES
    orbit = find_orbit(family(first), state, 7, phase)
    point = Problem.of(family, orbit).begin(orbit, first, 1)
    ahead = point
    for value in np.linspace(first, last, 12)[1:]:
        ahead = point.problem.at_value(ahead, value)
    length = (point.problem.metric * (ahead.x - point.x)) @ point.tangent
    events, lost = events_between(point, ahead, length)
    assert not lost
    return point, ahead, events


def test_a_step_without_one_of_its_events_is_recognized():
    """Without the loss of symmetry the multipliers outside the unit circle are unaccounted for."""
    point, ahead, events = _step_over_losses_of_symmetry(1.6645)
    assert not hides_bifurcations(point, ahead, events)
    assert hides_bifurcations(point, ahead, [])
