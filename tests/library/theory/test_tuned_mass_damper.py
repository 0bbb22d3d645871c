"""Closed forms of the tuned mass damper against direct optimisation of its response."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize

from impact_damper.theory.tuned_mass_damper import Tuning, exact_optimum

MASSES = [0.01, 0.05, 0.2, 0.7]


def response(tuning, frequency):
    """Return the amplitude of the primary mass over the static deflection."""
    mass, tuned, damping = tuning
    coupling = tuned**2 + 2j * damping * tuned * frequency
    absorber = coupling - frequency**2
    return np.abs(absorber / ((1 - frequency**2) * absorber - mass * frequency**2 * coupling))


@pytest.mark.parametrize("mass", MASSES)
def test_exact_optimum_is_the_least_maximum(mass):
    frequencies = np.linspace(0.3, 1.6, 26001)
    best = exact_optimum(mass)
    found = minimize(
        lambda v: response(Tuning(mass, *v), frequencies).max(),
        (1 / (1 + mass), np.sqrt(3 * mass / (8 * (1 + mass)))),
        method="Nelder-Mead",
        options={"xatol": 1e-8, "fatol": 1e-11, "maxiter": 2000},
    )
    assert_allclose(found.fun, response(best, frequencies).max(), rtol=1e-6)
    assert_allclose(found.x, best[1:], rtol=1e-3)
