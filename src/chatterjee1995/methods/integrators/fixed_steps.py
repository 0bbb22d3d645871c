"""Methods with equal steps, which locate no contacts: Runge-Kutta 4, velocity Verlet, Merson."""

import math

import numpy as np

from chatterjee1995.methods.equations import largest_within, moved, rate_by_position
from chatterjee1995.methods.integrator import Integrator
from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.equation import external_force
from impact_damper.model.packed import FREQUENCY

VERLET, RUNGE_KUTTA_4, MERSON = NUMBERS = range(3)
BEYOND = 1e3  # a run has diverged if |Z1| + |Z1'| + |Z2'| (in `flight`: a component) reaches this


@kernel
def forcing(p, t, h):
    """Return the external force at the times t, t + h/3, t + h/2 and t + h."""
    return (
        external_force(p, t),
        external_force(p, t + h / 3.0),
        external_force(p, t + 0.5 * h),
        external_force(p, t + h),
    )


@kernel_only
def verlet_step(p, drives, h, y):
    """Return the state after a step h of the velocity Verlet method, which has order 2."""
    k1 = rate_by_position(p, drives[0], y)
    x = y[0] + h * (y[1] + 0.5 * h * k1[1])
    z = y[2] + h * (y[3] + 0.5 * h * k1[3])
    k2 = rate_by_position(p, drives[3], (x, y[1] + h * k1[1], z, y[3] + h * k1[3]))
    return x, y[1] + 0.5 * h * (k1[1] + k2[1]), z, y[3] + 0.5 * h * (k1[3] + k2[3])


@kernel_only
def runge_kutta_4_step(p, drives, h, y):
    """Return the state after a step h of the classical Runge-Kutta method of order 4."""
    k1 = rate_by_position(p, drives[0], y)
    k2 = rate_by_position(p, drives[2], moved(y, 0.5 * h, k1))
    k3 = rate_by_position(p, drives[2], moved(y, 0.5 * h, k2))
    k4 = rate_by_position(p, drives[3], moved(y, h, k3))
    y = moved(moved(y, h / 6.0, k1), h / 3.0, k2)
    return moved(moved(y, h / 3.0, k3), h / 6.0, k4)


@kernel_only
def merson_step(p, drives, h, y):
    """Return the state after a step h of the Runge-Kutta-Merson method, which has order 4."""
    k1 = rate_by_position(p, drives[0], y)
    k2 = rate_by_position(p, drives[1], moved(y, h / 3.0, k1))
    k3 = rate_by_position(p, drives[1], moved(moved(y, h / 6.0, k1), h / 6.0, k2))
    k4 = rate_by_position(p, drives[2], moved(moved(y, h / 8.0, k1), 0.375 * h, k3))
    k5 = moved(moved(y, 0.5 * h, k1), -1.5 * h, k3)
    k5 = rate_by_position(p, drives[3], moved(k5, 2.0 * h, k4))
    return moved(moved(moved(y, h / 6.0, k1), 2.0 * h / 3.0, k4), h / 6.0, k5)


@kernel
def one_step(method, p, drives, h, y):
    """Return the state after a step h. `method` is one of NUMBERS, `drives` is from `forcing`."""
    if method == VERLET:
        return verlet_step(p, drives, h, y)
    if method == RUNGE_KUTTA_4:
        return runge_kutta_4_step(p, drives, h, y)
    return merson_step(p, drives, h, y)


@kernel
def run_fixed(method, p, start, t, steps, largest):
    """Take `steps` steps in each cycle. Write max |Z1| per cycle (NaN: diverged) to `largest`."""
    h = 2.0 * math.pi / p[FREQUENCY] / steps
    y = (start[0], start[1], start[2], start[3])
    largest[:] = np.nan
    drives = np.empty((steps, 4))
    for i in range(steps):
        drives[i, 0], drives[i, 1], drives[i, 2], drives[i, 3] = forcing(p, t + i * h, h)
    for k in range(len(largest)):
        most = 0.0
        for i in range(steps):
            before = y
            now = drives[i, 0], drives[i, 1], drives[i, 2], drives[i, 3]
            y = one_step(method, p, now, h, before)
            most = max(most, largest_within(before[0], before[1], y[0], y[1], h))
        if not abs(y[0]) + abs(y[1]) + abs(y[3]) < BEYOND:
            return
        largest[k] = most


@kernel
def fixed_ends(method, p, start, t, step, ends):
    """Make equal steps from `start` at t. Write time and state after each to a row of `ends`."""
    y = (start[0], start[1], start[2], start[3])
    for i in range(len(ends)):
        y = one_step(method, p, forcing(p, t + i * step, step), step, y)
        ends[i, 0] = t + (i + 1) * step
        ends[i, 1], ends[i, 2], ends[i, 3], ends[i, 4] = y


class FixedStep(Integrator):
    """A method with equal steps. Its `number`, one of NUMBERS, selects it in `one_step`."""

    fixed = True

    def __init__(self, number, name, title, place, compared, stability_limit):
        assert number in NUMBERS, f"number = {number}: must be one of {[*NUMBERS]}, for `one_step`"
        self.number, self.name, self.title, self.place = number, name, title, place
        self.compared, self.stability_limit = compared, stability_limit

    def largest_displacements(self, p, start, begin, periods, steps):
        largest = np.empty(periods)
        run_fixed(self.number, p, start, begin, steps, largest)
        return largest

    def flight(self, p, state, end, resolution, time):
        ends = np.empty((resolution, 5))
        fixed_ends(self.number, p, state, 0.0, end / resolution, ends)
        if not np.abs(ends[:, 1:]).max() < BEYOND:
            return None
        return self.seen(p, np.concatenate([[[0.0, *state]], ends]), time)

    def seen(self, p, ends, time):
        """Return |Z2| in each row of `ends` (a time and a state), and |Z2| at `time`."""
        last = ends[ends[:, 0] <= time][-1]
        there = np.empty((1, 5))
        fixed_ends(self.number, p, last[1:].copy(), last[0], time - last[0], there)
        return np.abs(ends[:, 3]), abs(there[0, 3])


BOTH = "stable_steps", "missed_contacts"
INTEGRATORS = (
    FixedStep(VERLET, "verlet", "velocity Verlet", 1, BOTH[:1], 2.0),
    FixedStep(RUNGE_KUTTA_4, "runge_kutta_4", "Runge-Kutta 4", 2, BOTH, math.sqrt(8.0)),
)
