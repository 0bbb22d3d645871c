"""One-third subharmonic: long runs on both sides of its ends, and its energy balance."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from chatterjee1995.stages.subharmonic import (
    free_subharmonic,
    subharmonic_suppression,
    switched_on,
)
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.simulate import COMPONENTS, simulate
from impact_damper.motions.steady import steady_motion

PAPER = Oscillator(0.215)
DAMPER = Damper(0.12, 2.0)


@pytest.fixture(scope="module")
def free():
    return free_subharmonic(PAPER, 1.6, 2.2, starts=12, settling=Settling())


@pytest.fixture(scope="module")
def damped():
    return subharmonic_suppression(
        PAPER, DAMPER, np.linspace(1.6, 2.2, 21), starts=32, settling=Settling()
    )


def from_strobe(state, damper, frequency, periods=1):
    """Simulate a motion from a state at W T = pi/2 over some forcing cycles."""
    given = {"periods": periods, "samples": 4000, "start": 0.5 * np.pi / frequency}
    return simulate(PAPER, damper, frequency, state, **given)


def settled(state, damper, frequency):
    """Return the motion to which a state at W T = pi/2 leads."""
    last = from_strobe(state, damper, frequency, 0.75).isel(time=-1)
    return steady_motion(PAPER, damper, frequency, [float(last[name]) for name in COMPONENTS])


@pytest.mark.parametrize("side", [0, 1])
def test_free_subharmonic_ends_where_long_runs_leave_it(free, side):
    inward = 1 if side == 0 else -1
    end = free.ends[side]
    state = free.at(end + inward * 2e-4)["state"]
    assert settled(state, None, end + inward * 2e-4).period == 3
    assert settled(state, None, end - inward * 2e-4).period == 1
    assert free.at(end - inward * 2e-4) is None


def test_free_subharmonic_is_symmetric_and_balances_its_energy(free):
    """Z1 changes sign after half a period; the damping dissipates the work of the force."""
    state = free.at(1.9)["state"]
    motion = from_strobe(state, None, 1.9, 3)
    half = motion.displacement.values[len(motion.time) // 2 :]
    assert_allclose(half, -motion.displacement.values[: len(half)], atol=1e-9)
    assert_energy_balance(motion, 1.9)
    size = free.at(1.9)["maximum_displacement"]
    assert_allclose(np.abs(motion.displacement).max(), size, rtol=1e-6)


def assert_energy_balance(motion, frequency):
    velocity = motion.velocity.values
    work = np.trapezoid(np.cos(frequency * motion.time.values) * velocity, motion.time.values)
    loss = PAPER.damping * np.trapezoid(velocity**2, motion.time.values)
    assert_allclose(work, loss, rtol=1e-4)


@pytest.mark.thorough
def test_damped_subharmonic_is_a_motion_of_period_3(damped):
    """Some starts on the free subharmonic lead to the subharmonic with damper."""
    present = np.isfinite(damped.free_subharmonic)
    assert np.array_equal(np.isfinite(damped.switched_share), present)
    row = damped.sel(frequency=1.85, method="nearest")
    assert 0 < row.switched_share < 1 and 0 < row.subharmonic_ratio < 0.95
    frequency = float(row.frequency)
    place = int(np.flatnonzero(row.period.values == 3)[0])
    motion = from_strobe(row.state.values[place], DAMPER, frequency, 3)
    values = motion.displacement.values
    assert_allclose(values[-1], values[0], atol=1e-7)
    assert abs(values[4000] - values[0]) > 1e-3
    assert_allclose(np.abs(values).max(), row.damped_subharmonic, rtol=1e-5)
    assert_energy_balance(motion, frequency)


def test_switching_on_keeps_the_primary_on_the_subharmonic_until_a_contact(free):
    """With walls out of reach the first strobe state is one of three states of the free motion."""
    p = pack(PAPER, Damper(0.12, 500.0), 1.9)
    state = free.at(1.9)["state"]
    loose = np.tile([0.0, 0.0, 1.0, 2.0], (20, 1))
    states = switched_on(PAPER, p, state, loose, np.random.default_rng(1))
    motion = simulate(PAPER, None, 1.9, state, periods=3, samples=4, start=0.5 * np.pi / 1.9)
    free_states = np.stack([motion.displacement, motion.velocity], axis=1)[[3, 7, 11]]
    away = np.abs(states[:, None, :2] - free_states).max(axis=2)
    assert np.all(away.min(axis=1) < 1e-9)
    assert len(set(away.argmin(axis=1))) == 3


def test_no_free_subharmonic():
    """With heavy damping there is no subharmonic, and the frequencies stay as given."""
    frequencies = np.linspace(1.6, 2.2, 3)
    data = subharmonic_suppression(
        Oscillator(1.0), DAMPER, frequencies, starts=4, settling=Settling()
    )
    assert_allclose(data.frequency, frequencies)
    assert np.isnan(data.free_subharmonic).all() and np.isnan(data.switched_share).all()
