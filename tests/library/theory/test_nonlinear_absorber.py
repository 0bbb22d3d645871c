"""The nonlinear absorber against motions by SciPy, its linear limit, and the order of its peaks."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from impact_damper.theory.nonlinear_absorber import AbsorberOnDuffing, tuned_cubic
from impact_damper.theory.tuned_mass_damper import exact_optimum, least_maximum

MASS = 0.05


def settled(force, frequency):
    """Return the largest displacement of the settled motion divided by the force, by SciPy."""
    _, tuned, damping = exact_optimum(MASS)
    absorber = tuned_cubic(MASS, 1.0)

    def rate(t, y):
        x, speed, loose, loose_speed = y
        u, rate_u = x - loose, speed - loose_speed
        link = MASS * (tuned**2 * u + 2 * damping * tuned * rate_u) + absorber * u**3
        return [speed, force * np.cos(frequency * t) - x - x**3 - link, loose_speed, link / MASS]

    end = 60 * 2 * np.pi / frequency
    times = np.linspace(end - 2 * np.pi / frequency, end, 2001)
    found = solve_ivp(rate, (0, end), np.zeros(4), t_eval=times, rtol=1e-9, atol=1e-12)
    return np.max(np.abs(found.y[0])) / force


@pytest.mark.parametrize("frequency", [0.9, 0.95, 1.06])
def test_balance_is_the_motion(frequency):
    system = AbsorberOnDuffing(MASS, 1.0, tuned_cubic(MASS, 1.0), 0.03)
    found = system.displacement(system.balance(frequency))
    assert_allclose(found, settled(0.03, frequency), rtol=1e-4)


def test_linear_limit():
    found = AbsorberOnDuffing(MASS, 1.0, tuned_cubic(MASS, 1.0), 1e-5).peaks()
    assert_allclose(found.displacements, least_maximum(MASS), rtol=1e-5)


def test_peaks_are_equal_to_first_order():
    """Without the absorber's cubic spring the relative difference of the peaks grows as F^2.

    With this spring the difference is less than 3 % as large.
    """
    forces = (0.005, 0.01)

    def parted(absorber):
        peaks = [AbsorberOnDuffing(MASS, 1.0, absorber, force).peaks() for force in forces]
        return [each.displacements[1] / each.displacements[0] - 1 for each in peaks]

    linear, tuned = parted(0.0), parted(tuned_cubic(MASS, 1.0))
    assert_allclose(linear[1] / linear[0], 4, rtol=0.05)
    assert abs(tuned[1]) < 0.03 * abs(linear[1])
