"""Transients against SciPy's continuous sweep and decay, and against closed forms."""

import math

import numpy as np
import pytest
from helpers.si_motions import SiMotion
from scipy.special import ellipk

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.design.transients import (
    MOST_WINDOWS,
    decay,
    forced,
    ring_down,
    sweep_periods,
    swept_sine,
    unforced_amplitude,
    unforced_period,
)
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions.records import envelope

SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005}
LINEAR = idm.Machine(**SPRING, force=40)
HARD = idm.Machine(**SPRING, cubic_stiffness=4e8, force=40)
DAMPER = {"mass": 0.6, "gap": 0.008, "restitution": 0.7, "contact_stiffness": 2e7}
NATURAL = LINEAR.natural_frequency
# At this rate (Hz/s) the frequency crosses the width 2 zeta f of the resonance in 2/(zeta f), which
# is 4 pi times the decay time 1/(2 pi zeta f) of the machine.
RATE = (0.005 * NATURAL) ** 2


def continuous(machine, damper, first, slope, edges):
    """Return for each cycle of a continuous sweep largest displacement (m) and number of contacts.

    SciPy integrates the sweep. `edges` are the times at which the cycles begin and end.
    """
    count = len(edges) - 1

    def force(t):
        return machine.force * math.cos(2 * math.pi * (0.25 + first * t + slope * t**2 / 2))

    peaks, contacts = np.zeros((2, count))
    for wall, run in SiMotion(machine, damper, force).run(np.zeros(4), 0.0, edges[-1]):
        begun = np.searchsorted(edges, run.t[0], side="right") - 1
        contacts[begun] += wall != 0
        turns = np.concatenate([run.t_events[1], edges[(edges >= run.t[0]) & (edges <= run.t[-1])]])
        for moment in turns:
            # A turning point at the moment between two cycles counts in both cycles.
            after = np.searchsorted(edges, moment, side="right") - 1
            before = np.searchsorted(edges, moment, side="left") - 1
            for k in {min(after, count - 1), max(before, 0)}:
                peaks[k] = max(peaks[k], abs(run.sol(moment)[0]))
    return peaks, contacts


@pytest.mark.parametrize(
    ("machine", "damped", "first", "slope", "count", "error"),
    [
        (LINEAR, False, 20.2, 10 * RATE, 100, 1e-5),
        (HARD, False, 21.2, -10 * RATE, 100, 2e-5),
        (LINEAR, True, 20.3, 4 * RATE, 40, 5e-5),
    ],
)
def test_a_sweep_in_steps_is_as_good_as_a_continuous_one(
    machine, damped, first, slope, count, error
):
    """The envelopes differ by at most `error` times the largest value.

    With the damper only 40 cycles are compared, because chaos makes the motions diverge later.
    """
    damper = machine.damper(**DAMPER) if damped else None
    begins, frequencies = sweep_periods(first, slope, count)
    edges = np.append(begins, begins[-1] + 1 / frequencies[-1])
    rows = forced(machine, damper, frequencies)
    found, contacts = envelope(rows, 2 * np.pi / rows[:, FREQUENCY], np.zeros(4), 1e-12)
    peaks, begun = continuous(machine, damper, first, slope, edges)
    found = machine.scales.to_si(found, "displacement")
    np.testing.assert_allclose(found, peaks, rtol=0, atol=error * peaks.max())
    np.testing.assert_array_equal(contacts, begun)
    assert (begun.sum() > 60) == damped


def test_a_slow_sweep_meets_the_resonance_peak():
    """In a slow sweep the peak has the height in steady state; in a faster sweep it is lower.

    The height in steady state is 1/(2 zeta sqrt(1 - zeta^2)) static deflections.
    """
    damper = LINEAR.damper(**DAMPER)
    peak = 1e3 * 40 / 2e5 / (2 * 0.005 * math.sqrt(1 - 0.005**2))
    for rate, share in ((RATE / 4, 0.999), (RATE, 0.9905), (4 * RATE, 0.938)):
        found = swept_sine(LINEAR, damper, (19.5, 21.5), rate)
        for direction in ("up", "down"):
            bare = found["sweep_envelope"].sel(direction=direction, equipment="bare")
            assert float(bare.max()) / peak == pytest.approx(share, abs=3e-3), (rate, direction)


@pytest.mark.parametrize(
    ("excitation", "amplitude"),
    [
        ({"force": 40}, lambda w: 40.0),
        ({"unbalance": 0.003}, lambda w: 0.003 * w**2),
        ({"base_displacement": 1e-4}, lambda w: 12 * 1e-4 * w**2),
        ({"base_acceleration": 2.0}, lambda w: 12 * 2.0),
    ],
)
def test_a_sweep_begins_in_steady_state(excitation, amplitude):
    machine = idm.Machine(**SPRING, **excitation)
    found = swept_sine(machine, machine.damper(**DAMPER), (16.0, 26.0), 0.2)
    for direction, hertz in (("up", 16.0), ("down", 26.0)):
        w = 2 * math.pi * hertz
        expected = amplitude(w) / math.hypot(2e5 - 12 * w**2, w * machine.viscous_damping)
        first = found["sweep_envelope"].sel(direction=direction, equipment="bare")[0]
        assert float(first) == pytest.approx(1e3 * expected, rel=0.02)
        assert float(found["sweep_frequency"].sel(direction=direction)[0]) == pytest.approx(
            hertz, rel=1e-3
        )


