"""Label states of the free oscillator by the motion that they lead to.

A motion is run from strobe to strobe (times with the forcing phase W T = pi/2) until it lies in a
proven neighbourhood of an attracting orbit (`attraction.attractors`).

Z1 is the displacement of the primary mass, W the forcing frequency, and T the time.
"""

import math

import numpy as np

from impact_damper.kernel.batch import LANES, RESIDENT, STATE, advance_some, enter, make_pool, send
from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.equation import has_escaped
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions import ensemble
from impact_damper.motions.strobe_map import strobe_time

# The same values as in `data.variables.BASIN_LABEL`. Files with kernels must not import the
# room `data.variables`.
ESCAPED, UNRESOLVED = -2, -1
# Number of states that a thread labels in one call of the kernel, in a fraction of a second.
CHUNK = 4096


@kernel
def label_many(p, states, begin, tolerance, limit, owner, centre, shape, labels, periods, stop):
    """Label states by the orbit whose neighbourhood their motions enter at a strobe.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters without a damper.
    states : array, shape (n, 2)
        Z1 and Z1' at the time `begin`.
    begin : float
        Time T, at most a forcing cycle before the first strobe.
    tolerance : float
        Largest local error of a step.
    limit : int
        Number of forcing cycles after which a motion counts as unresolved.
    owner, centre, shape : array
        The attributes of `Attractors`.
    labels : array of int, shape (n,)
        Receives the index of the orbit, or UNRESOLVED or ESCAPED.
    periods : array of int, shape (n,)
        Receives the number of strobes that were passed until the label was known.
    stop : array of bool, shape (1,)
        Another thread may set this flag to end the run early. The labels are then incomplete.
    """
    size = min(len(states), RESIDENT)
    pool = make_pool(size)
    chosen, arrived = np.empty(LANES, np.int64), np.empty(LANES, np.int64)
    taken, strobes = np.zeros(size, np.int64), np.zeros(size, np.int64)
    y = np.empty(4)
    first, period = strobe_time(p), 2.0 * math.pi / p[FREQUENCY]
    following, left = size, len(states)
    for m in range(size):
        take(pool, m, m, p, states, begin, first, tolerance, y, taken, strobes)
    while left > 0 and not stop[0]:
        for j in range(advance_some(pool, chosen, arrived)):
            m = arrived[j]
            i = taken[m]
            x, v = pool.numbers[m, STATE], pool.numbers[m, STATE + 1]
            label = which(x, v, owner, centre, shape)
            if has_escaped(p, x, v):
                label = ESCAPED
            if label != UNRESOLVED or strobes[m] == limit:
                labels[i], periods[i] = label, strobes[m]
                left -= 1
                take(pool, m, following, p, states, begin, first, tolerance, y, taken, strobes)
                following += 1
            else:
                strobes[m] += 1
                send(pool, m, first, first + period, False)


@kernel_only
def take(pool, m, i, p, states, begin, first, tolerance, y, taken, strobes):
    """Enter state i, if it exists, at index m of the pool of motions that are stepped together."""
    if i < len(states):
        taken[m], strobes[m] = i, 0
        y[0], y[1], y[2], y[3] = states[i, 0], states[i, 1], states[i, 0], states[i, 1]
        enter(pool, m, p, y, 0, tolerance)
        send(pool, m, begin, first, False)


@kernel_only
def which(x, v, owner, centre, shape):
    """Return the orbit in whose neighbourhood a state at a strobe lies, or UNRESOLVED."""
    for k in range(len(owner)):
        dx, dv = x - centre[k, 0], v - centre[k, 1]
        first = shape[k, 0, 0] * dx + shape[k, 0, 1] * dv
        second = shape[k, 1, 0] * dx + shape[k, 1, 1] * dv
        if first * first + second * second < 1.0:
            return owner[k]
    return UNRESOLVED


def label_states(p, states, phase, attractors, tolerance, limit, workers=1, progress=None):
    """Return the label of each state, and the number of cycles until the label was known.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters without a damper.
    states : array, shape (n, 2)
        Z1 and Z1' at the phase.
    phase : float
        Phase W T of the forcing, radian.
    attractors : Attractors
    tolerance : float
        Largest local error of a step.
    limit : int
        Number of forcing cycles after which a motion counts as unresolved.
    workers, progress
        As in `ensemble.settle`.

    Returns
    -------
    labels : numpy.ndarray of int, shape (n,)
        Index in `attractors.records`, or ESCAPED or UNRESOLVED.
    periods : numpy.ndarray of int, shape (n,)
        Number of strobes passed until the label was known.
    """
    states = np.ascontiguousarray(states, float)
    strobe = 0.5 * math.pi
    begin = (strobe - (strobe - phase) % (2 * math.pi)) / p[FREQUENCY]
    labels, periods = np.full(len(states), UNRESOLVED), np.zeros(len(states), np.int64)
    stop = np.zeros(1, bool)

    def work(part):
        label_many(
            p,
            states[part],
            begin,
            tolerance,
            limit,
            attractors.owner,
            attractors.centre,
            attractors.shape,
            labels[part],
            periods[part],
            stop,
        )

    # This call compiles the kernel in the main thread, where Ctrl-C can interrupt the compilation.
    work(slice(0, 0))
    ensemble.run_chunks(work, len(states), workers, progress, stop, size=CHUNK)
    return labels, periods
