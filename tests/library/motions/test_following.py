"""Following an orbit from one value of a parameter to another: prediction, steps, and ends."""

from typing import NamedTuple

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from numpy.testing import assert_allclose

from impact_damper.model.packed import CLEARANCE, FREQUENCY, pack
from impact_damper.motions.following import follow, follow_stable, record_at


class Point(NamedTuple):
    state: np.ndarray


def root(value, guess):
    """Return an orbit at the square root of the value; the branch has a fold at 0."""
    if value < 0 or abs(guess[0] - np.sqrt(value)) > 0.1:
        return None, "lost"
    return Point(np.full(4, np.sqrt(value))), "found"


@pytest.mark.parametrize("target", [4.0, 0.25])
def test_it_arrives_exactly(target):
    followed = follow(root, 1.0, target, Point(np.ones(4)), shortest=1e-3)
    assert followed.arrived and followed.value == target and followed.status == "found"
    assert_allclose(followed.orbit.state, np.sqrt(target))
    assert followed.values[0] != target


@pytest.mark.parametrize("shortest", [1e-2, 1e-6])
def test_it_ends_at_a_fold_to_the_shortest_step(shortest):
    followed = follow(root, 1.0, -1.0, Point(np.ones(4)), shortest=shortest)
    assert not followed.arrived and followed.status == "lost"
    assert 0 <= followed.value < 10 * shortest


def test_a_jump_beyond_the_reach_is_refused():
    def jumping(value, guess):
        return Point(np.full(4, 0.0 if value < 0.5 else 1.0)), "found"

    followed = follow(jumping, 0.0, 1.0, Point(np.zeros(4)), shortest=1e-3, reach=0.5)
    assert not followed.arrived and 0.49 < followed.value < 0.5


def test_a_stable_orbit_leaves_its_arguments_alone(design_orbit):
    p, state = design_orbit.parameters.copy(), design_orbit.state.copy()
    q, orbit = follow_stable(p, state, 1, CLEARANCE, 1.95)
    assert q[CLEARANCE] == 1.95 and abs(orbit.multiplier) < 1
    assert np.array_equal(p, design_orbit.parameters) and np.array_equal(state, design_orbit.state)
    assert not np.array_equal(orbit.state, state)


def test_no_record_beyond_the_end_of_a_branch():
    p, state = pack(PAPER, None, 2.0), np.array([2.35, -0.78, 2.35, -0.78])
    assert record_at(p, state, 1, FREQUENCY, 2.2) is None
    assert record_at(p, state, 1, FREQUENCY, 2.01)["maximum_displacement"] > 2


def test_a_loose_mass_that_is_not_damped_is_followed_too(design_orbit):
    p, orbit = follow_stable(pack(PAPER, DESIGN, 2.0), design_orbit.state, 1, FREQUENCY, 2.1)
    assert p[FREQUENCY] == 2.1 and not np.isnan(orbit.multiplier)
