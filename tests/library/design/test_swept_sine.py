"""Swept sine compared with SciPy's continuous sweep, and with closed forms of linear machines."""

import json
import math

import numpy as np
import pytest
from helpers.si_motions import SiMotion

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.design.swept_sine import forced, sweep_periods, swept_sine
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
    """Return the largest displacement (m) and the contacts in each cycle of a continuous sweep.

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
            # A turning point at the edge of two cycles counts in both.
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


@pytest.mark.parametrize(("first", "slope"), [(18.0, 0.05), (23.0, -0.05), (18.0, 1e-9)])
def test_periods_are_those_of_the_continuous_phase(first, slope):
    begins, frequencies = sweep_periods(first, slope, 1000)
    phases = first * begins + slope * begins**2 / 2
    np.testing.assert_allclose(phases, np.arange(1000), rtol=1e-13)
    middle = begins + 0.5 / frequencies
    np.testing.assert_allclose(frequencies, first + slope * middle, rtol=1e-8)


def test_a_slow_sweep_meets_the_resonance_peak():
    """In a slow sweep the peak has the height of the steady state, in faster ones it is lower.

    The height in steady state is 1/(2 zeta sqrt(1 - zeta^2)) static deflections.
    """
    damper = LINEAR.damper(**DAMPER)
    peak = 1e3 * 40 / 2e5 / (2 * 0.005 * math.sqrt(1 - 0.005**2))
    for rate, share in ((RATE / 4, 0.999), (RATE, 0.9905), (4 * RATE, 0.938)):
        found = swept_sine(LINEAR, damper, (19.5, 21.5), rate)
        for direction in ("up", "down"):
            bare = found["envelope"].sel(direction=direction, equipment="bare")
            assert float(bare.max()) / peak == pytest.approx(share, abs=3e-3), (rate, direction)


@pytest.mark.parametrize(
    ("excitation", "amplitude"),
    [
        ({"force": 40}, lambda w: 40.0),
        ({"unbalance": 0.003}, lambda w: 0.003 * w**2),
        ({"base_displacement": 1e-4}, lambda w: 1e-4 * math.hypot(2e5, w * LINEAR.viscous_damping)),
        (
            {"base_acceleration": 2.0},
            lambda w: 2.0 / w**2 * math.hypot(2e5, w * LINEAR.viscous_damping),
        ),
    ],
)
def test_a_sweep_begins_in_steady_state(excitation, amplitude):
    machine = idm.Machine(**SPRING, **excitation)
    found = swept_sine(machine, machine.damper(**DAMPER), (16.0, 26.0), 0.2)
    for direction, hertz in (("up", 16.0), ("down", 26.0)):
        w = 2 * math.pi * hertz
        expected = amplitude(w) / math.hypot(2e5 - 12 * w**2, w * machine.viscous_damping)
        first = found["envelope"].sel(direction=direction, equipment="bare")[0]
        assert float(first) == pytest.approx(1e3 * expected, rel=0.02)
        assert float(found["frequency"].sel(direction=direction)[0]) == pytest.approx(
            hertz, rel=1e-3
        )


def test_a_hardening_spring_goes_higher_upwards():
    found = swept_sine(HARD, HARD.damper(**DAMPER), (19.0, 26.0), 4 * RATE)
    up, down = found["envelope"].sel(equipment="bare").max("window")
    assert float(up) > 1.3 * float(down)
    assert np.all(found["transient_status"] == flag("transient_status", "completed"))
    assert np.isfinite(found["envelope"]).all()
    assert found["window_contacts"].sel(equipment="bare").sum() == 0
    assert found["window_contacts"].sel(equipment="damped").sum() > 0
    held = json.loads(found.attrs["sweep"])["held"]
    assert held[0] == pytest.approx(math.log(100) * 19 * 24 / HARD.viscous_damping, abs=1)
    last = found["frequency"].isel(window=-1)
    np.testing.assert_allclose(last, [26.0, 19.0], atol=0.01)


def test_a_machine_that_escapes_says_so():
    soft = idm.Machine(**SPRING, cubic_stiffness=-4e9, force=400)
    found = swept_sine(soft, soft.damper(**DAMPER), (15.0, 25.0), 0.1)
    escaped = found["transient_status"] == flag("transient_status", "escaped")
    assert escaped.sel(equipment="bare").all()
    bare = found["envelope"].sel(equipment="bare", direction="down").values
    assert np.isinf(bare).sum() == 1
    assert np.isnan(bare[np.argmax(np.isinf(bare)) + 1 :]).all()


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"machine": None}, "machine = None: must be a Machine"),
        ({"damper": None}, "damper = None: must be a MachineDamper"),
        ({"band": 20}, "band = 20: must be least and greatest frequency"),
        ({"band": (21, 20)}, "band = (21, 20): must be least and greatest frequency"),
        ({"band": (0, 20)}, "band[0] = 0 Hz: must be at least"),
        ({"rate": 0}, "rate = 0 Hz/s: must be greater than 0 Hz/s"),
        ({"rate": "1 Hz"}, "rate = '1 Hz': must be a number in Hz/s"),
        ({"rate": 5}, "rate = 5 Hz/s: must be at most 4 Hz/s (1 % of band[0] in a forcing cycle)"),
        ({"rate": 1e-6}, "rate = 1e-06 Hz/s: must be at least 4.2e-05 Hz/s (a sweep lasts"),
        ({"band": (20, 20.01)}, "rate = 0.5 Hz/s: must be at most 0.20005 Hz/s (a sweep lasts"),
    ],
)
def test_wrong_arguments_are_told(wrong, told):
    given = {"machine": LINEAR, "damper": LINEAR.damper(**DAMPER), "band": (20, 22), "rate": 0.5}
    given["rate"] = 0.5
    with pytest.raises((TypeError, ValueError)) as raised:
        swept_sine(**given | wrong)
    assert str(raised.value).startswith(told)
