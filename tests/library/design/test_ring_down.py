"""Ring-down compared with closed forms without a damper, and with SciPy with a damper."""

import math

import numpy as np
import pytest
from helpers.si_motions import SiMotion
from scipy.integrate import solve_ivp
from scipy.special import ellipk

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.design.ring_down import (
    MOST_WINDOWS,
    ring_down,
    unforced_amplitude,
    unforced_period,
)

SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005}
LINEAR = idm.Machine(**SPRING, force=40)
DAMPER = {"mass": 0.6, "gap": 0.008, "restitution": 0.7, "contact_stiffness": 2e7}
AT_REST = flag("transient_status", "at_rest")


def beginnings(found, equipment):
    """Return the times (s) at which the windows begin, and the envelope (mm)."""
    part = found.sel(equipment=equipment).dropna("window")
    return part["time"].values - 0.5 / part["frequency"].values, part["envelope"].values


def test_a_linear_machine_decays_exponentially():
    """Without the damper the envelope is an exponential.

    A window begins near a peak of the displacement, but not exactly at it, since its length is the
    undamped period.
    """
    found = ring_down(LINEAR, LINEAR.damper(**DAMPER), 0.01)
    times, largest = beginnings(found, "bare")
    rate = 0.005 * 2 * math.pi * LINEAR.natural_frequency
    np.testing.assert_allclose(largest, 10 * np.exp(-rate * times), rtol=6e-3)
    assert np.all(found["transient_status"] == AT_REST)
    assert len(times) == math.ceil(math.log(1000) / (2 * math.pi * 0.005))
    assert found["frequency"].sel(equipment="bare")[0] == pytest.approx(LINEAR.natural_frequency)
    assert found["window_contacts"].sel(equipment="bare").sum() == 0


def test_a_cubic_machine_decays_at_a_third_of_the_rate():
    """With a purely cubic spring, 2/3 of the energy E is kinetic on average.

    E therefore falls as exp(-4 c t/(3 m)), and the amplitude as its fourth root.
    """
    machine = idm.Machine(mass=12, cubic_stiffness=4e9, damping=10, force=40)
    found = ring_down(machine, machine.damper(**DAMPER), 0.01)
    times, largest = beginnings(found, "bare")
    middle = largest > 3
    expected = 10 * np.exp(-10 / (3 * 12) * times)
    np.testing.assert_allclose(largest[middle], expected[middle], rtol=0.02)
    frequencies = found["frequency"].sel(equipment="bare").values[: len(times)]
    np.testing.assert_allclose(
        frequencies[middle] / frequencies[0], expected[middle] / 10, rtol=0.02
    )


def test_a_damper_acts_as_scipy_says():
    found = ring_down(LINEAR, LINEAR.damper(**DAMPER), 0.01).sel(equipment="damped")
    found = found.isel(window=slice(15))
    ends = found["time"].values + 0.5 / found["frequency"].values
    peaks, contacts = np.zeros((2, 15))
    peaks[0] = 0.01
    motion = SiMotion(LINEAR, LINEAR.damper(**DAMPER), lambda t: 0.0)
    for wall, run in motion.run([0.01, 0, 0, 0], 0.0, ends[-1]):
        contacts[np.searchsorted(ends, run.t[0])] += wall != 0
        for moment in run.t_events[1]:
            k = np.searchsorted(ends, moment)
            peaks[k] = max(peaks[k], abs(run.sol(moment)[0]))
        for k in np.flatnonzero((ends >= run.t[0]) & (ends <= run.t[-1])):
            beyond = abs(run.sol(ends[k])[0])
            peaks[k : k + 2] = np.maximum(peaks[k : k + 2], beyond)
    np.testing.assert_allclose(found["envelope"], 1e3 * peaks, rtol=1e-6)
    np.testing.assert_array_equal(found["window_contacts"], contacts)
    assert contacts.sum() > 20


def test_every_end_is_told():
    soft = idm.Machine(**SPRING, cubic_stiffness=-4e9, force=40)
    barrier = math.sqrt(2e5 / 4e9)
    over = ring_down(soft, soft.damper(**DAMPER), 1.2 * barrier)
    assert np.all(over["transient_status"] == flag("transient_status", "escaped"))
    assert np.isinf(over["envelope"].isel(window=-1)).all()
    below = ring_down(soft, soft.damper(**DAMPER), 0.95 * barrier)
    assert np.all(below["transient_status"] == AT_REST)
    light = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=1e-6, force=40)
    endless = ring_down(light, light.damper(**DAMPER), 0.01)
    status = endless["transient_status"].sel(equipment="bare")
    assert status == flag("transient_status", "limit")
    assert endless.sizes["window"] == MOST_WINDOWS


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"machine": None}, "machine = None: must be a Machine"),
        ({"damper": None}, "damper = None: must be a MachineDamper"),
        ({"displacement": 0}, "displacement = 0 m: must be greater than 0 m and at most 2 m"),
    ],
)
def test_wrong_arguments_are_told(wrong, told):
    given = {"machine": LINEAR, "damper": LINEAR.damper(**DAMPER), "displacement": 0.01}
    with pytest.raises((TypeError, ValueError)) as raised:
        ring_down(**given | wrong)
    assert str(raised.value).startswith(told)


@pytest.mark.parametrize(
    ("stiffness", "cubic", "amplitude"), [(1, 2, 1.5), (0, 1, 0.3), (1, -1, 0.9), (4, 0.1, 0.2)]
)
def test_period_is_that_of_the_equation_of_motion(stiffness, cubic, amplitude):
    def stopped(t, y):
        return y[1]

    stopped.direction, stopped.terminal = 1, True
    period = unforced_period(stiffness, cubic, amplitude)
    run = solve_ivp(
        lambda t, y: [y[1], -stiffness * y[0] - cubic * y[0] ** 3],
        (0, 2 * period),
        [amplitude, 0.0],
        method="DOP853",
        events=stopped,
        rtol=1e-12,
        atol=1e-13,
    )
    # The event is at the other end of the motion, after half a period.
    assert run.t_events[0][-1] == pytest.approx(period / 2, rel=1e-9)
    energy = stiffness * amplitude**2 / 2 + cubic * amplitude**4 / 4
    assert unforced_amplitude(stiffness, cubic, energy) == pytest.approx(amplitude, rel=1e-13)


def test_limits_of_the_period():
    assert unforced_period(4.0, 0.0, 0.7) == pytest.approx(math.pi, rel=1e-15)
    assert unforced_period(0.0, 1.0, 2.0) == pytest.approx(2 * ellipk(0.5), rel=1e-15)
    assert unforced_period(1.0, -1.0, 1.0) == math.inf
    assert unforced_amplitude(1.0, -1.0, 0.25) == math.inf
    assert unforced_amplitude(1.0, -1.0, 0.0) == 0
