"""Ends of branches; bifurcations and grazings compared with 80-bit arithmetic."""

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER, polished_orbit
from numpy.testing import assert_allclose
from references import extended
from references.extended.bifurcations import located

from impact_damper.model.packed import pack
from impact_damper.motions.response import frequency_response
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.orbit_branches import orbit_branches
from impact_damper.orbits.shooting import find_orbit

SPAN = (0.3, 4.0)


def family(value):
    return pack(PAPER, DESIGN, value)


@pytest.fixture(scope="module")
def quiet():
    """Return the branch of the quiet orbit of figure 5 (a), from W = 0.3 to 4."""
    return follow_branch(family, find_orbit(family(2.0), polished_orbit("design").state), 2.0, SPAN)


def test_branch_ends_at_the_range(quiet):
    """The branch reaches both ends of the range of W."""
    assert quiet.ends == ("range_ends", "range_ends") and quiet.lost == 0
    assert {quiet.points[0].value, quiet.points[-1].value} == set(SPAN)
    assert max(abs(point.orbit.multipliers[0]) for point in quiet.points) > 1e7
    assert {point.orbit.sequence for point in quiet.points} == {"+-", "++--"}


def test_every_event_is_where_80_bit_arithmetic_has_it(quiet):
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    assert len(quiet.events) > 15
    for _, event in quiet.events:
        orbit, value = event.point.orbit, event.point.value
        found, residual = located(event.kind, family, value, orbit.state, orbit.phase)
        assert residual < 1e-12
        assert_allclose(value, found, rtol=0, atol=1e-9, err_msg=event.kind)


def test_fold_and_loss_of_symmetry_beside_a_grazing(quiet):
    """Fold, loss of symmetry and grazing lie within 1e-10 in W."""
    kinds = [event.kind for _, event in quiet.events]
    grazing = kinds.index("grazing")
    near = [
        event.kind
        for _, event in quiet.events
        if abs(event.point.value - quiet.events[grazing][1].point.value) < 1e-10
    ]
    assert {"fold", "symmetry_breaking", "grazing"} <= set(near)
    event = quiet.events[grazing][1]
    assert {event.before, event.after} == {"+-", "++--"} and event.point.orbit.least_speed < 1e-5


@pytest.mark.thorough
def test_ends_of_all_branches_of_a_damper():
    """A branch ends at the range or another branch, is closed, or is left while unstable (7)."""
    response = frequency_response(PAPER, INELASTIC, [1.15, 1.2], starts=12)
    branches = orbit_branches(PAPER, INELASTIC, span=(1.1, 1.4), motions=[response])
    ends = branches["branch_end"].values
    period = branches["branch_period"].values
    assert period.max() > 4
    assert np.isin(ends, [0, 1, 2, 3, 7]).all() and np.isin(ends[period == 1], [0, 1, 2]).all()
    for branch, edge in np.argwhere(branches["branch_met"].values >= 0):
        other = int(branches["branch_met"][branch, edge])
        periods = branches["branch_period"].values[[branch, other]]
        assert periods[0] == periods[1] * (2 if ends[branch, edge] == 3 else 1)
