"""A state of a dataset has a phase. Every function that takes the state begins at this phase."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

import impact_damper as idm

OSCILLATOR = idm.Oscillator(0.215)
DAMPER = idm.Damper(0.12, 2.0)
FREQUENCY = 2.0
NEAR_QUIET = (0.006, 0.187, 0.002, -2.408)
MACHINE = idm.Machine(
    mass=12, linear_stiffness=2e5, cubic_stiffness=4e9, damping_ratio=0.02, force=40
)


@pytest.fixture(scope="module")
def quiet():
    return idm.steady_motion(OSCILLATOR, DAMPER, FREQUENCY, NEAR_QUIET)


def test_a_free_orbit_agrees_with_scipy_from_its_phase():
    steady = idm.steady_motion(OSCILLATOR, None, 1.6, (1.5, 0))
    phase = steady.state.state_phase.item()

    def rate(t, y):
        return y[1], np.cos(1.6 * t) - 0.215 * y[1] - y[0] ** 3

    span = phase / 1.6 + np.array([0, 2 * np.pi / 1.6])
    end = solve_ivp(rate, span, steady.state.values[:2], rtol=1e-11, atol=1e-11).y[:, -1]
    assert_allclose(end, steady.state[:2], atol=1e-7)


def test_another_start_than_the_phase_is_refused(quiet):
    for call in (idm.simulate, idm.steady_motion):
        with pytest.raises(ValueError, match="start = 0: must be at the phase W T = 1.5708"):
            call(OSCILLATOR, DAMPER, FREQUENCY, quiet.state, start=0)


def test_a_state_of_a_machine_keeps_its_phase():
    steady = idm.steady_motion(MACHINE, None, 24.0, (0, 0))
    run = idm.simulate(MACHINE, None, 24.0, steady.state, periods=1)
    assert_allclose(run.time[0], 0.25 / 24)
    assert_allclose(run.displacement[-1], run.displacement[0], atol=1e-6)
    with pytest.raises(ValueError, match=r"start = 0\.01.*: must be at the phase"):
        idm.simulate(MACHINE, None, 24.0, steady.state, start=0.01)


def test_units_of_states_are_not_mixed_up(quiet):
    steady = idm.steady_motion(MACHINE, None, 24.0, (0, 0))
    with pytest.raises(ValueError, match="state = .*is in m, m/s"):
        idm.simulate(OSCILLATOR, None, 2.0, steady.state)
    with pytest.raises(ValueError, match="state = .*must be in m, m/s, m, m/s"):
        idm.simulate(MACHINE, None, 24.0, quiet.state)
