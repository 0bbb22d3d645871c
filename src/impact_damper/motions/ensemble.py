"""Run many motions on several threads, until the outcome of each motion is known."""

import math

import numpy as np

from impact_damper.kernel.batch import (
    LANES,
    RESIDENT,
    SIDE,
    STATE,
    advance,
    advance_some,
    enter,
    make_pool,
    send,
)
from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.equation import has_escaped
from impact_damper.kernel.single import assign, side_of
from impact_damper.model.packed import FREQUENCY
from impact_damper.model.settling import Settling
from impact_damper.motions.steady import run_chunks, settle_with
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.motions.watch import RING, SEEN, begin_watch, watch

# `label_states` runs this number of motions in one call of a kernel. Ctrl-C waits for the call.
LABELLED = 4096
# Labels of states. GONE: the motion escapes. UNKNOWN: the motion leads to no known orbit.
GONE, UNKNOWN = -2, -1


def settle(
    parameters,
    states,
    settling=None,
    *,
    start=0.0,
    from_strobe=False,
    workers=1,
    progress=None,
    stop=None,
):
    """Run m motions until their outcomes are known; return an array of m records (`MOTION`).

    Motion i has the packed parameters parameters[i] and starts in states[i]. If `from_strobe`, all
    motions start at the first strobe, W T = pi/2. Otherwise they start at the time T = `start`, at
    most a cycle before the first strobe. Another thread can stop all runs by setting `stop[0]`.
    """
    parameters = np.ascontiguousarray(parameters, float)
    strobes = 0.5 * np.pi / parameters[:, FREQUENCY]
    begins = strobes if from_strobe else np.full(len(states), start)
    running = {"workers": workers, "progress": progress, "stop": stop}
    return settle_with(SIDE_BY_SIDE, parameters, states, begins, settling or Settling(), **running)


@kernel
def settle_many(parameters, states, start, tolerance, patience, limit, out, stop):
    """Run motion i from states[i] at the time start[i], for all i; write records into `out`.

    A run ends as described in `watch`, at the latest after `limit` cycles. Another thread can stop
    all runs by setting `stop[0]`.
    """
    size = min(len(out), RESIDENT)
    pool = make_pool(size)
    seen = np.zeros(size, SEEN)
    rings = np.empty((size, RING, 4))
    chosen, arrived = np.empty(LANES, np.int64), np.empty(LANES, np.int64)
    y = np.empty(4)
    following, left = size, len(out)
    for m in range(size):
        take(pool, m, m, parameters, states, start, tolerance, seen, out)
    while left > 0 and not stop[0]:
        for j in range(advance_some(pool, chosen, arrived)):
            m = arrived[j]
            i = seen[m].index
            p, strobe = parameters[i], strobe_time(parameters[i])
            side = np.int64(pool.numbers[m, SIDE])
            contacts, tangent = pool.contacts[m], pool.tangents[m]
            for k in range(4):
                y[k] = pool.numbers[m, STATE + k]
            if watch(
                p, y, side, contacts, tangent, rings[m], seen[m], tolerance, patience, limit, out[i]
            ):
                left -= 1
                assign(out[i].state, y)
                take(pool, m, following, parameters, states, start, tolerance, seen, out)
                following += 1
            else:
                with_tangent = seen[m].strobes > patience // 2
                send(pool, m, strobe, strobe + 2.0 * math.pi / p[FREQUENCY], with_tangent)


@kernel
def follow_many(parameters, states, cycles, tolerance, contacts, largest):
    """Run motions from the strobe for `cycles` forcing cycles. The last states replace `states`.

    `contacts` (m,) receives the number of contacts that begin in each motion. `largest` (m,)
    receives the largest |Z1| of each motion, or infinity after an escape.
    """
    sides = np.empty(len(states), np.int64)
    begins, ends = np.empty((2, len(states)))
    for i in range(len(states)):
        p = parameters[i]
        sides[i], begins[i] = side_of(p, states[i]), strobe_time(p)
        ends[i] = begins[i] + cycles * 2.0 * math.pi / p[FREQUENCY]
    advance(parameters, states, sides, begins, ends, tolerance, contacts, largest)


