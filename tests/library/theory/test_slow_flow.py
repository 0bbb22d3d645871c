"""Stability by the slow flow: its Jacobian against equations (17) of the paper, and laws."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from references.equation import KNOWN, SPRINGS

from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.free_oscillator import free_solutions
from impact_damper.theory.single_harmonic import (
    contact_amplitude,
    fixed_points,
    growth_rate,
    impacting_solutions,
    jacobian,
    stability,
)

DAMPER, FREQUENCY = Damper(0.12, 1.5, contact_stiffness=400.0), 1.4
SCENE = Oscillator(0.215, 0.7), Damper(0.12, 1.5), 1.6


def polar_flow(state, oscillator, damper, frequency):
    """Return the rates of change of a, t1, b, t2 by equations (17a) to (17d)."""
    a, t1, b, t2 = state
    push = damper.contact_stiffness * contact_amplitude(b, damper.clearance)[0]
    force = oscillator.force + oscillator.unbalance * frequency**2
    spring = a * oscillator.linear_frequency**2 + 0.75 * oscillator.cubic * a**3
    drag = oscillator.damping * a * frequency
    total = push * (1 + 1 / damper.mass_ratio)
    along = force * np.cos(t1) - push * np.cos(t2 - t1) - spring + a * frequency**2
    across = b * frequency**2 - total + drag * np.sin(t1 - t2) - spring * np.cos(t2 - t1)
    return -np.array([
        drag + push * np.sin(t2 - t1) + force * np.sin(t1),
        along / a,
        force * np.sin(t2) + drag * np.cos(t1 - t2) + spring * np.sin(t1 - t2),
        (across + force * np.cos(t2)) / b,
    ]) / (2 * frequency)  # fmt: skip


def cartesian(state):
    a, t1, b, t2 = state
    return np.array([a * np.cos(t1), a * np.sin(t1), b * np.cos(t2), b * np.sin(t2)])


def cartesian_flow(state, *scene):
    """Return the rates of change of Re A, Im A, Re C, Im C, from `polar_flow`."""
    first, second = complex(*state[:2]), complex(*state[2:])
    polar = abs(first), np.angle(first), abs(second), np.angle(second)
    return differences(cartesian, np.array(polar)) @ polar_flow(polar, *scene)


def differences(function, state, step=1e-6):
    columns = [(function(state + shift) - function(state - shift)) / (2 * step)
               for shift in step * np.eye(len(state))]  # fmt: skip
    return np.array(columns).T


@pytest.mark.parametrize("name", KNOWN)
def test_jacobian_is_that_of_equations_17(name):
    given, generator = (SPRINGS[name], DAMPER, FREQUENCY), np.random.default_rng(11)
    for polar in generator.uniform([0.1, -3, 1.55, -3], [2.5, 3, 1.9, 3], (20, 4)):
        state = cartesian(polar)
        expected = differences(lambda x: cartesian_flow(x, *given), state, 1e-4)
        assert_allclose(jacobian(state, *given), expected, rtol=1e-4, atol=1e-3)


def test_solutions_of_7_are_fixed_points_with_the_eigenvalues_of_the_polar_jacobian():
    """At fixed points the element J33 of the Jacobian is 0, as appendix A of the paper says."""
    solutions = impacting_solutions(*SCENE)
    states = fixed_points(solutions)
    assert len(states) >= 2
    for a, b, phase, state in zip(*solutions, states, strict=True):
        place = np.array([a, phase, b, phase])
        assert_allclose(polar_flow(place, *SCENE), 0, atol=1e-11)
        polar = differences(lambda x: polar_flow(x, *SCENE), place)
        assert polar[2, 2] == 0
        expected = np.sort_complex(np.linalg.eigvals(polar))
        found = np.sort_complex(np.linalg.eigvals(jacobian(state, *SCENE)))
        assert_allclose(found, expected, rtol=1e-6, atol=1e-6)
        assert_allclose(np.sum(found), -0.215, rtol=1e-10)  # only the dashpot contracts volume


def test_slope_criterion_of_the_free_response():
    """If there are three free motions, the middle motion is unstable; a single motion is stable."""
    oscillator = Oscillator(0.215)
    for frequency, expected in [(1.0, [1]), (1.7, [1, -1, 1]), (2.3, [1])]:
        states = fixed_points(free_solutions(oscillator, frequency))
        found = stability(growth_rate(states, oscillator, None, frequency))
        assert found.tolist() == expected
