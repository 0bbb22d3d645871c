"""The paper's method: Runge-Kutta-Merson with steps that adapt to a tolerance."""

import math

import numpy as np

from chatterjee1995.methods.equations import ahead, moved, rate, wall_at
from chatterjee1995.methods.integrators.fixed_steps import BEYOND, MERSON, FixedStep
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import side_of
from impact_damper.model.packed import CLEARANCE, FREQUENCY

STEP_OPERATIONS = 366  # floating-point operations of a step, with five evaluations of the rate
# A run fails if it diverges, or if it would exceed one of these limits.
SHORTEST = 1e-12  # shortest step
# Largest numbers of steps: in a call of `advance_merson`, in a forcing cycle, and in `flight`.
MOST_STEPS, MOST_ENDS, MOST_FLIGHT_ENDS = 10**6, 400_000, 10**5
FIRST = 1e-3  # length of the first step, divided by the forcing period or, in `flight`, by `end`


@kernel
def estimated_step(p, side, by_position, t, h, y, tolerance):
    """Return the state after a step, and its estimated error divided by the allowed error.

    The loose mass presses the wall `side`, or, if `by_position`, the wall beyond which Z2 lies.
    """
    k1 = rate(p, wall_at(p, y[2]) if by_position else side, t, y)
    m = moved(y, h / 3.0, k1)
    k2 = rate(p, wall_at(p, m[2]) if by_position else side, t + h / 3.0, m)
    m = moved(moved(y, h / 6.0, k1), h / 6.0, k2)
    k3 = rate(p, wall_at(p, m[2]) if by_position else side, t + h / 3.0, m)
    m = moved(moved(y, h / 8.0, k1), 0.375 * h, k3)
    k4 = rate(p, wall_at(p, m[2]) if by_position else side, t + 0.5 * h, m)
    m = moved(moved(moved(y, 0.5 * h, k1), -1.5 * h, k3), 2.0 * h, k4)
    k5 = rate(p, wall_at(p, m[2]) if by_position else side, t + h, m)
    after = moved(moved(moved(y, h / 6.0, k1), 2.0 * h / 3.0, k4), h / 6.0, k5)
    ratio = 0.0
    for i in range(4):
        error = h / 30.0 * abs(2.0 * k1[i] - 9.0 * k3[i] + 8.0 * k4[i] - k5[i])
        ratio = max(ratio, error / (tolerance * (1.0 + max(abs(y[i]), abs(after[i])))))
    return after, ratio


@kernel
def located(p, side, t, h, y, tolerance):
    """Shorten a step h to end at a wall. Return length, last state, and number of tries."""
    low, high = 0.5 * h, h
    state, _ = estimated_step(p, side, False, t, high, y, tolerance)
    beyond = ahead(p, side, state[2])
    state, _ = estimated_step(p, side, False, t, low, y, tolerance)
    before = ahead(p, side, state[2])
    tries = 2
    while before <= 0.0 and low > SHORTEST:
        high, beyond = low, before
        low *= 0.5
        state, _ = estimated_step(p, side, False, t, low, y, tolerance)
        before = ahead(p, side, state[2])
        tries += 1
    length = low
    for _ in range(60):
        if before <= 0.0 or high - low <= 1e-15 * (1.0 + t):
            break
        length = (low * beyond - high * before) / (beyond - before)
        state, _ = estimated_step(p, side, False, t, length, y, tolerance)
        tries += 1
        now = ahead(p, side, state[2])
        if abs(now) <= 1e-15 * p[CLEARANCE]:
            break
        if now > 0.0:
            low, before = length, now
            beyond *= 0.5
        else:
            high, beyond = length, now
            before *= 0.5
    return length, state, tries


@kernel
def advance_merson(p, y, side, t, end, h, tolerance, locate, ends):
    """Integrate y in place from t to `end`. Write time and state after each step to `ends`.

    The first step is h. Return four numbers: the wall in contact (unchanged if `locate` is false),
    the length of the next step, the number of accepted steps (-1 if the run failed), and the number
    of all steps tried.
    """
    state = (y[0], y[1], y[2], y[3])
    steps, tries = 0, 0
    while t < end:
        length = min(h, end - t)
        after, ratio = estimated_step(p, side, not locate, t, length, state, tolerance)
        tries += 1
        factor = 0.9 * (ratio + 1e-10) ** -0.2
        if not ratio <= 1.0:
            h = length * max(factor, 0.1) if ratio < math.inf else 0.1 * length
            if h < SHORTEST:
                return side, h, -1, tries
            continue
        # A step that is shortened to end at `end` must not reduce the length of the next step.
        h = max(h, length * min(factor, 5.0)) if length < h else length * min(factor, 5.0)
        if locate and ahead(p, side, after[2]) < 0.0:
            length, after, repeated = located(p, side, t, length, state, tolerance)
            tries += repeated
            on_wall = p[CLEARANCE] if after[2] > 0.0 else -p[CLEARANCE]
            after = (after[0], after[1], on_wall, after[3])
            side = (1 if after[2] > 0.0 else -1) if side == 0 else 0
        state = after
        t = end if length >= end - t else t + length
        if steps < len(ends):
            ends[steps, 0] = t
            ends[steps, 1], ends[steps, 2], ends[steps, 3], ends[steps, 4] = state
        steps += 1
        if steps > MOST_STEPS or not abs(state[0]) + abs(state[1]) + abs(state[3]) < BEYOND:
            return side, h, -1, tries
    y[0], y[1], y[2], y[3] = state
    return side, h, steps, tries


class Merson(FixedStep):
    """Runge-Kutta-Merson with step control, but with equal steps in `largest_displacements`."""

    fixed = False
    tolerances = "merson"

    def steps(self, p, start, begin, periods, tolerance, locate, most_evaluations=None):
        times, states, status, work = [np.array([begin])], [start[None]], "ended", 0
        ends, period = np.empty((MOST_ENDS, 5)), 2 * math.pi / p[FREQUENCY]
        y, side, h = start.copy(), side_of(p, start), FIRST * period
        # Each cycle begins at the time `begin` again, so rounding errors of time do not grow.
        for k in range(periods):
            side, h, steps, tries = advance_merson(
                p, y, side, begin, begin + period, h, tolerance, locate, ends
            )
            work += tries * STEP_OPERATIONS
            if not 0 <= steps <= MOST_ENDS:
                status = "failed"
                break
            times.append(ends[:steps, 0] + k * period)
            states.append(ends[:steps, 1:].copy())
        return status, work, np.concatenate(times), np.concatenate(states)

    def flight(self, p, state, end, resolution, time):
        ends, y = np.empty((MOST_FLIGHT_ENDS, 5)), state.copy()
        _, _, steps, _ = advance_merson(p, y, 0, 0.0, end, FIRST * end, resolution, False, ends)
        if not 0 <= steps <= MOST_FLIGHT_ENDS:
            return None
        return self.seen(p, np.concatenate([[[0.0, *state]], ends[:steps]]), time)


STAGES = ("accuracy", "missed_contacts", "stable_steps")
INTEGRATORS = (Merson(MERSON, "merson", "Merson", 3, STAGES, math.sqrt(12.0)),)