SIDE_BY_SIDE = settle_many, follow_many


@kernel
def take(pool, m, i, parameters, states, start, tolerance, seen, out):
    """Put motion i, if it exists, at index m of the pool of running motions."""
    if i < len(out):
        p, y = parameters[i], states[i]
        begin_watch(seen[m], i, out[i])
        enter(pool, m, p, y, side_of(p, y), tolerance)
        send(pool, m, start[i], strobe_time(p), False)


@kernel_only
def take_state(pool, m, i, p, states, begin, first, tolerance, y, taken, strobes):
    """Put the motion from states[i], if any, at index m of the pool; `first`: first strobe time."""
    if i < len(states):
        taken[m], strobes[m] = i, 0
        y[0], y[1], y[2], y[3] = states[i, 0], states[i, 1], states[i, 0], states[i, 1]
        enter(pool, m, p, y, 0, tolerance)
        send(pool, m, begin, first, False)


def label_states(p, states, phase, attractors, tolerance, limit, workers=1, progress=None):
    """Return labels of states of the free oscillator, and the cycles until each label is known.

    `states` (n, 2) are Z1 and Z1' at the forcing phase `phase`. The label of a state is the index
    in `attractors.records` of the orbit to which the state leads. The label is GONE if the motion
    escapes, and UNKNOWN if it enters no neighbourhood of an orbit within `limit` cycles.
    """
    states = np.ascontiguousarray(states, float)
    strobe = 0.5 * math.pi
    begin = (strobe - (strobe - phase) % (2 * math.pi)) / p[FREQUENCY]
    labels, periods = np.full(len(states), UNKNOWN), np.zeros(len(states), np.int64)
    stop = np.zeros(1, bool)

    def work(part):
        here = states[part], labels[part], periods[part]
        label_many(p, begin, tolerance, limit, attractors[1:], *here, stop)

    # This call compiles the kernel in the main thread, where Ctrl-C can interrupt the compilation.
    work(slice(0, 0))
    run_chunks(work, len(states), workers, progress, stop, size=LABELLED)
    return labels, periods


@kernel
def label_many(p, begin, tolerance, limit, neighbourhoods, states, labels, periods, stop):
    """Run free motions until their labels are known; fill `labels` and `periods` (cycles run)."""
    owner, centre, shape = neighbourhoods
    size = min(len(states), RESIDENT)
    pool = make_pool(size)
    chosen, arrived = np.empty(LANES, np.int64), np.empty(LANES, np.int64)
    taken, strobes = np.zeros(size, np.int64), np.zeros(size, np.int64)
    y = np.empty(4)
    first, period = strobe_time(p), 2.0 * math.pi / p[FREQUENCY]
    following, left = size, len(states)
    for m in range(size):
        take_state(pool, m, m, p, states, begin, first, tolerance, y, taken, strobes)
    while left > 0 and not stop[0]:
        for j in range(advance_some(pool, chosen, arrived)):
            m = arrived[j]
            i = taken[m]
            x, v = pool.numbers[m, STATE], pool.numbers[m, STATE + 1]
            label = which(x, v, owner, centre, shape)
            if has_escaped(p, x, v):
                label = GONE
            if label != UNKNOWN or strobes[m] == limit:
                labels[i], periods[i] = label, strobes[m]
                left -= 1
                new = following
                take_state(pool, m, new, p, states, begin, first, tolerance, y, taken, strobes)
                following += 1
            else:
                strobes[m] += 1
                send(pool, m, first, first + period, False)


@kernel_only
def which(x, v, owner, centre, shape):
    """Return the index of the orbit in whose neighbourhood the state (x, v) lies, or UNKNOWN."""
    for k in range(len(owner)):
        dx, dv = x - centre[k, 0], v - centre[k, 1]
        first = shape[k, 0, 0] * dx + shape[k, 0, 1] * dv
        second = shape[k, 1, 0] * dx + shape[k, 1, 1] * dv
        if first * first + second * second < 1.0:
            return owner[k]
    return UNKNOWN
