"""Design rule, response and suppression band: closed forms, limits and edges."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.data.datasets import flag, load, save
from impact_damper.stages.harmonic_balance import (
    harmonic_balance_response,
    optimum_clearance,
    suppression_band,
)
from impact_damper.system.parameters import Damper, Oscillator
from impact_damper.theory.free_oscillator import free_folds
from impact_damper.theory.single_harmonic import impacting_solutions, rigid_solutions
from impact_damper.theory.slow_flow import fixed_points, growth_rate

CUBIC = Oscillator(0.215)
PAPER = Damper(0.12, 2.0)


@pytest.fixture(scope="module")
def band():
    return suppression_band(CUBIC, PAPER)


@pytest.fixture(scope="module")
def response():
    return harmonic_balance_response(CUBIC, PAPER, np.linspace(1, 3, 41))


def stable_amplitudes(frequency, oscillator=CUBIC, damper=PAPER):
    solutions = impacting_solutions(oscillator, damper, frequency)
    growth = growth_rate(fixed_points(solutions), oscillator, damper, frequency)
    return solutions.amplitude[growth < 0]


@pytest.mark.parametrize("linear, rounded", [(0.0, 2.07), (1.0, 1.83), (1.5, 1.57)])
def test_optimum_clearance(linear, rounded):
    """With the clearance of rule (19) the rigid balance has a solution of amplitude 0 at Wp."""
    oscillator = Oscillator(0.215, linear)
    clearance = optimum_clearance(oscillator, 0.12)
    assert_allclose(clearance, rounded, atol=5e-3)
    peak = float(suppression_band(oscillator, Damper(0.12, clearance)).peak_frequency)
    rigid = rigid_solutions(oscillator, Damper(0.12, clearance), peak)
    assert np.min(np.abs(rigid.amplitude)) < 1e-14


def test_mass_ratio_is_checked():
    with pytest.raises(ValueError, match="mass_ratio = 0"):
        optimum_clearance(CUBIC, 0)


def test_response_holds_every_solution(response):
    for k in (0, 13, 40):
        row = response.isel(frequency=k)
        impacting = row.amplitude.values[row.kind.values == flag("kind", "impacting")]
        expected = impacting_solutions(CUBIC, PAPER, float(row.frequency)).amplitude
        assert_allclose(impacting, expected)
        assert np.sum(np.isfinite(row.amplitude.values)) == row.solution_count
        assert np.sum(row.stability.values != flag("stability", "absent")) == row.solution_count
    assert np.all(response.balance_status == flag("balance_status", "solved"))


def test_resting_motions_are_the_free_ones_within_the_gap(response):
    resting = response.kind == flag("kind", "resting")
    assert np.all(response.amplitude.where(resting, 0) < PAPER.clearance)
    inside = (response.free_amplitude < PAPER.clearance).sum("free_solution")
    assert np.array_equal(resting.sum("solution"), inside)


def test_free_response_has_three_motions_between_its_folds(response):
    lower, upper = (fold.frequency for fold in free_folds(CUBIC))
    between = (response.frequency > lower) & (response.frequency < upper)
    assert np.array_equal(response.free_count, np.where(between, 3, 1))


def test_response_without_a_damper_is_the_free_one(response):
    free = harmonic_balance_response(CUBIC, None, response.frequency.values)
    assert set(free.data_vars) == {name for name in response if name.startswith("free")}
    assert_allclose(free.free_amplitude, response.free_amplitude)


def test_response_survives_a_file(response, tmp_path):
    save(response, tmp_path / "response.nc")
    assert load(tmp_path / "response.nc").identical(response)


def test_band_of_the_paper(band):
    """A large antiphase motion is stable below the lower edge; above it only the quiet one is."""
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


def test_upper_edge_is_the_fold_of_the_free_response(band):
    assert_allclose(band.edge_frequency[1], free_folds(CUBIC)[1].frequency, atol=2e-10)


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


def test_reduction(band):
    resonance = 1 / (0.215 * float(band.peak_frequency))
    quiet = np.abs(stable_amplitudes(float(band.peak_frequency)))
    assert_allclose(band.quiet_amplitude, quiet[0])
    assert_allclose(band.reduction, 1 - quiet[0] / resonance)


def test_quiet_motion_breaks_even_with_the_free_one(band):
    frequency = float(band.break_even_frequency)
    free = harmonic_balance_response(CUBIC, None, [frequency]).free_amplitude.values[0, 0]
    assert_allclose(np.abs(stable_amplitudes(frequency)), free, rtol=1e-8)


def test_band_without_folds_ends_where_nothing_is_gained():
    oscillator = Oscillator(0.6, 3.0)
    assert free_folds(oscillator) == []
    band = suppression_band(oscillator, Damper(0.12, optimum_clearance(oscillator, 0.12)))
    assert np.all(band.edge_event == flag("edge_event", "no_reduction"))
    assert_allclose(band.edge_reduction, 0, atol=1e-8)


def test_no_band_where_the_damper_is_too_light():
    """A light damper hardly changes the resonance branch, which continues past Wp."""
    damper = Damper(0.0005, 0.1)
    band = suppression_band(CUBIC, damper)
    assert len(stable_amplitudes(float(band.peak_frequency), damper=damper)) == 2
    assert band.band_status == flag("band_status", "no_single_motion")
    assert np.all(np.isnan(band.edge_frequency))
    assert np.all(band.edge_event == flag("edge_event", "not_found"))


@pytest.mark.parametrize(
    "damper, frequencies, error, message",
    [
        (PAPER, [], ValueError, r"frequencies = \[\]: must be increasing, and at least one"),
        (PAPER, [2.0, 1.0], ValueError, r"frequencies = \[2.0, 1.0\]: must be increasing"),
        (PAPER, [[2.0]], TypeError, r"frequencies\[0\] = \[2.0\]: must be a number"),
        (0.12, [2.0], TypeError, "damper = 0.12: must be a Damper"),
        (Damper(0.12, 2.0, 0.9), [2.0], ValueError, "restitution = 0.9: must be 1"),
    ],
)
def test_arguments_of_the_response(damper, frequencies, error, message):
    with pytest.raises(error, match=message):
        harmonic_balance_response(CUBIC, damper, frequencies)


def test_a_band_needs_a_damper():
    with pytest.raises(TypeError, match="damper = None: must be a Damper"):
        suppression_band(CUBIC, None)
