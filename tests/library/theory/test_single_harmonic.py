"""Harmonic balance against numerical integrals, the printed equations, grids, and limits.

Symbols are as in `system.parameters`. Numbers in brackets are equations of the paper.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.free_oscillator import free_solutions
from impact_damper.theory.single_harmonic import (
    contact_amplitude,
    impacting_solutions,
    resting_solutions,
    rigid_solutions,
)

PAPER = Oscillator(0.215), Damper(0.12, 2.0)


def random_scenes(count, seed):
    """Yield random oscillators, dampers and frequencies in wider ranges than the paper's."""
    generator = np.random.default_rng(seed)
    for _ in range(count):
        oscillator = Oscillator(10 ** generator.uniform(-1.5, 0.3), generator.uniform(0, 3))
        damper = Damper(
            generator.uniform(0.02, 1.5),
            10 ** generator.uniform(-1.5, 1),
            contact_stiffness=10 ** generator.uniform(0, 5),
        )
        yield oscillator, damper, generator.uniform(0.2, 4)


def defect(b, oscillator, damper, frequency):
    """Return cos^2(t1) + sin^2(t1) - 1 by (7a, b), with a by (7c) and B as in (6e); and a.

    a and b are the amplitudes of Z1 and Z2, and t1 is their common phase.
    """
    rho = damper.clearance / b
    force = b * (1 - (2 / np.pi) * (rho * np.sqrt(1 - rho**2) + np.arcsin(rho)))
    a = b - damper.contact_stiffness * force / (damper.mass_ratio * frequency**2)
    inline = (
        a * (oscillator.linear_frequency**2 - frequency**2)
        + 0.75 * a**3
        + damper.contact_stiffness * force
    )
    return inline**2 + (oscillator.damping * a * frequency) ** 2 - 1, a


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


def test_roots_of_14_solve_13():
    for oscillator, damper, frequency in random_scenes(200, seed=1):
        found = rigid_solutions(oscillator, damper, frequency)
        sine = -oscillator.damping * found.amplitude * frequency
        assert_allclose(np.sin(found.phase), sine, atol=1e-9)
        scale = 1 + np.abs(found.amplitude) ** 3 + 16 * np.abs(found.amplitude)
        assert np.all(np.abs(found.residual) < 1e-9 * scale)


def test_roots_of_14_are_all_there():
    """Against sign changes of (13a) along the circle of phases."""
    phase = np.linspace(-np.pi, np.pi, 200001)
    for oscillator, damper, frequency in random_scenes(60, seed=2):
        a = -np.sin(phase) / (oscillator.damping * frequency)
        left = a * (oscillator.linear_frequency**2 - frequency**2) + 0.75 * a**3
        left += damper.mass_ratio * frequency**2 * (damper.clearance - a) - np.cos(phase)
        scanned = np.sum(left[:-1] * left[1:] < 0)
        assert len(rigid_solutions(oscillator, damper, frequency).phase) == scanned


def test_rule_18_gives_a_root_of_zero():
    found = rigid_solutions(Oscillator(0.215), Damper(0.125, 2.0), 2.0)
    assert np.sum(found.amplitude == 0) == 1
    assert np.sum(np.abs(impacting_solutions(*PAPER, 2.0).amplitude) < 0.01) == 1


def test_solutions_satisfy_7():
    for oscillator, damper, frequency in random_scenes(200, seed=3):
        a, b, phase = impacting_solutions(oscillator, damper, frequency)
        force = damper.contact_stiffness * contact_amplitude(b, damper.clearance)[0]
        stiffness = oscillator.linear_frequency**2 - frequency**2 + 0.75 * a**2
        size = 1 + np.abs(a) * (frequency**2 + np.abs(stiffness)) + damper.contact_stiffness * b
        assert np.all(np.abs(a * stiffness + force - np.cos(phase)) < 1e-10 * size)
        sine = -oscillator.damping * a * frequency
        assert np.all(np.abs(sine - np.sin(phase)) < 1e-10 * size)
        balance = -b * frequency**2 + force / damper.mass_ratio + a * frequency**2
        assert np.all(np.abs(balance) < 1e-10 * size / damper.mass_ratio)


def test_no_solution_of_7_is_missed():
    """Against changes of sign on a grid of amplitudes b of Z2, which may miss a close pair."""
    excess = np.concatenate([[0], np.geomspace(1e-9, 1e4, 100000)])
    escaped = 0
    for oscillator, damper, frequency in random_scenes(150, seed=4):
        values = defect(damper.clearance * (1 + excess), oscillator, damper, frequency)[0]
        scanned = np.sum(values[:-1] * values[1:] < 0)
        found = len(impacting_solutions(oscillator, damper, frequency).phase)
        assert found >= scanned and (found - scanned) % 2 == 0
        escaped += found > scanned
    assert escaped <= 1


def test_soft_walls_too():
    """With r1 < rm W^2 the contact force never outgrows the inertia of the loose mass."""
    oscillator, damper = Oscillator(0.1), Damper(0.5, 0.3, contact_stiffness=0.4)
    excess = np.geomspace(1e-9, 1e4, 100000)
    for frequency in (0.5, 0.9, 1.2, 2.0):
        values = defect(0.3 * (1 + excess), oscillator, damper, frequency)[0]
        found = impacting_solutions(oscillator, damper, frequency)
        assert len(found.phase) == np.sum(values[:-1] * values[1:] < 0)


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


def test_resting_motions_are_the_free_ones_within_the_gap():
    free = free_solutions(PAPER[0], 1.5)
    resting = resting_solutions(PAPER[0], Damper(0.12, 1.7), 1.5)
    assert len(free.phase) == 3 and len(resting.phase) == 2
    assert_allclose(resting.amplitude, free.amplitude[:2])


def test_inelastic_contact_is_refused():
    with pytest.raises(ValueError, match="restitution = 0.75"):
        impacting_solutions(PAPER[0], Damper(0.12, 2.0, restitution=0.75), 2.0)
