"""The oscillator without a damper, with any spring and forcing, and real roots of equations."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from references.equation import KNOWN, SPRINGS
from scipy.optimize import minimize_scalar

from chatterjee1995.methods.quiet_orbits import rule_ratios
from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.design_rule import peak_frequency, rule_clearance
from impact_damper.theory.free_oscillator import (
    free_folds,
    free_solutions,
    main_solutions,
    maximum_response,
    resonance,
)
from impact_damper.theory.harmonic_balance import harmonic_balance
from impact_damper.theory.roots import polynomial_roots, smooth_roots
from impact_damper.theory.single_harmonic import (
    impacting_solutions,
    resting_solutions,
    rigid_solutions,
)

LINEAR, SOFTENING = SPRINGS["linear"], SPRINGS["softening"]


@pytest.fixture(params=KNOWN)
def oscillator(request):
    return SPRINGS[request.param]


def balance(a, phase, oscillator, frequency):
    """Return the residual of the first harmonic of equation (3) without contact."""
    spring = oscillator.linear_frequency**2 - frequency**2 + 0.75 * oscillator.cubic * a**2
    force = oscillator.force + oscillator.unbalance * frequency**2
    return a * (spring + 1j * oscillator.damping * frequency) - force * np.exp(-1j * phase)


def defect(a, oscillator, frequency):
    """Return |amplitude of spring, inertia and damping forces|^2 - |amplitude of the forcing|^2."""
    inside = balance(a, 0.0, oscillator, frequency)
    force = balance(0.0, 0.0, oscillator, frequency)
    return np.abs(inside - force) ** 2 - np.abs(force) ** 2


def test_peak_of_a_linear_oscillator_in_closed_form():
    square = 1.3**2 - 0.1**2 / 2
    peak = maximum_response(LINEAR)
    assert_allclose(peak.frequency, np.sqrt(square), rtol=1e-12)
    assert_allclose(peak.amplitude, 0.7 / (0.1 * np.sqrt(1.3**2 - 0.1**2 / 4)), rtol=1e-12)
    assert_allclose(peak_frequency(LINEAR), 1.3, rtol=1e-12)
    assert_allclose(rule_clearance(LINEAR, 0.2), 0.7 / (0.2 * 1.3**2), rtol=1e-12)
    assert not free_folds(LINEAR)


def test_all_free_solutions_are_found(oscillator):
    amplitudes = np.concatenate([[0], np.geomspace(1e-4, 100, 20001)])
    for frequency in np.linspace(0.3, 2.5, 23):
        a, phase = free_solutions(oscillator, frequency)
        assert_allclose(balance(a, phase, oscillator, frequency), 0, atol=1e-9)
        values = defect(amplitudes, oscillator, frequency)
        assert len(a) == np.sum(values[:-1] * values[1:] < 0)


@pytest.mark.thorough
def test_folds_are_where_solutions_appear(oscillator):
    """The number of solutions changes at folds. At a fold one solution is double."""

    def count(frequency):
        return len(free_solutions(oscillator, frequency).amplitude)

    grid = np.linspace(0.02, 4, 500)
    counts = [count(frequency) for frequency in grid]
    found = []
    for k in np.flatnonzero(np.diff(counts)):
        low, high = grid[k], grid[k + 1]
        while high - low > 1e-11:
            middle = (low + high) / 2
            low, high = (middle, high) if count(middle) == counts[k] else (low, middle)
        found.append(low)
    folds = free_folds(oscillator)
    seen = sorted(fold.frequency for fold in folds if grid[0] < fold.frequency < grid[-1])
    assert_allclose(seen, found, atol=1e-9)
    for fold in folds:
        slope = minimize_scalar(
            lambda a, w=fold.frequency: abs(defect(a, oscillator, w)),
            bounds=(0.99 * fold.amplitude, 1.01 * fold.amplitude),
            method="bounded",
            options={"xatol": 1e-12},
        )
        assert slope.fun < 1e-9
        assert_allclose(slope.x, fold.amplitude, rtol=1e-5)


def test_the_resonance_of_a_softening_spring_ends_below_its_peak():
    peak, folds = maximum_response(SOFTENING), free_folds(SOFTENING)
    end = [fold for fold in folds if fold.amplitude < peak.amplitude][-1]
    assert end.frequency < peak.frequency < 1
    below, above = (resonance(SOFTENING, end.frequency * x) for x in (1 - 1e-6, 1 + 1e-6))
    assert below.phase is None and below.amplitude == end.amplitude
    assert_allclose(above.amplitude, end.amplitude, rtol=1e-2)
    assert resonance(SOFTENING, peak.frequency).amplitude > 0.99 * peak.amplitude


@pytest.mark.thorough
def test_maximum_response_against_a_search(oscillator):
    maximum = maximum_response(oscillator)
    near = minimize_scalar(
        lambda w: -main_solutions(oscillator, w).amplitude[-1],
        bounds=(maximum.frequency * (1 - 1e-3), maximum.frequency * (1 + 1e-3)),
        method="bounded",
        options={"xatol": 1e-10},
    )
    assert_allclose(-near.fun, maximum.amplitude, rtol=1e-6)
    grid = np.linspace(0.01, 6, 200)
    assert all(main_solutions(oscillator, w).amplitude[-1] <= maximum.amplitude for w in grid)


def test_at_the_peak_frequency_the_motion_lags_by_a_quarter_period(oscillator):
    """At this frequency and with d0 by rule (19), balance (13) has a solution with amplitude 0."""
    peak = peak_frequency(oscillator)
    a, phase = main_solutions(oscillator, peak)
    assert_allclose(phase[-1], -np.pi / 2, atol=1e-5)
    force = oscillator.forcing_amplitude(peak)
    assert_allclose(a[-1], force / (oscillator.damping * peak), rtol=1e-8)
    damper = Damper(0.2, rule_clearance(oscillator, 0.2))
    assert np.min(np.abs(rigid_solutions(oscillator, damper, peak).amplitude)) < 1e-9


@pytest.mark.parametrize(
    "oscillator, message",
    [
        (Oscillator(0.05, 1.0, cubic=-0.5, force=0.5), "force = 0.5: .* over the barrier"),
        (Oscillator(0.1, 0.5, cubic=2.0, unbalance=1.0), "unbalance = 1: .* without end"),
        (Oscillator(0.1, 0.0, cubic=0.0), "linear_frequency = 0, cubic = 0.* nothing restores"),
        (Oscillator(0.1, 0.0, cubic=-1.0), "force = 1: .* over the barrier"),
    ],
)
def test_a_response_without_a_peak_says_so(oscillator, message):
    with pytest.raises(ValueError, match=message):
        peak_frequency(oscillator)
    with pytest.raises(ValueError, match="the response has no peak"):
        maximum_response(oscillator)
    band = harmonic_balance(oscillator, Damper(0.1, 1.0), [2.0])
    assert band.band_status == flag("band_status", "no_peak")
    assert np.isnan(band.edge_frequency).all() and np.isnan(band.band_width)


def test_without_force_there_is_rest():
    free, damper = Oscillator(0.1, 1.0, force=0.0), Damper(0.1, 1.0)
    assert free_solutions(free, 1.2).amplitude.tolist() == [0]
    assert len(impacting_solutions(free, damper, 1.2).phase) == 0
    assert len(rigid_solutions(free, damper, 1.2).phase) == 0
    assert resting_solutions(free, damper, 1.2).amplitude.tolist() == [0]
    with pytest.raises(ValueError, match="needs a forcing"):
        rule_clearance(free, 0.1)
    with pytest.raises(ValueError, match="needs a forcing"):
        rule_ratios(free, damper, 1.2)


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
def test_near_double_roots_are_told_from_a_near_miss(gap):
    assert len(polynomial_roots([1 - gap**2, -2, 1])) == 2
    assert len(polynomial_roots([1 + gap**2, -2, 1])) == 0


def test_zeros_of_a_function_that_oscillates_ever_faster():
    """The zeros of sin(1/x) are 1/(k pi)."""
    found = smooth_roots(lambda x: np.sin(1 / x), lambda x: 1 + 1 / x, 0.05, 1.0)
    assert_allclose(found, 1 / (np.pi * np.arange(6, 0, -1)), rtol=1e-12)


def test_function_that_is_not_smooth_is_refused():
    with pytest.raises(ArithmeticError, match="degree"):
        smooth_roots(np.abs, np.ones_like, -1.0, 1.3)
