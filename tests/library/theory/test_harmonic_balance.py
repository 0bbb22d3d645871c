"""Response and suppression band by harmonic balance, against single solutions of (7)."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.design_rule import rule_clearance
from impact_damper.theory.free_oscillator import free_folds, maximum_response
from impact_damper.theory.harmonic_balance import (
    harmonic_balance,
)
from impact_damper.theory.single_harmonic import fixed_points, growth_rate, impacting_solutions

CUBIC = Oscillator(0.215)
PAPER = Damper(0.12, 2.0)


@pytest.fixture(scope="module")
def response():
    return harmonic_balance(CUBIC, PAPER, np.linspace(1, 3, 201))


def test_response_holds_every_solution(response):
    for k in (0, 65, 200):
        row = response.isel(frequency=k)
        impacting = row.amplitude.values[row.kind.values == flag("kind", "impacting")]
        expected = impacting_solutions(CUBIC, PAPER, float(row.frequency)).amplitude
        assert_allclose(np.sort(impacting), np.sort(expected))
        stable = row.stability.values != flag("stability", "absent")
        assert np.array_equal(np.isfinite(row.amplitude.values), stable)
    assert np.all(response.balance_status == flag("balance_status", "solved"))


def test_solutions_are_curves(response):
    """Branches are smooth. A free branch between two folds is stable, or unstable, throughout."""
    unstable = response.free_stability.values == flag("free_stability", "unstable")
    exists = np.isfinite(response.free_amplitude.values)
    assert exists.shape[1] == 3
    assert_allclose(np.sort(unstable.sum(0) / exists.sum(0)), [0, 0, 1])
    for name in ("amplitude", "free_amplitude"):
        values = response[name].values
        kept = np.isfinite(values)
        # each column is one interval of frequencies
        assert np.all(np.abs(np.diff(kept.astype(int), axis=0)).sum(axis=0) <= 2)
        # amplitudes change little from one frequency to the next
        assert np.nanmax(np.abs(np.diff(values, axis=0))) < 0.2


def stable_amplitudes(frequency, oscillator=CUBIC, damper=PAPER):
    solutions = impacting_solutions(oscillator, damper, frequency)
    growth = growth_rate(fixed_points(solutions), oscillator, damper, frequency)
    return solutions.amplitude[growth < 0]


def test_band_of_the_paper():
    """Below the lower edge a large and the quiet motion are stable, above only the quiet motion."""
    band = harmonic_balance(CUBIC, PAPER, [2.0])
    lower, upper = band.edge_frequency.values
    assert band.band_status == flag("band_status", "found")
    assert lower < band.peak_frequency < upper
    below, above = stable_amplitudes(lower - 1e-6), stable_amplitudes(lower + 1e-6)
    assert len(below) == 2 and len(above) == 1
    assert np.min(below) < -2 and abs(above[0]) < 0.1
    assert_allclose(upper, free_folds(CUBIC)[-1].frequency, atol=2e-10)


def test_band_of_a_softening_spring_ends_below_with_its_resonance():
    oscillator = Oscillator(0.15, 1.5, cubic=-0.3, force=0.3)
    band = harmonic_balance(oscillator, Damper(0.6, rule_clearance(oscillator, 0.6)), [2.0])
    highest = maximum_response(oscillator).amplitude
    end = [fold for fold in free_folds(oscillator) if fold.amplitude < highest][-1]
    assert_allclose(band.edge_frequency[0], end.frequency, atol=2e-10)


def test_band_without_folds_ends_where_nothing_is_gained():
    oscillator = Oscillator(0.6, 3.0)
    damper = Damper(0.12, rule_clearance(oscillator, 0.12))
    band = harmonic_balance(oscillator, damper, [2.0])
    for edge in band.edge_frequency.values:
        free = harmonic_balance(oscillator, None, [edge]).free_amplitude
        assert_allclose(np.abs(stable_amplitudes(edge, oscillator, damper)), free[0], rtol=1e-8)


def test_no_band_where_the_damper_is_too_light():
    """A light damper hardly changes the resonance branch, which stays stable at Wp."""
    damper = Damper(0.0005, 0.1)
    band = harmonic_balance(CUBIC, damper, [2.0])
    assert len(stable_amplitudes(float(band.peak_frequency), damper=damper)) == 2
    assert band.band_status == flag("band_status", "no_single_motion")
    assert np.all(np.isnan(band.edge_frequency))
