"""Runge-Kutta-Merson with step control, the method of the paper, with or without locating contacts.

For linear equations Merson's estimate of the error equals the leading term of the error. Step
control keeps the estimate below the tolerance times 1 + |y| in each component y. Contacts are
located as in common codes. In flight the distance to the wall is checked at the end of each step,
in contact the penetration. If this number is negative, the step is shortened until the number is
zero at its end.

Z1 is the displacement of the primary mass and Z2 its displacement relative to the loose mass.
"""

import math

import numpy as np

from chatterjee1995.methods.equations import largest_within, moved, rate, wall_at
from chatterjee1995.methods.fixed_step import BEYOND, FixedStep
from chatterjee1995.methods.operations import operations
from chatterjee1995.methods.runs import read_off, stopped
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import side_of
from impact_damper.model.packed import CLEARANCE, FREQUENCY

# A run fails if a step would have to be shorter than SHORTEST, or if one call of `advance_merson`
# takes more than MOST_STEPS steps.
SHORTEST = 1e-12
MOST_STEPS = 10**6
# A run whose steps do not fit into memory fails. Largest number of steps whose ends are stored, in
# a forcing cycle and in a flight.
MOST_ENDS, MOST_FLIGHT_ENDS = 400_000, 10**5
# Length of the first step, in forcing cycles.
FIRST = 1e-3
# Forcing cycles in one call of a compiled function. Ctrl-C takes effect only after a call.
PERIODS_AT_ONCE = 10


