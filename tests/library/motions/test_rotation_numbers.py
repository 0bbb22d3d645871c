"""Rotation numbers of curves for which they are known exactly, and sets that are no curve."""

import math

import numpy as np
import pytest

from impact_damper.motions.undecided import AGREEMENT, find_rotation

GOLDEN = (math.sqrt(5) - 1) / 2


def on_curve(number, count=3000):
    """Return points of a rotation by `number` revolutions, on a closed curve without symmetry."""
    angle = 2 * np.pi * number * np.arange(count)
    return 1 + 2j + np.exp(1j * angle) + 0.3 * np.exp(-1j * angle) + 0.1 * np.exp(2j * angle)


@pytest.mark.parametrize("number", [1 - GOLDEN, 0.1 / math.pi, 1 / math.sqrt(5)])
@pytest.mark.parametrize("sense", [1, -1])
def test_rotation_of_a_curve(number, sense):
    found, error = find_rotation(on_curve(sense * number))
    assert error <= AGREEMENT
    assert abs(found - number) < 1e-12


def test_chaotic_points_are_no_curve():
    """Points of Henon's map."""
    points = [0.1 + 0.1j]
    for _ in range(3000):
        x, y = points[-1].real, points[-1].imag
        points.append(complex(1 - 1.4 * x * x + y, 0.3 * x))
    assert find_rotation(np.array(points)) is None
