"""The suppression band by harmonic balance, compared with solutions on both sides of its edges.

Wp is the frequency of the resonance peak without the damper. The quiet motion is the small motion
for which a damper is designed.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.design_rule import rule_clearance
from impact_damper.theory.free_oscillator import free_folds
from impact_damper.theory.harmonic_balance import (
    harmonic_balance_response,
    suppression_band,
)
from impact_damper.theory.single_harmonic import impacting_solutions
from impact_damper.theory.slow_flow import fixed_points, growth_rate

CUBIC = Oscillator(0.215)
PAPER = Damper(0.12, 2.0)


@pytest.fixture(scope="module")
def band():
    return suppression_band(CUBIC, PAPER)


def stable_amplitudes(frequency, oscillator=CUBIC, damper=PAPER):
    solutions = impacting_solutions(oscillator, damper, frequency)
    growth = growth_rate(fixed_points(solutions), oscillator, damper, frequency)
    return solutions.amplitude[growth < 0]


def test_band_of_the_paper(band):
    """Below the lower edge the quiet and a large motion are stable, above it the quiet motion only.

    The large motion is in antiphase with the forcing, so its amplitude is negative.
    """
    lower, upper = band.edge_frequency.values
    assert band.band_status == flag("band_status", "found")
    assert lower < band.peak_frequency < upper
    assert_allclose(band.band_width, upper - lower)
    below, above = stable_amplitudes(lower - 1e-6), stable_amplitudes(lower + 1e-6)
    assert len(below) == 2 and len(above) == 1
    assert np.min(below) < -2 and abs(above[0]) < 0.1
    assert band.edge_event.values.tolist() == [
        flag("edge_event", "other_motion_appears"), flag("edge_event", "resonance_branch_ends")
    ]  # fmt: skip


def test_lower_edge_is_a_fold(band):
    """At a fold an eigenvalue vanishes, as the square root of the distance in frequency."""
    lower = float(band.edge_frequency[0])
    rates = []
    for distance in (1e-5, 1e-7):
        solutions = impacting_solutions(CUBIC, PAPER, lower - distance)
        pair = np.argsort(solutions.amplitude)[:2]
        growth = growth_rate(fixed_points(solutions), CUBIC, PAPER, lower - distance)[pair]
        assert growth[0] < 0 < growth[1]
        rates.append(growth[1])
    assert_allclose(rates[0] / rates[1], 10, rtol=0.05)


def test_quiet_motion_breaks_even_with_the_free_one(band):
    frequency = float(band.break_even_frequency)
    free = harmonic_balance_response(CUBIC, None, [frequency]).free_amplitude.values[0, 0]
    assert_allclose(np.abs(stable_amplitudes(frequency)), free, rtol=1e-8)


def test_band_without_folds_ends_where_nothing_is_gained():
    oscillator = Oscillator(0.6, 3.0)
    assert free_folds(oscillator) == []
    band = suppression_band(oscillator, Damper(0.12, rule_clearance(oscillator, 0.12)))
    assert np.all(band.edge_event == flag("edge_event", "no_reduction"))
    assert_allclose(band.edge_reduction, 0, atol=1e-8)


def test_no_band_where_the_damper_is_too_light():
    """A light damper hardly changes the resonance branch, which stays stable at Wp."""
    damper = Damper(0.0005, 0.1)
    band = suppression_band(CUBIC, damper)
    assert len(stable_amplitudes(float(band.peak_frequency), damper=damper)) == 2
    assert band.band_status == flag("band_status", "no_single_motion")
    assert np.all(np.isnan(band.edge_frequency))
    assert np.all(band.edge_event == flag("edge_event", "not_found"))
