"""Harmonic balance against numerical integrals, the printed equations, grids, and limits."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from references.equation import KNOWN, SPRINGS

from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.single_harmonic import (
    contact_amplitude,
    impacting_solutions,
    rigid_solutions,
)

PAPER = Oscillator(0.215), Damper(0.12, 2.0)
DAMPER = Damper(0.12, 1.5, contact_stiffness=400.0)


@pytest.fixture(params=KNOWN)
def oscillator(request):
    return SPRINGS[request.param]


def test_contact_amplitude_is_the_first_fourier_coefficient():
    angle = (np.arange(200000) + 0.5) * 2 * np.pi / 200000
    for b in (1.0, 2.0, 2.1, 3.0, 40.0):
        z = b * np.cos(angle)
        force = np.where(z > 2, z - 2, np.where(z < -2, z + 2, 0.0))
        assert_allclose(contact_amplitude(b, 2.0)[0], 2 * np.mean(force * np.cos(angle)), atol=1e-8)


def test_contact_amplitude_near_the_wall_has_the_power_three_halves():
    """Equation (11) of the paper prints the power 1/2 instead."""
    clearance, excess = 2.0, np.array([1e-3, 1e-4, 1e-5, 1e-6])
    found = contact_amplitude(clearance + excess, clearance)[0]
    expected = 8 * np.sqrt(2) / (3 * np.pi) * excess**1.5 / np.sqrt(clearance)
    assert_allclose(found, expected, rtol=1e-3)


def test_rule_18_gives_a_root_of_zero():
    found = rigid_solutions(Oscillator(0.215), Damper(0.125, 2.0), 2.0)
    assert np.sum(found.amplitude == 0) == 1
    assert np.sum(np.abs(impacting_solutions(*PAPER, 2.0).amplitude) < 0.01) == 1


def test_near_double_solutions_are_kept_up_to_the_fold():
    """Two solutions that meet at a fold exist just below the fold, and do not exist above it."""

    def count(frequency):
        return len(impacting_solutions(*PAPER, frequency).phase)

    low, high = 1.9, 1.95
    assert count(low) == count(high) + 2
    while high - low > 1e-12:
        middle = (low + high) / 2
        low, high = (middle, high) if count(middle) == count(1.9) else (low, middle)
    pair = np.sort(impacting_solutions(*PAPER, low - 1e-11).amplitude)[:2]
    assert 0 < pair[1] - pair[0] < 1e-4


def test_no_solution_with_contacts_is_missed(oscillator):
    """Solutions are counted on a grid of amplitudes b of Z2, which may miss two close solutions."""
    b = 1.5 * (1 + np.concatenate([[0], np.geomspace(1e-9, 1e3, 100000)]))
    escaped = 0
    for frequency in np.linspace(0.4, 2.4, 11):
        push = 400 * contact_amplitude(b, 1.5)[0]
        a = b - push / (0.12 * frequency**2)
        spring = oscillator.linear_frequency**2 - frequency**2 + 0.75 * oscillator.cubic * a**2
        left = (a * spring + push) ** 2 + (oscillator.damping * frequency * a) ** 2
        values = left - oscillator.forcing_amplitude(frequency) ** 2
        scanned = np.sum(values[:-1] * values[1:] < 0)
        found = impacting_solutions(oscillator, DAMPER, frequency)
        assert len(found.phase) >= scanned and (len(found.phase) - scanned) % 2 == 0
        escaped += len(found.phase) > scanned
    assert escaped <= 1


def test_rigid_solutions_solve_13(oscillator):
    for frequency in (0.6, 1.1, 1.9):
        found = rigid_solutions(oscillator, DAMPER, frequency)
        force = oscillator.forcing_amplitude(frequency)

        def left(a, phase, frequency=frequency, force=force):
            spring = oscillator.linear_frequency**2 - frequency**2 + 0.75 * oscillator.cubic * a**2
            return a * spring + 0.12 * frequency**2 * (1.5 - a) - force * np.cos(phase)

        sine = -oscillator.damping * frequency * found.amplitude / force
        assert_allclose(np.sin(found.phase), sine, atol=1e-9)
        residual = left(found.amplitude, found.phase)
        assert np.all(np.abs(residual) < 1e-9 * (1 + np.abs(found.amplitude) ** 3))
        phase = np.linspace(-np.pi, np.pi, 200001)
        values = left(-force * np.sin(phase) / (oscillator.damping * frequency), phase)
        assert len(found.phase) == np.sum(values[:-1] * values[1:] < 0)


def test_7_tends_to_13_with_the_power_two_thirds_of_the_stiffness():
    oscillator, stiffness = Oscillator(0.215, 0.5), np.array([1e4, 1e5, 1e6, 1e7])
    rigid = rigid_solutions(oscillator, Damper(0.12, 1.5), 1.4)
    limit = np.sort(rigid.amplitude[rigid.amplitude <= 1.5])
    errors = []
    for r1 in stiffness:
        found = impacting_solutions(oscillator, Damper(0.12, 1.5, contact_stiffness=r1), 1.4)
        assert len(found.phase) == len(limit)
        errors.append(np.abs(np.sort(found.amplitude) - limit))
    rates = np.diff(np.log(errors), axis=0) / np.diff(np.log(stiffness))[:, None]
    assert_allclose(rates[-1], -2 / 3, atol=0.02)
