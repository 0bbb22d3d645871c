"""Series and their crossings against closed forms."""

import numpy as np
import pytest

from chatterjee1995.methods import fourier

ONE = np.array([1])


@pytest.mark.parametrize("excess", [1e-3, 1e-6, 1e-9])
def test_no_grazing_is_missed(excess):
    """cos(s - 1) > 1 - excess holds for a length 2 sqrt(2 excess), shorter than a sample step."""
    found = fourier.intervals(np.array([0.5 * np.exp(-1j)]), ONE, 1 - excess)
    half = np.arccos(1 - excess)
    expected = [[1, 1 - half, 1 + half], [-1, 1 + np.pi - half, 1 + np.pi + half]]
    assert found == pytest.approx(np.array(expected), abs=1e-7)
