"""Run many motions side by side until they settle.

`watch` judges each motion at every strobe, the time of the phase W T = pi/2 in a forcing cycle.

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass, W the
forcing frequency, and T the time.
"""

import math

import numpy as np

from impact_damper.kernel.batch import (
    LANES,
    RESIDENT,
    SIDE,
    STATE,
    advance_some,
    enter,
    make_pool,
    send,
)
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import assign, side_of
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.motions.watch import RING, SEEN, begin_watch, watch


@kernel
def settle_many(parameters, states, start, tolerance, patience, limit, out, stop):
    """Run each motion until it has settled or is certainly chaotic, for at most `limit` cycles.

    Parameters
    ----------
    parameters : array, shape (m, packed.COUNT)
        Packed parameters.
    states : array, shape (m, 4)
        First states Z1, Z1', Z2, Z2'.
    start : array, shape (m,)
        Times of the first states, not after the first strobe.
    tolerance, patience, limit
        The attributes of `system.settling.Settling`.
    out : array of records.MOTION, shape (m,)
        Filled by `watch`. The field `state` receives the last state at a strobe or, for a settled
        motion, the state on the orbit.
    stop : array of bool, shape (1,)
        Another thread may set this flag to end the run. The records are then incomplete.
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
def take(pool, m, i, parameters, states, start, tolerance, seen, out):
    """Enter motion i, if it exists, at index m of the pool of motions that are stepped together."""
    if i < len(out):
        p, y = parameters[i], states[i]
        begin_watch(seen[m], i, out[i])
        enter(pool, m, p, y, side_of(p, y), tolerance)
        send(pool, m, start[i], strobe_time(p), False)