@kernel
def estimated_step(p, side, by_position, t, h, y, tolerance):
    """Return the state after one step, and the ratio of its estimated error to the allowed error.

    The step goes from the state y at the time t to t + h. `side` is the wall in contact (-1, 1, or
    0 for none). With `by_position` the argument `side` is ignored, and each evaluation of the time
    derivative determines the wall in contact from Z2.
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
def ahead(p, side, y):
    """Return the distance to the nearest wall in flight, or the penetration in contact.

    Both decrease through zero, the distance when a contact begins, the penetration when it ends.
    """
    if side == 0:
        return p[CLEARANCE] - abs(y[2])
    return side * y[2] - p[CLEARANCE]


@kernel
def located(p, side, t, h, y, tolerance):
    """Return the length of the step that ends at an event, the state there, and the steps tried.

    The event is the beginning or end of a contact within the step from t to t + h. The step is
    halved until it ends before the event. Then the Illinois variant of regula falsi finds the
    length with which it ends at the event.
    """
    low, high = 0.5 * h, h
    state, _ = estimated_step(p, side, False, t, high, y, tolerance)
    beyond = ahead(p, side, state)
    state, _ = estimated_step(p, side, False, t, low, y, tolerance)
    before = ahead(p, side, state)
    tries = 2
    while before <= 0.0 and low > SHORTEST:
        high, beyond = low, before
        low *= 0.5
        state, _ = estimated_step(p, side, False, t, low, y, tolerance)
        before = ahead(p, side, state)
        tries += 1
    length = low
    for _ in range(60):
        if before <= 0.0 or high - low <= 1e-15 * (1.0 + t):
            break
        length = (low * beyond - high * before) / (beyond - before)
        state, _ = estimated_step(p, side, False, t, length, y, tolerance)
        tries += 1
        now = ahead(p, side, state)
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
    """Integrate from t to end.

    Parameters
    ----------
    p, y : array
        Packed parameters, and the state at t, which is replaced by the state at `end`.
    side : int
        Wall in contact at t: -1 or 1, or 0 for none. Unused without `locate`.
    t, end, h, tolerance : float
        Times of beginning and end, length of the first step, and tolerance.
    locate : bool
        Whether contacts are located.
    ends : array, shape (m, 5)
        Receives time and state at the ends of the first m steps; m may be 0.

    Returns
    -------
    side : int
        Wall in contact at the end.
    h : float
        Length for the next step.
    steps : int
        Number of accepted steps. It is -1 if the tolerance could not be met, if more than
        MOST_STEPS steps were needed, or if the run diverged.
    contacts : int
        Number of contacts begun. Without `locate`, a contact that begins and ends within one step
        is not counted.
    largest : float
        Largest |Z1|.
    tries : int
        Number of computed steps, including rejected steps and trials of `located`. Each takes five
        evaluations of the time derivative.
    """
    state = (y[0], y[1], y[2], y[3])
    steps, contacts, largest, tries = 0, 0, 0.0, 0
    while t < end:
        length = min(h, end - t)
        after, ratio = estimated_step(p, side, not locate, t, length, state, tolerance)
        tries += 1
        factor = 0.9 * (ratio + 1e-10) ** -0.2
        if not ratio <= 1.0:
            h = length * max(factor, 0.1) if ratio < math.inf else 0.1 * length
            if h < SHORTEST:
                return side, h, -1, contacts, math.nan, tries
            continue
        # A step that is shortened to end at `end` must not reduce the length of the next step.
        h = max(h, length * min(factor, 5.0)) if length < h else length * min(factor, 5.0)
        if locate and ahead(p, side, after) < 0.0:
            length, after, repeated = located(p, side, t, length, state, tolerance)
            tries += repeated
            on_wall = p[CLEARANCE] if after[2] > 0.0 else -p[CLEARANCE]
            after = (after[0], after[1], on_wall, after[3])
            if side == 0:
                side = 1 if after[2] > 0.0 else -1
                contacts += 1
            else:
                side = 0
        elif not locate and wall_at(p, state[2]) == 0 and wall_at(p, after[2]) != 0:
            contacts += 1
        largest = max(largest, largest_within(state[0], state[1], after[0], after[1], length))
        state = after
        t = end if length >= end - t else t + length
        if steps < len(ends):
            ends[steps, 0] = t
            ends[steps, 1], ends[steps, 2], ends[steps, 3], ends[steps, 4] = state
        steps += 1
        if steps > MOST_STEPS or not abs(state[0]) + abs(state[1]) + abs(state[3]) < BEYOND:
            return side, h, -1, contacts, math.nan, tries
    y[0], y[1], y[2], y[3] = state
    return side, h, steps, contacts, largest, tries


@kernel
def run_merson(p, start, side, h, t, tolerance, locate, strobes, largest):
    """Run over forcing cycles, and return the completed cycles, the wall and the next step.

    `side` is the wall in contact at the beginning, and h the length of the first step. The second
    and third result are `side` and h at the end. `tolerance` and `locate` are those of
    `advance_merson`, the other arguments those of `fixed_step.run_fixed`.
    """
    y = start.copy()
    none = np.empty((0, 5))
    period = 2.0 * math.pi / p[FREQUENCY]
    strobes[:] = np.nan
    largest[:] = np.nan
    for k in range(len(strobes)):
        # Each cycle is integrated from the same time t, because the forcing is periodic. With a
        # growing time its rounding errors would grow too.
        side, h, steps, _, most, _ = advance_merson(
            p, y, side, t, t + period, h, tolerance, locate, none
        )
        if steps < 0:
            return k, side, h
        # The assignment of a whole row would take 2 s longer to compile.
        for i in range(4):
            strobes[k, i] = y[i]
        largest[k] = most
    return len(strobes), side, h


class Merson(FixedStep):
    """Runge-Kutta-Merson with step control; inherited methods of `FixedStep` use equal steps."""

    def __init__(self):
        super().__init__("merson")

    def run(self, p, start, begin, periods, tolerance, locate, most_evaluations=None):
        """Return the `runs.Run`.

        Its counted work, the number of floating-point operations, includes rejected steps and steps
        to locate contacts.
        """
        y, period = start.copy(), 2 * math.pi / p[FREQUENCY]
        side, h, tries = side_of(p, y), FIRST * period, 0
        times, states = [np.array([begin])], [start[None]]
        ends = np.empty((MOST_ENDS, 5))
        each = operations(estimated_step)
        for k in range(periods):
            side, h, steps, _, _, more = advance_merson(
                p, y, side, begin, begin + period, h, tolerance, locate, ends
            )
            tries += more
            if not 0 <= steps <= MOST_ENDS:
                return stopped("failed", tries * each)
            times.append(ends[:steps, 0] + k * period)
            states.append(ends[:steps, 1:].copy())
        return read_off(p, tries * each, np.concatenate(times), np.concatenate(states))

    def strobes(self, p, start, begin, periods, resolution, locate):
        strobes, largest = np.full((periods, 4), np.nan), np.empty(periods)
        side, h = wall_at(p, start[2]), FIRST * (2 * math.pi / p[FREQUENCY])
        for first in range(0, periods, PERIODS_AT_ONCE):
            part = slice(first, first + PERIODS_AT_ONCE)
            done, side, h = run_merson(
                p, start, side, h, begin, resolution, locate, strobes[part], largest[part]
            )
            if done < len(strobes[part]):
                break
            start = strobes[part][-1]
        return strobes

    def flight(self, p, state, end, resolution, time):
        ends = np.empty((MOST_FLIGHT_ENDS, 5))
        _, _, steps, _, _, _ = advance_merson(
            p, state.copy(), 0, 0.0, end, FIRST * end, resolution, False, ends
        )
        if not 0 <= steps <= MOST_FLIGHT_ENDS:
            return None
        return self._seen(p, np.concatenate([[[0.0, *state]], ends[:steps]]), time)
