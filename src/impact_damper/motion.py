"""Motions run until they settle, with their Lyapunov exponent while they do not.

When the states n and 2n periods apart approach each other so fast that the distance still
to go, by a geometric series, is small, Newton's method on the n-period map with its exact
derivative takes the state onto the orbit. The motion has settled if that orbit is close by
and stable. A slow passage near a fold, where the states hardly move, is therefore not taken
for an orbit.
"""

import math

import numpy as np

from impact_damper.accelerate import inlined, kernel
from impact_damper.kernel import advance, side_of, workspace
from impact_damper.orbits import (
    POLISH_TOLERANCE,
    distance,
    one_period,
    polish,
    repeats_sooner,
    speed_weight,
    strobe_time,
)
from impact_damper.recording import measure

LONGEST_PERIOD = 12
RING = 2 * LONGEST_PERIOD + 1
BLOCK = 10
RECENT = 5
UNRESOLVED, SETTLED, CHAOTIC, DIVERGED, NON_COLLIDING = 0, 1, 2, 3, 4
CONFIDENCE = 4.0
WEAK = 0.05
NEAR = 1e-4
NEAREST = 1e-9


@kernel
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
    if not stable or repeats_sooner(p, y, out.period, POLISH_TOLERANCE):
        out.period = 0
        return False
    out.outcome = SETTLED
    return True


@kernel
def follow_tangent(tangents, rates, k):
    """Renormalise a tangent after its period k and add its growth to its batch of BLOCK periods."""
    size = 0.0
    for i in range(4):
        size += tangents[0, i] ** 2
    size = math.sqrt(size)
    for i in range(4):
        tangents[0, i] /= size
    rates[k // BLOCK] += math.log(size)


@kernel
def exponent(rates):
    """Mean growth of a batch, its standard error, and whether the last batches grow as well."""
    count = len(rates)
    mean, recent, squares = 0.0, 0.0, 0.0
    for i in range(count):
        mean += rates[i] / count
        recent += rates[i] / RECENT if i >= count - RECENT else 0.0
    for i in range(count):
        squares += (rates[i] - mean) ** 2
    return mean, math.sqrt(squares / (count * (count - 1.0))), recent > 0.5 * mean


@inlined
def settle(p, y, start, tolerance, patience, limit, out):
    """Run a motion until it has settled, is certainly chaotic, or `limit` periods are gone.

    The state y is given at the time `start`, at most the strobe's, and is replaced by the last
    one at a strobe, or by the orbit's.

    After half the patience the largest Lyapunov exponent is followed as well, by one
    tangent, its error from batches of BLOCK periods. A motion that is chaotic beyond doubt
    (CONFIDENCE standard errors, its last batches included, since a transient may just have
    ended) is let go after `patience` periods, or at the limit if its exponent is WEAK: a slow
    spiral can look like weak chaos for a while. One in doubt is not let go. A loose mass that
    has not touched a wall for `patience` periods and drifts by less than 1 % of the clearance
    within the limit is taken as non-colliding, and so is a settled motion without contacts.

    To the record `out` go outcome, period, residual, dominant multiplier, periods_run, and the
    exponent per unit time.
    """
    period = 2.0 * math.pi / p[0]
    work = workspace()
    ring = np.empty((RING, 4))
    tangents = np.empty((0, 4))
    half = patience // 2
    rates = np.zeros((limit - half) // BLOCK + 1)
    near = NEAR
    quiet = 0
    out.outcome, out.period = UNRESOLVED, 0
    out.residual, out.multiplier = np.nan, complex(np.nan, np.nan)
    out.lyapunov_exponent, out.lyapunov_error = np.nan, np.nan
    side, _, _ = advance(p, y, tangents, side_of(p, y), start, strobe_time(p), tolerance, work)
    for k in range(limit):
        ring[k % RING] = y
        out.periods_run = k
        if not abs(y[0]) + abs(y[1]) + abs(y[3]) < 1e6:
            out.outcome = DIVERGED
            break
        n = nearby_period(ring, k, speed_weight(p, side), 20.0 * tolerance, near)
        if n > 0:
            if land(p, y, n, near, out):
                if quiet >= out.period and p[3] < math.inf:
                    out.outcome = NON_COLLIDING
                break
            near = max(0.1 * near, NEAREST)
        drift = abs(y[3] - y[1]) * limit * period
        if quiet >= patience and drift < 0.01 * p[3] < math.inf:
            out.outcome = NON_COLLIDING
            break
        if k == half:
            tangents = np.full((1, 4), 0.5)
        elif k > half:
            follow_tangent(tangents, rates, k - half - 1)
        batches = (k - half) // BLOCK
        if batches > RECENT and (k - half) % BLOCK == 0:
            mean, error, growing = exponent(rates[:batches])
            out.lyapunov_exponent = mean / (BLOCK * period)
            out.lyapunov_error = error / (BLOCK * period)
            last = k >= limit - BLOCK
            ripe = last or (k >= patience and out.lyapunov_exponent > WEAK)
            if ripe and growing and mean > CONFIDENCE * error:
                out.outcome = CHAOTIC
                break
        side, contacts, _ = one_period(p, y, tangents, side, tolerance, work)
        quiet = quiet + 1 if contacts == 0 and side == 0 else 0


@inlined
def settle_and_measure(p, y, start, tolerance, patience, limit, watched, out):
    """`settle`, then `measure` over one period of the motion, or `watched` periods if unsettled."""
    settle(p, y, start, tolerance, patience, limit, out)
    out.state[:] = y
    if out.outcome != DIVERGED:
        measure(p, y, out.period if out.period > 0 else watched, tolerance, out)


@kernel
def settle_many(parameters, states, start, tolerance, patience, limit, watched, out):
    """`settle_and_measure` for rows of parameters (m, 7), states (m, 4) and starts (m,)."""
    for i in range(len(out)):
        y = states[i].copy()
        settle_and_measure(parameters[i], y, start[i], tolerance, patience, limit, watched, out[i])
