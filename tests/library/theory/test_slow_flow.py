"""The slow flow (averaged equations) against equations (17), its Jacobian against differences.

Symbols are as in `system.parameters`. Numbers in brackets are equations of the paper.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.free_oscillator import free_solutions
from impact_damper.theory.single_harmonic import contact_amplitude, impacting_solutions
from impact_damper.theory.slow_flow import (
    fixed_points,
    growth_rate,
    jacobian,
    slow_flow,
    stability,
)

SCENE = Oscillator(0.215, 0.7), Damper(0.12, 1.5), 1.6


def polar_flow(state, oscillator, damper, frequency):
    """Return the rates of change of the amplitudes and phases by equations (17a) to (17d).

    The amplitude and phase of Z1 are a and t1, those of Z2 are b and t2.
    """
    a, t1, b, t2 = state
    push = damper.contact_stiffness * contact_amplitude(b, damper.clearance)[0]
    spring = a * oscillator.linear_frequency**2 + 0.75 * a**3
    drag = oscillator.damping * a * frequency
    total = push * (1 + 1 / damper.mass_ratio)
    along = np.cos(t1) - push * np.cos(t2 - t1) - spring + a * frequency**2
    across = b * frequency**2 - total + drag * np.sin(t1 - t2) - spring * np.cos(t2 - t1)
    return -np.array([
        drag + push * np.sin(t2 - t1) + np.sin(t1),
        along / a,
        np.sin(t2) + drag * np.cos(t1 - t2) + spring * np.sin(t1 - t2),
        (across + np.cos(t2)) / b,
    ]) / (2 * frequency)  # fmt: skip


def cartesian(state):
    a, t1, b, t2 = state
    return np.array([a * np.cos(t1), a * np.sin(t1), b * np.cos(t2), b * np.sin(t2)])


def differences(function, state, step=1e-6):
    columns = [(function(state + shift) - function(state - shift)) / (2 * step)
               for shift in step * np.eye(len(state))]  # fmt: skip
    return np.array(columns).T


def random_states(count):
    generator = np.random.default_rng(11)
    for _ in range(count):
        yield generator.uniform([0.1, -3, 1.55, -3], [2.5, 3, 1.9, 3])


def test_cartesian_flow_is_the_polar_one():
    for polar in random_states(50):
        rates = slow_flow(cartesian(polar), *SCENE)
        turn = differences(cartesian, polar) @ polar_flow(polar, *SCENE)
        assert_allclose(rates, turn, rtol=1e-7, atol=1e-7)


def test_solutions_of_7_are_fixed_points_with_the_eigenvalues_of_the_polar_jacobian():
    """At fixed points the element J33 of the Jacobian is 0, as in appendix A of the paper."""
    solutions = impacting_solutions(*SCENE)
    states = fixed_points(solutions)
    assert_allclose(slow_flow(states, *SCENE), 0, atol=1e-11)
    assert len(states) >= 2
    for a, b, phase, state in zip(*solutions, states, strict=True):
        polar = differences(lambda x: polar_flow(x, *SCENE), np.array([a, phase, b, phase]))
        assert polar[2, 2] == 0
        expected = np.sort_complex(np.linalg.eigvals(polar))
        found = np.sort_complex(np.linalg.eigvals(jacobian(state, *SCENE)))
        assert_allclose(found, expected, rtol=1e-6, atol=1e-6)


def test_divergence_is_minus_the_damping():
    """Only the dashpot of the primary mass contracts volume in the elastic slow flow."""
    for polar in random_states(20):
        assert_allclose(np.trace(jacobian(cartesian(polar), *SCENE)), -0.215, rtol=1e-10)


def test_slope_criterion_of_the_free_response():
    """Of three motions without the damper the middle one is unstable; a single one is stable."""
    oscillator = Oscillator(0.215)
    for frequency, expected in [(1.0, [1]), (1.7, [1, -1, 1]), (2.3, [1])]:
        states = fixed_points(free_solutions(oscillator, frequency))
        found = stability(growth_rate(states, oscillator, None, frequency))
        assert found.tolist() == expected


@pytest.mark.thorough
def test_stable_solutions_attract_and_unstable_ones_repel():
    """By integrating the slow flow from a small displacement, for several e-folding times."""
    states = fixed_points(impacting_solutions(*SCENE))
    rates = growth_rate(states, *SCENE)
    signs = stability(rates)
    assert {1, -1} <= set(signs.tolist())
    displacement = 1e-6 * np.array([1, -0.5, 0.3, 0.8])
    for state, rate, sign in zip(states, rates, signs, strict=True):
        run = solve_ivp(
            lambda _, x: slow_flow(x, *SCENE),
            (0, (3 if sign == 1 else 10) / abs(rate)),
            state + displacement,
            "DOP853",
            rtol=1e-10,
            atol=1e-12,
        )
        ratio = np.linalg.norm(run.y[:, -1] - state) / np.linalg.norm(displacement)
        assert ratio < 0.5 if sign == 1 else ratio > 100
