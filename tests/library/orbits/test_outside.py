"""The number of Floquet multipliers outside the unit circle between the events of a branch.

A branch is the curve of the periodic orbits over a parameter, here the forcing frequency W. Where
no contact appears or vanishes, this number changes by one at a fold, a loss of symmetry or a period
doubling, by two at a Neimark-Sacker point, and nowhere else.
"""

import numpy as np
import pytest

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit

CHANGES = {"fold": 1, "symmetry_breaking": 1, "period_doubling": 1, "neimark_sacker": 2}
# Oscillator; damper; period, W and phase of an orbit; state of the orbit; range of W. In the first
# case the product of two real multipliers passes 1, while the other two multipliers are a complex
# pair of modulus 0.4.
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
    """Return the numbers that are reached from `count` if each change is added or subtracted."""
    reached = {count}
    for change in changes:
        reached = {each + sign * change for each in reached for sign in (-1, 1)}
    return reached
