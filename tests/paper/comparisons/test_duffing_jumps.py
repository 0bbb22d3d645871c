"""Jump frequencies against the equation of single-term harmonic balance."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from chatterjee1995.comparisons.duffing_jumps import jumps


def amplitudes(damping, cubic, force, r):
    """Return the positive roots of the equation for the amplitude."""
    square = [
        0.5625 * cubic**2,
        1.5 * cubic * (1 - r**2),
        (1 - r**2) ** 2 + (2 * damping * r) ** 2,
        -(force**2),
    ]
    roots = np.roots(square)
    return np.sqrt(roots[(abs(roots.imag) < 1e-9) & (roots.real > 0)].real)


@pytest.mark.thorough
@pytest.mark.parametrize("cubic", [-1.0, 1.0])
def test_jumps_are_the_folds_at_small_damping(cubic):
    """The number of amplitudes changes near the closed forms; the difference falls with damping."""
    errors = []
    for damping in (4e-3, 2e-3):
        force = 0.8 * damping  # so that the maximum of the response stays the same
        found = jumps(damping, cubic, force)
        grid = np.linspace(min(found) * 0.98, max(found) * 1.02, 20001)
        many = np.array([len(amplitudes(damping, cubic, force, r)) for r in grid]) == 3
        edges = grid[np.flatnonzero(np.diff(many.astype(int)))]
        down, up = (edges[0], edges[-1]) if cubic < 0 else (edges[-1], edges[0])
        errors.append([abs(down - found.down), abs(up - found.up)])
    assert np.all(np.array(errors) < 1e-3)
    assert errors[1][0] < errors[0][0] + 1e-5


def test_largest_amplitude_is_in_quadrature():
    damping, force = 0.01, 0.008
    down = jumps(damping, -1.0, force).down
    size = force / (2 * damping * down)
    assert_allclose(1 - down**2 - 0.75 * size**2, 0, atol=1e-12)


def test_unbounded_softening_is_refused():
    with pytest.raises(ValueError, match="cubic = -10: must be at least -4 z"):
        jumps(0.01, -10.0, 0.0115470053838)
