"""The oscillator without a damper against the equations, discriminants and searches.

Symbols are as in `system.parameters`.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from impact_damper.model.parameters import Oscillator
from impact_damper.theory.design_rule import peak_frequency
from impact_damper.theory.free_oscillator import free_folds, free_solutions


@pytest.mark.parametrize("linear", [0.0, 1.0, 1.5])
@pytest.mark.parametrize("damping", [0.107, 0.15, 0.215])
def test_folds_are_zeros_of_the_discriminant(damping, linear):
    oscillator = Oscillator(damping, linear)

    def discriminant(frequency):
        k = linear**2 - frequency**2
        a, b, c, d = 9 / 16, 1.5 * k, k**2 + (damping * frequency) ** 2, -1.0
        return 18 * a * b * c * d - 4 * b**3 * d + (b * c) ** 2 - 4 * a * c**3 - 27 * (a * d) ** 2

    grid = np.linspace(0.3, 4, 20001)
    values = np.array([discriminant(w) for w in grid])
    crossed = np.flatnonzero(values[:-1] * values[1:] < 0)
    expected = [brentq(discriminant, grid[k], grid[k + 1], xtol=1e-14) for k in crossed]
    assert_allclose([fold.frequency for fold in free_folds(oscillator)], expected, rtol=1e-9)


@pytest.mark.parametrize("damping, frequency", [(0.215, 2.007), (0.15, 2.403), (0.107, 2.845)])
def test_peak_frequency(damping, frequency):
    """At the peak frequency the free motion has the amplitude 1/(h W) and lags by pi/2."""
    peak = peak_frequency(Oscillator(damping))
    assert_allclose(peak, frequency, atol=5e-4)
    largest = free_solutions(Oscillator(damping), peak)
    assert_allclose(largest.amplitude[-1], 1 / (damping * peak), rtol=1e-9)
    assert_allclose(largest.phase[-1], -np.pi / 2, atol=1e-6)
