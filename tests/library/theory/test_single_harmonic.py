"""Harmonic balance against numerical integrals, the printed equations, grids, and limits.

Symbols are as in `system.parameters`. Numbers in brackets are equations of the paper.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.single_harmonic import (
    contact_amplitude,
    impacting_solutions,
    rigid_solutions,
)

PAPER = Oscillator(0.215), Damper(0.12, 2.0)


def test_contact_amplitude_is_the_first_fourier_coefficient():
    angle = (np.arange(200000) + 0.5) * 2 * np.pi / 200000
    for b in (1.0, 2.0, 2.1, 3.0, 40.0):
        z = b * np.cos(angle)
        force = np.where(z > 2, z - 2, np.where(z < -2, z + 2, 0.0))
        assert_allclose(contact_amplitude(b, 2.0)[0], 2 * np.mean(force * np.cos(angle)), atol=1e-8)


def test_contact_amplitude_derivative():
    b = np.array([2.001, 2.1, 3.0, 50.0])
    step = 1e-6
    difference = contact_amplitude(b + step, 2.0)[0] - contact_amplitude(b - step, 2.0)[0]
    assert_allclose(contact_amplitude(b, 2.0)[1], difference / (2 * step), rtol=1e-6)
    assert contact_amplitude(1.9, 2.0) == (0, 0)


def test_contact_amplitude_near_the_wall_has_the_power_three_halves():
    """The paper prints the power 1/2 in (11)."""
    clearance, excess = 2.0, np.array([1e-3, 1e-4, 1e-5, 1e-6])
    found = contact_amplitude(clearance + excess, clearance)[0]
    expected = 8 * np.sqrt(2) / (3 * np.pi) * excess**1.5 / np.sqrt(clearance)
    assert_allclose(found, expected, rtol=1e-3)
    slope = np.diff(np.log(found)) / np.diff(np.log(excess))
    assert_allclose(slope, 1.5, atol=1e-3)


def test_rule_18_gives_a_root_of_zero():
    found = rigid_solutions(Oscillator(0.215), Damper(0.125, 2.0), 2.0)
    assert np.sum(found.amplitude == 0) == 1
    assert np.sum(np.abs(impacting_solutions(*PAPER, 2.0).amplitude) < 0.01) == 1


def test_near_double_solutions_are_kept_up_to_the_fold():
    """Two solutions exist just below the fold at which they meet, and none just above."""

    def count(frequency):
        return len(impacting_solutions(*PAPER, frequency).phase)

    low, high = 1.9, 1.95
    assert count(low) == count(high) + 2
    while high - low > 1e-12:
        middle = (low + high) / 2
        low, high = (middle, high) if count(middle) == count(1.9) else (low, middle)
    pair = np.sort(impacting_solutions(*PAPER, low - 1e-11).amplitude)[:2]
    assert 0 < pair[1] - pair[0] < 1e-4


def test_7_tends_to_13_with_the_power_two_thirds_of_the_stiffness():
    oscillator, stiffness = Oscillator(0.215, 0.5), np.array([1e4, 1e5, 1e6, 1e7])
    rigid = rigid_solutions(oscillator, Damper(0.12, 1.5), 1.4)
    limit = np.sort(rigid.amplitude[~rigid.pulling])
    errors = []
    for r1 in stiffness:
        found = impacting_solutions(oscillator, Damper(0.12, 1.5, contact_stiffness=r1), 1.4)
        assert len(found.phase) == len(limit)
        errors.append(np.abs(np.sort(found.amplitude) - limit))
    rates = np.diff(np.log(errors), axis=0) / np.diff(np.log(stiffness))[:, None]
    assert_allclose(rates[-1], -2 / 3, atol=0.02)


def test_inelastic_contact_is_refused():
    with pytest.raises(ValueError, match="restitution = 0.75"):
        impacting_solutions(PAPER[0], Damper(0.12, 2.0, restitution=0.75), 2.0)
