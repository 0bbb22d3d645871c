"""The 80-bit reference with springs and forces of every kind, against SciPy and in other units."""

import numpy as np
import pytest
from references import equation, extended
from references.equation import SPRINGS, in_other_units
from scipy.integrate import solve_ivp

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper

pytestmark = pytest.mark.skipif(bool(extended.obstacle()), reason=extended.obstacle())

DAMPER = Damper(0.3, 0.5, 0.8, 400.0)


@pytest.mark.parametrize("name", SPRINGS)
def test_flights_are_those_of_scipy(name):
    oscillator, frequency = SPRINGS[name], 1.3
    p = pack(oscillator, None, frequency)
    start, times = np.array([0.2, 0.1, 0.1, 0.3]), [1.0, 5.0]
    run = extended.run(p, start, 0.0, times)
    settings = {"t_eval": times, "rtol": 1e-13, "atol": 1e-13}
    expected = solve_ivp(equation.rates(p), (0, times[-1]), start, "DOP853", **settings).y.T
    assert run.states.astype(float) == pytest.approx(expected, abs=1e-10)


@pytest.mark.parametrize("name", SPRINGS)
def test_motions_with_contacts_in_other_units(name):
    """Units that are powers of two keep all digits; only the allowed error of a step differs."""
    length, time = 0.25, 4.0
    state, scale = np.array([0.1, 0.2, 0.3, 1.5]), np.array([1, time, 1, time]) / length
    other, damper, frequency = in_other_units(SPRINGS[name], DAMPER, 1.3, length, time)
    ours = extended.run(pack(SPRINGS[name], DAMPER, 1.3), state, 0.0, [6.0])
    theirs = extended.run(pack(other, damper, frequency), state * scale, 0.0, [6.0 / time])
    assert ours.begun == theirs.begun > 1
    assert np.max(np.abs(theirs.states / scale - ours.states)) < 1e-16 * ours.growth
    assert np.max(np.abs(theirs.contacts[:, 1] * time - ours.contacts[:, 1])) < 1e-15 * ours.growth
