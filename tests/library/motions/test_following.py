"""Following an orbit from one value of a parameter to another: prediction, steps, and ends."""

from typing import NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.motions.following import follow


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
