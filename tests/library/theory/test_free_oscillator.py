"""The oscillator without a damper against the equations, discriminants and searches.

Symbols are as in `system.parameters`.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq, minimize_scalar

from impact_damper.model.parameters import Oscillator
from impact_damper.theory.design_rule import peak_frequency
from impact_damper.theory.free_oscillator import free_folds, free_solutions, maximum_response


def test_free_solutions_solve_the_balance():
    generator = np.random.default_rng(5)
    for _ in range(100):
        oscillator = Oscillator(10 ** generator.uniform(-1.5, 0.3), generator.uniform(0, 3))
        frequency = generator.uniform(0.2, 4)
        a, phase = free_solutions(oscillator, frequency)
        left = a * (oscillator.linear_frequency**2 - frequency**2 + 0.75 * a**2)
        left = left + 1j * oscillator.damping * frequency * a
        assert_allclose(left, np.exp(-1j * phase), atol=1e-9)


def test_linear_limit():
    """With a stiff linear spring the amplitude tends to the linear oscillator's."""
    oscillator = Oscillator(0.3, 50.0)
    expected = 1 / abs(50**2 - 20**2 + 0.3j * 20)
    assert_allclose(free_solutions(oscillator, 20.0).amplitude, expected, rtol=1e-8)


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


def test_heavy_damping_has_no_fold():
    assert free_folds(Oscillator(2.0)) == []


@pytest.mark.parametrize("damping, frequency", [(0.215, 2.007), (0.15, 2.403), (0.107, 2.845)])
def test_peak_frequency(damping, frequency):
    """At the peak frequency the free motion has the amplitude 1/(h W) and lags by pi/2."""
    peak = peak_frequency(Oscillator(damping))
    assert_allclose(peak, frequency, atol=5e-4)
    largest = free_solutions(Oscillator(damping), peak)
    assert_allclose(largest.amplitude[-1], 1 / (damping * peak), rtol=1e-9)
    assert_allclose(largest.phase[-1], -np.pi / 2, atol=1e-6)


@pytest.mark.parametrize("oscillator", [Oscillator(0.215), Oscillator(0.6, 2.0)])
def test_maximum_response_against_a_search(oscillator):
    maximum = maximum_response(oscillator)
    near = minimize_scalar(
        lambda w: -free_solutions(oscillator, w).amplitude[-1],
        bounds=(0.9 * maximum.frequency, min(1.1 * maximum.frequency, peak_frequency(oscillator))),
        method="bounded",
        options={"xatol": 1e-9},
    )
    assert_allclose(maximum.frequency, near.x, rtol=1e-6)
    assert_allclose(maximum.amplitude, -near.fun, rtol=1e-12)
    assert maximum.frequency < peak_frequency(oscillator)


def test_overdamped_response_has_no_peak():
    with pytest.raises(ValueError, match="damping = 5"):
        maximum_response(Oscillator(5.0))
