"""Motions run until they settle, with their Lyapunov exponent while they do not.

When the states n and 2n periods apart approach each other so fast that the distance still
to go, by a geometric series, is small, Newton's method on the n-period map with its exact
derivative takes the state onto the orbit. The motion has settled if that orbit is close by
and stable. A slow passage near a fold, where the states hardly move, is therefore not taken
for an orbit.
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
from impact_damper.kernel.compiling import inlined, kernel, kernel_only
from impact_damper.kernel.single import assign, side_of
from impact_damper.motions.records import CHAOTIC, DIVERGED, NON_COLLIDING, SETTLED, UNRESOLVED
from impact_damper.motions.strobe_map import (
    POLISH_TOLERANCE,
    distance,
    polish,
    repeats_sooner,
    speed_weight,
    strobe_time,
)
from impact_damper.system.packed import CLEARANCE, FREQUENCY

LONGEST_PERIOD = 12
RING = 2 * LONGEST_PERIOD + 1
BLOCK = 10
RECENT = 5
CONFIDENCE = 4.0
WEAK = 0.05
NEAR = 1e-4
NEAREST = 1e-9
# What is kept of a motion on its way: which it is, strobes and periods without contact so far, how
# near an orbit it must come; and of its tangent, the growth over periods and batches of them.
SEEN = np.dtype(
    [
        ("index", "i8"),
        ("strobes", "i8"),
        ("quiet", "i8"),
        ("near", "f8"),
        ("periods", "i8"),
        ("batch", "f8"),
        ("mean", "f8"),
        ("squares", "f8"),
        ("recent", "f8", RECENT),
    ]
)


@kernel_only
def nearby_period(ring, k, weight, floor, tolerance):
    """Period of an orbit that the motion approaches and is within `tolerance` of, or 0.

    `ring[k % RING]` is the last of k + 1 states; `floor` is the rounding of the integration.
    """
    last = ring[k % RING]
    for n in range(1, LONGEST_PERIOD + 1):
        if k < 2 * n:
            return 0
        middle = ring[(k - n) % RING]
        now = distance(last, middle, weight)
        if now > tolerance:
            continue
        if now <= floor:
            return n
        ratio = now / distance(middle, ring[(k - 2 * n) % RING], weight)
        if ratio < 1.0 and now * ratio / (1.0 - ratio) <= tolerance:
            return n
    return 0


@inlined
def land(p, y, periods, near, out):
    """Take a motion onto the stable orbit that it is near; false if there is none.

    A motion that spirals in seems to repeat after several periods: its divisors are tried first.
    Within NEAREST a motion counts as the orbit even where Newton's method fails, for the map may
    not be smooth there; its residual and multiplier are then NaN.
    """
    multiplier = complex(np.nan, np.nan)
    for n in range(1, periods + 1):
        if periods % n == 0:
            found, residual, multiplier = polish(p, y, n, 100.0 * NEAR, POLISH_TOLERANCE)
            if found or (n == periods and near <= NEAREST):
                out.period, out.residual, out.multiplier = n, residual, multiplier
                break
    stable = out.period > 0 and not abs(multiplier) >= 1.0
    if not stable or repeats_sooner(p, y, np.int64(out.period), POLISH_TOLERANCE):
        out.period = 0
        return False
    out.outcome = SETTLED
    return True


@kernel_only
def follow_tangent(tangent, growth):
    """Renormalise a tangent after a period and add its growth to its batch of BLOCK periods.

    The mean and the sum of squares of finished batches are updated by Welford's recurrence.
    """
    size = 0.0
    for i in range(4):
        size += tangent[i] ** 2
    size = math.sqrt(size)
    for i in range(4):
        tangent[i] /= size
    growth.batch += math.log(size)
    growth.periods += 1
    if growth.periods % BLOCK == 0:
        count = growth.periods // BLOCK
        change = growth.batch - growth.mean
        growth.mean += change / count
        growth.squares += change * (growth.batch - growth.mean)
        growth.recent[count % RECENT] = growth.batch
        growth.batch = 0.0


@kernel
def exponent(growth):
    """Mean growth of a batch, its standard error, and whether the last batches grow as well."""
    count = growth.periods // BLOCK
    recent = 0.0
    for i in range(RECENT):
        recent += growth.recent[i] / RECENT
    error = math.sqrt(growth.squares / (count * (count - 1.0)))
    return growth.mean, error, recent > 0.5 * growth.mean


@inlined
def begin_watch(seen, index, out):
    """Begin to watch a motion: the record of what is seen, and the record to be filled."""
    seen.index, seen.strobes, seen.quiet, seen.near = index, 0, 0, NEAR
    seen.periods, seen.batch, seen.mean, seen.squares = 0, 0.0, 0.0, 0.0
    out.outcome, out.period = UNRESOLVED, 0
    out.residual, out.multiplier = np.nan, complex(np.nan, np.nan)
    out.lyapunov_exponent, out.lyapunov_error = np.nan, np.nan


@inlined
def watch(p, y, side, contacts, tangent, ring, seen, tolerance, patience, limit, out):
    """Look at a motion at a strobe; whether it needs to go on no further.

    After half the patience the largest Lyapunov exponent is followed as well, by one
    tangent, its error from batches of BLOCK periods. A motion that is chaotic beyond doubt
    (CONFIDENCE standard errors, its last batches included, since a transient may just have
    ended) is let go after `patience` periods, or at the limit if its exponent is WEAK: a slow
    spiral can look like weak chaos for a while. One in doubt is not let go. A loose mass that
    has not touched a wall for `patience` periods and drifts by less than 1 % of the clearance
    within the limit is taken as non-colliding, and so is a settled motion without contacts.

    To the record `out` go outcome, period, residual, dominant multiplier, periods_run, and the
    exponent per unit time; y is taken onto the orbit if there is one.
    """
    k = seen.strobes
    if k == limit:
        return True
    period = 2.0 * math.pi / p[FREQUENCY]
    for i in range(4):
        ring[k % RING, i] = y[i]
    out.periods_run = k
    if k > 0:
        seen.quiet = seen.quiet + 1 if contacts == 0 and side == 0 else 0
    if not abs(y[0]) + abs(y[1]) + abs(y[3]) < 1e6:
        out.outcome = DIVERGED
        return True
    n = nearby_period(ring, k, speed_weight(p, side), 20.0 * tolerance, seen.near)
    if n > 0:
        if land(p, y, n, seen.near, out):
            if seen.quiet >= out.period and p[CLEARANCE] < math.inf:
                out.outcome = NON_COLLIDING
            return True
        seen.near = max(0.1 * seen.near, NEAREST)
    drift = abs(y[3] - y[1]) * limit * period
    if seen.quiet >= patience and drift < 0.01 * p[CLEARANCE] < math.inf:
        out.outcome = NON_COLLIDING
        return True
    half = patience // 2
    if k == half:
        for i in range(4):
            tangent[i] = 0.5
    elif k > half:
        follow_tangent(tangent, seen)
    if (k - half) // BLOCK > RECENT and (k - half) % BLOCK == 0:
        mean, error, growing = exponent(seen)
        out.lyapunov_exponent = mean / (BLOCK * period)
        out.lyapunov_error = error / (BLOCK * period)
        last = k >= limit - BLOCK
        ripe = last or (k >= patience and out.lyapunov_exponent > WEAK)
        if ripe and growing and mean > CONFIDENCE * error:
            out.outcome = CHAOTIC
            return True
    seen.strobes += 1
    return False


@kernel
def settle_many(parameters, states, start, tolerance, patience, limit, out, stop):
    """Run motions until each has settled, is certainly chaotic, or `limit` periods are gone.

    Parameters
    ----------
    parameters : array, shape (m, packed.COUNT)
        Packed parameters.
    states : array, shape (m, 4)
    start : array, shape (m,)
        Times at which the states are given, at most the strobe's.
    tolerance, patience, limit
        Of `Settling`.
    out : array of recording.MOTION, shape (m,)
        Gets what `watch` finds, and the last state at a strobe or that on the orbit.
    stop : array of bool, shape (1,)
        Once it is true, perhaps set by another thread, the motions are given up.
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
    """Give a place of the pool to motion i, if there is one."""
    if i < len(out):
        p, y = parameters[i], states[i]
        begin_watch(seen[m], i, out[i])
        enter(pool, m, p, y, side_of(p, y), tolerance)
        send(pool, m, start[i], strobe_time(p), False)