def test_a_machine_that_escapes_says_so():
    soft = idm.Machine(**SPRING, cubic_stiffness=-4e9, force=400)
    found = swept_sine(soft, soft.damper(**DAMPER), (15.0, 25.0), 0.1)
    escaped = found["sweep_status"] == flag("sweep_status", "escaped")
    assert escaped.sel(equipment="bare").all()
    bare = found["sweep_envelope"].sel(equipment="bare", direction="down").values
    assert np.isinf(bare).sum() == 1
    assert np.isnan(bare[np.argmax(np.isinf(bare)) + 1 :]).all()


def test_a_linear_machine_decays_exponentially():
    """Without the damper the envelope is an exponential.

    A window begins near a peak of the displacement, but not exactly at it, since its length is the
    undamped period.
    """
    rows, end = decay(LINEAR, None, 0.01)
    times, largest = rows[:, 0] - 0.5 / rows[:, 1], 1e3 * rows[:, 2]
    rate = 0.005 * 2 * math.pi * LINEAR.natural_frequency
    np.testing.assert_allclose(largest, 10 * np.exp(-rate * times), rtol=6e-3)
    assert end == "at_rest" and np.all(rows[:, 3] == 0)
    assert len(times) == math.ceil(math.log(1000) / (2 * math.pi * 0.005))
    assert rows[0, 1] == pytest.approx(LINEAR.natural_frequency)
    found = ring_down(LINEAR, LINEAR.damper(**DAMPER), 0.01)
    np.testing.assert_array_equal(found["ring_envelope"][0, : len(rows)], largest)


def test_a_cubic_machine_decays_at_a_third_of_the_rate():
    """With a purely cubic spring, 2/3 of the energy E is kinetic on average.

    E therefore falls as exp(-4 c t/(3 m)), and the amplitude as the fourth root of E.
    """
    machine = idm.Machine(mass=12, cubic_stiffness=4e9, damping=10, force=40)
    rows, _ = decay(machine, None, 0.01)
    times, largest = rows[:, 0] - 0.5 / rows[:, 1], 1e3 * rows[:, 2]
    middle = largest > 3
    expected = 10 * np.exp(-10 / (3 * 12) * times)
    np.testing.assert_allclose(largest[middle], expected[middle], rtol=0.02)
    frequencies = rows[:, 1]
    np.testing.assert_allclose(
        frequencies[middle] / frequencies[0], expected[middle] / 10, rtol=0.02
    )


def test_a_damper_acts_as_scipy_says():
    rows = decay(LINEAR, LINEAR.damper(**DAMPER), 0.01)[0][:15]
    ends = rows[:, 0] + 0.5 / rows[:, 1]
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
    np.testing.assert_allclose(rows[:, 2], peaks, rtol=1e-6)
    np.testing.assert_array_equal(rows[:, 3], contacts)
    assert contacts.sum() > 20


@pytest.mark.parametrize("coefficient", [0, 0.5])
def test_a_vertical_damper_comes_to_rest_under_its_weight(coefficient):
    """At rest the machine's spring carries the loose mass: its deflection is m2 g/k = 0.029 mm."""
    mount = {"inclination": "90 deg", "friction_coefficient": coefficient, "normal_force": 2}
    rows, end = decay(LINEAR, LINEAR.damper(**DAMPER, mount=mount), 0.01)
    assert end == "at_rest"
    assert 0.6 * 9.81 / 2e5 < rows[-1, 2] < 0.6 * 9.81 / 2e5 + 2e-5


def test_every_end_is_told():
    soft = idm.Machine(**SPRING, cubic_stiffness=-4e9, force=40)
    barrier = math.sqrt(2e5 / 4e9)
    rows, end = decay(soft, soft.damper(**DAMPER), 1.2 * barrier)
    assert end == "escaped" and np.isinf(rows[-1, 2])
    assert decay(soft, soft.damper(**DAMPER), 0.95 * barrier)[1] == "at_rest"
    light = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=1e-6, force=40)
    rows, end = decay(light, None, 0.01)
    assert end == "limit" and len(rows) == MOST_WINDOWS


def test_limits_of_the_period():
    assert unforced_period(4.0, 0.0, 0.7) == pytest.approx(math.pi, rel=1e-15)
    assert unforced_period(0.0, 1.0, 2.0) == pytest.approx(2 * ellipk(0.5), rel=1e-15)
    assert unforced_period(1.0, -1.0, 1.0) == math.inf
    assert unforced_amplitude(1.0, -1.0, 0.25) == math.inf
    assert unforced_amplitude(1.0, -1.0, 0.0) == 0
