"""Design rule (19) of the paper and response by harmonic balance, against closed forms and limits.

Wp is the frequency of the resonance peak without the damper.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.design_rule import peak_frequency, rule_clearance
from impact_damper.theory.free_oscillator import free_folds
from impact_damper.theory.harmonic_balance import harmonic_balance_response
from impact_damper.theory.single_harmonic import impacting_solutions, rigid_solutions

CUBIC = Oscillator(0.215)
PAPER = Damper(0.12, 2.0)


@pytest.fixture(scope="module")
def response():
    return harmonic_balance_response(CUBIC, PAPER, np.linspace(1, 3, 41))


@pytest.mark.parametrize("linear, rounded", [(0.0, 2.07), (1.0, 1.83), (1.5, 1.57)])
def test_optimum_clearance(linear, rounded):
    """With the clearance of rule (19), the balance with rigid walls gives amplitude 0 at Wp."""
    oscillator = Oscillator(0.215, linear)
    clearance = rule_clearance(oscillator, 0.12)
    assert_allclose(clearance, rounded, atol=5e-3)
    peak = peak_frequency(oscillator)
    rigid = rigid_solutions(oscillator, Damper(0.12, clearance), peak)
    assert np.min(np.abs(rigid.amplitude)) < 1e-14


def test_response_holds_every_solution(response):
    for k in (0, 13, 40):
        row = response.isel(frequency=k)
        impacting = row.amplitude.values[row.kind.values == flag("kind", "impacting")]
        expected = impacting_solutions(CUBIC, PAPER, float(row.frequency)).amplitude
        assert_allclose(np.sort(impacting), np.sort(expected))
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


@pytest.mark.parametrize(
    "damper, frequencies, error, message",
    [
        (PAPER, [], ValueError, r"frequencies = \[\]: must be increasing, and at least 1"),
        (PAPER, [2.0, 1.0], ValueError, r"frequencies = \[2.0, 1.0\]: must be increasing"),
        (PAPER, [[2.0]], TypeError, r"frequencies\[0\] = \[2.0\]: must be a number"),
        (0.12, [2.0], TypeError, "damper = 0.12: must be a Damper"),
        (Damper(0.12, 2.0, 0.9), [2.0], ValueError, "restitution = 0.9: must be 1"),
    ],
)
def test_arguments_of_the_response(damper, frequencies, error, message):
    with pytest.raises(error, match=message):
        harmonic_balance_response(CUBIC, damper, frequencies)
