"""Hardening, softening and linear springs with all forcings, against laws and SciPy."""

import math

import numpy as np
import pytest
from helpers.sampling import flow_map, sample
from numpy.testing import assert_allclose
from references import equation
from references.equation import SPRINGS, in_other_units
from scipy.integrate import quad, solve_ivp

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator

OSCILLATORS = SPRINGS | {
    "no_force": Oscillator(0.05, 0.9, 0.5, 0.0),
    "no_spring": Oscillator(0.1, 0.0, 0.0, 0.6),
}
DAMPER = Damper(0.15, 0.6, 0.8, 900.0)
FREQUENCY = 1.3
STATE = np.array([0.35, 0.8, 0.1, -0.4])
all_oscillators = pytest.mark.parametrize("oscillator", OSCILLATORS.values(), ids=OSCILLATORS)


@all_oscillators
@pytest.mark.parametrize("units", [(5.0, 1.0), (1.4, 0.3)], ids=str)
def test_a_change_of_units_changes_nothing_else(oscillator, units):
    """States, contacts and the derivative of the flow agree up to the growth of errors."""
    length, time = units
    size = np.array([1.0, time, 1.0, time]) / length
    times = np.linspace(0.2, 14.0, 60)
    here = pack(oscillator, DAMPER, FREQUENCY)
    there = pack(*in_other_units(oscillator, DAMPER, FREQUENCY, *units))
    states, log = sample(here, STATE, 0.0, times)
    others, other_log = sample(there, STATE * size, 0.0, times / time)
    assert len(log) > 2 and np.array_equal(log[:, 0], other_log[:, 0])
    assert_allclose(log[:, 1], other_log[:, 1] * time, atol=1e-10)
    assert_allclose(others / size, states, atol=1e-10)
    _, matrix, _ = flow_map(here, STATE, 0.0, 2, False, 1e-13)
    _, other_matrix, _ = flow_map(there, STATE * size, 0.0, 2, False, 1e-13)
    growth = np.max(np.abs(matrix))
    assert_allclose(other_matrix * size / size[:, None], matrix, atol=1e-9 * growth**2)


@all_oscillators
def test_flights_and_contacts_against_dop853(oscillator):
    """SciPy integrates from one event to the next, and arrives at the kernel's states on walls."""
    p, end = pack(oscillator, DAMPER, FREQUENCY), 12.0
    _, log = sample(p, STATE, 0.0, [end])
    ends = [(0.0, 0)]
    for wall, begin, finish, *_ in log[np.isfinite(log[:, 2])]:
        ends += [(begin, int(wall)), (finish, 0)]
    instants = [begin for begin, _ in ends]
    states, _ = sample(p, STATE, 0.0, instants)
    for (begin, side), (finish, _), first, last in zip(
        ends, ends[1:], states, states[1:], strict=False
    ):
        found = solve_ivp(
            equation.rates(p, side), (begin, finish), first, method="DOP853", rtol=1e-12, atol=1e-13
        )
        assert_allclose(found.y[:, -1], last, atol=2e-10)
        wall = side if side else np.sign(last[2])
        assert_allclose(found.y[2, -1], wall * DAMPER.clearance, atol=2e-10)
    assert len(ends) > 4


@all_oscillators
def test_tangents_against_differences(oscillator):
    p, h = pack(oscillator, DAMPER, FREQUENCY), 1e-5
    _, matrix, touching = flow_map(p, STATE, 0.0, 1, False, 1e-14)
    for k, unit in enumerate(np.eye(4)):
        ahead, _, _ = flow_map(p, STATE + h * unit, 0.0, 1, False, 1e-14)
        behind, _, _ = flow_map(p, STATE - h * unit, 0.0, 1, False, 1e-14)
        difference = (ahead - behind) / (2 * h)
        assert_allclose(difference, matrix[:, k], atol=1e-6 * np.max(np.abs(matrix)) ** 2)
    assert touching > 0


@pytest.mark.parametrize("damping", [1e-5, 0.02, 0.4])
@pytest.mark.parametrize("force", [0.0, 0.7])
def test_linear_oscillator_in_closed_form(damping, force):
    """The motion is the sum of a harmonic steady motion and a decaying unforced motion."""
    natural, w = 1.2, FREQUENCY
    oscillator = Oscillator(damping, natural, 0.0, force, 0.1)
    amplitude = oscillator.forcing_amplitude(w)
    complex_amplitude = amplitude / (natural**2 - w**2 + 1j * damping * w)
    times = np.linspace(0.5, 60.0, 120)
    root = -damping / 2 + 1j * math.sqrt(natural**2 - damping**2 / 4)
    x0, v0 = STATE[:2]
    x0, v0 = x0 - complex_amplitude.real, v0 - (1j * w * complex_amplitude).real
    free = x0 - 1j * (v0 - root.real * x0) / root.imag
    expected = (free * np.exp(root * times) + complex_amplitude * np.exp(1j * w * times)).real
    states, _ = sample(pack(oscillator, None, w), np.tile(STATE[:2], 2), 0.0, times)
    assert_allclose(states[:, 0], expected, atol=3e-13)


def test_time_of_an_escape():
    """The time to reach a place beyond the barrier is the integral of 1/speed."""
    p = pack(Oscillator(1e-9, 1.0, -0.2, 0.0), None, 1.0)
    speed = math.sqrt(2 * 1.05 * equation.potential(p, 1 / math.sqrt(0.2)))
    place = 4.0

    def slowness(x):
        return 1 / math.sqrt(speed**2 - 2 * equation.potential(p, x))

    time, _ = quad(slowness, 0, place, epsabs=1e-13, epsrel=1e-13)
    (state,), _ = sample(p, [0.0, speed, 0.0, speed], 0.0, [time])
    assert_allclose(state[0], place, atol=1e-7)
    states, _ = sample(p, [0.0, speed, 0.0, speed], 0.0, time + np.linspace(0, 20, 50))
    gone = np.isnan(states[:, 0])
    assert gone[-1] and not gone[0] and np.array_equal(np.sort(gone), gone)
