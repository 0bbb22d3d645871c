"""Runs without contacts: order of the method, derivatives, and largest displacements."""

import numpy as np
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from impact_damper.design.smooth_runs import COUNT, SIZE, run

# force, damping, stiffness, cubic; 1/m, stiffness, damping and cubic stiffness of the absorber
PARAMETERS = np.array([0.7, 0.05, 1.1, 0.4, 20.0, 0.045, 0.012, 0.03])
START = np.array([0.6, -0.3, 0.2, 0.9])
PERIODS = 3


def reference(times):
    """Return states by SciPy. The equations are written out here a second time."""
    f, h, k, k3, inverse, kappa, eta, kappa3 = PARAMETERS

    def rate(t, y):
        x, v, u, w = y
        n = kappa * u + kappa3 * u**3 + eta * w
        a = f * np.cos(t) - h * v - k * x - k3 * x**3 - n
        return [v, a, w, a - n * inverse]

    span = (0, 2 * np.pi * PERIODS)
    return solve_ivp(rate, span, START, "DOP853", times, rtol=1e-13, atol=1e-15).y


def ours(number, start=START, derivatives=False):
    states, largest = start[None].copy(), np.empty((1, SIZE))
    slopes = np.empty((1, SIZE if derivatives else 0, SIZE))
    run(PARAMETERS[None], states, np.array([number]), PERIODS, slopes, largest)
    return states[0], slopes[0].T, largest[0]


def test_the_order_is_eight():
    assert len(PARAMETERS) == COUNT
    exact = reference([2 * np.pi * PERIODS])[:, -1]
    errors = [np.abs(ours(number)[0] - exact).max() for number in (12, 24)]
    assert 2**7.3 < errors[0] / errors[1] < 2**9.5
    assert_allclose(ours(60)[0], exact, atol=1e-11)


def test_derivatives_are_those_of_differences():
    _, slopes, _ = ours(40, derivatives=True)
    step = 1e-5
    for column in range(SIZE):
        change = step * np.eye(SIZE)[column]
        difference = (ours(40, START + change)[0] - ours(40, START - change)[0]) / (2 * step)
        assert_allclose(slopes[:, column], difference, atol=1e-8)


def test_largest_displacements_lie_between_steps():
    exact = np.abs(reference(np.linspace(0, 2 * np.pi * PERIODS, 40001))).max(axis=1)
    assert_allclose(ours(48)[2][::2], exact[::2], rtol=1e-7)
