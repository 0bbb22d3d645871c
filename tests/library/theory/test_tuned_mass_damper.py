"""Closed forms of the tuned mass damper against direct optimisation of its response."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.optimize import minimize

from impact_damper.theory.tuned_mass_damper import (
    Tuning,
    den_hartog,
    exact_optimum,
    fixed_point,
    least_maximum,
    peaks,
    response,
)

MASSES = [0.01, 0.05, 0.2, 0.7]


@pytest.mark.thorough
def test_response_is_that_of_the_equations():
    """The largest displacement of the settled motion, by SciPy."""
    mass, tuned, damping = tuning = Tuning(0.1, 0.93, 0.2)
    r = 0.9

    def rate(t, y):
        x, speed, loose, loose_speed = y
        link = mass * tuned**2 * (x - loose) + 2 * mass * damping * tuned * (speed - loose_speed)
        return [speed, np.cos(r * t) - x - link, loose_speed, link / mass]

    end = 250 * 2 * np.pi / r
    times = np.linspace(end - 2 * np.pi / r, end, 401)
    found = solve_ivp(rate, (0, end), np.zeros(4), t_eval=times, rtol=1e-10, atol=1e-10)
    assert_allclose(np.max(np.abs(found.y[0])), response(tuning, r), rtol=2e-4)


@pytest.mark.parametrize("mass", MASSES)
def test_exact_optimum_is_the_least_maximum(mass):
    frequencies = np.linspace(0.3, 1.6, 26001)
    best = exact_optimum(mass)
    found = minimize(
        lambda v: response(Tuning(mass, *v), frequencies).max(),
        den_hartog(mass)[1:],
        method="Nelder-Mead",
        options={"xatol": 1e-8, "fatol": 1e-11, "maxiter": 2000},
    )
    assert_allclose(found.fun, least_maximum(mass), rtol=1e-6)
    assert_allclose(found.x, best[1:], rtol=1e-3)
    assert_allclose(peaks(best)[1], least_maximum(mass), rtol=1e-10)


@pytest.mark.parametrize("mass", MASSES)
def test_fixed_points_do_not_depend_on_damping(mass):
    """Curves of any two dampings meet in two points, at the same height for this tuning."""
    tuned = den_hartog(mass)
    frequencies = np.linspace(0.2, 1.7, 300001)
    first, second = (response(tuned._replace(damping_ratio=z), frequencies) for z in (0.1, 0.4))
    crossed = np.flatnonzero(np.diff(np.sign(first - second)))
    heights = first[crossed[-2:]]
    assert_allclose(heights, fixed_point(mass), rtol=1e-3)
