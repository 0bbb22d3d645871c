"""Kernels that run motions: until they settle, for their Lyapunov exponent, for their record.

Motions are looked at once a forcing period, at the phase W T = pi/2: well between the
contacts of a damper at its design point, which fall near 0 and pi. When the states n and 2n
periods apart approach each other so fast that the distance still to go, by a geometric
series, is small, Newton's method on the n-period map with its exact derivative takes the
state onto the orbit. The motion has settled if that orbit is close by and stable. A slow
passage near a fold, where the states hardly move, is therefore not taken for an orbit.
"""

import math

import numpy as np

from impact_damper.accelerate import kernel
from impact_damper.kernel import advance, polynomial, side_of, step, workspace
from impact_damper.series import CONTACT_ORDER, FLIGHT_ORDER

LONGEST_PERIOD = 12
RING = 2 * LONGEST_PERIOD + 1
BLOCK = 10
RECENT = 5
UNRESOLVED, SETTLED, CHAOTIC, DIVERGED, NON_COLLIDING = 0, 1, 2, 3, 4
SAMPLES = 64
CONFIDENCE = 4.0
WEAK = 0.05
NEAR = 1e-4
NEAREST = 1e-9
CONVERGED = 1e-9
POLISH_TOLERANCE = 1e-12

MOTION = np.dtype([
    ("outcome", "i1"),
    ("period", "i2"),
    ("periods_run", "i4"),
    ("multiplier", "c16"),
    ("residual", "f8"),
    ("lyapunov_exponent", "f8"),
    ("lyapunov_error", "f8"),
    ("state", "f8", 4),
    ("maximum_displacement", "f8"),
    ("contacts", "f8"),
    ("asymmetry", "f8"),
    ("harmonic_displacement", "c16"),
    ("harmonic_relative", "c16"),
])


@kernel
def strobe_time(p):
    """The time within a forcing period at which motions are looked at."""
    return 0.5 * math.pi / p[0]


@kernel
def one_period(p, y, tangents, side, tolerance, work):
    """Integrate from strobe to strobe; returns what `advance` returns."""
    t = strobe_time(p)
    return advance(p, y, tangents, side, t, t + 2.0 * math.pi / p[0], tolerance, work)


@kernel
def distance(a, b, weight):
    """Largest difference of two states, the loose mass's speed weighed by its weight."""
    d = max(abs(a[0] - b[0]), abs(a[1] - b[1]))
    return max(d, max(abs(a[2] - b[2]), weight * abs(a[3] - b[3])))


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


@kernel
def period_map(p, y, periods, tolerance):
    """State and derivative (4, 4) of the map over whole periods, and the contacts begun."""
    state = y.copy()
    tangents = np.eye(4)
    work = workspace()
    side = side_of(p, y)
    contacts = 0
    for _ in range(periods):
        side, begun, _ = one_period(p, state, tangents, side, tolerance, work)
        contacts += begun
    return state, tangents.T.copy(), contacts


@kernel
def dominant(values):
    """The value of largest modulus, of a conjugate pair the one with positive imaginary part."""
    largest = values[np.argmax(np.abs(values))]
    return complex(largest.real, abs(largest.imag))


@kernel
def polish(p, y, periods, reach, tolerance):
    """Newton's method for a fixed point of the map over `periods` from a state near it.

    Without contacts the loose mass keeps its place and only (Z1, Z1') is sought. Returns
    whether it converged to an orbit within `reach` of the start, the residual, and the
    dominant Floquet multiplier; y is replaced only if it converged.
    """
    orbit = y.copy()
    for _ in range(10):
        state, matrix, contacts = period_map(p, orbit, periods, tolerance)
        active = 4 if contacts > 0 or side_of(p, orbit) != 0 else 2
        matrix = matrix[:active, :active].copy()
        newton = matrix - np.eye(active)
        if abs(np.linalg.det(newton)) < 1e-12:
            break
        residual = (orbit - state)[:active]
        change = np.linalg.solve(newton, residual)
        if np.max(np.abs(change)) < CONVERGED:
            y[:] = orbit
            multiplier = dominant(np.linalg.eigvals(matrix.astype(np.complex128)))
            return True, np.max(np.abs(residual)), multiplier
        orbit[:active] += change
        if active == 2:
            orbit[2:] += change
        if not np.max(np.abs(orbit - y)[:2]) < reach:
            break
    return False, np.nan, complex(np.nan, np.nan)


@kernel
def follow(p, y, periods, index, target, resolution, tolerance):
    """Follow a stable orbit while parameter `index` moves to a target, as far as it goes.

    Steps are halved until the next one that fails is shorter than the resolution. Both p
    and y are left at the last orbit. Returns the dominant multiplier there.
    """
    before = y.copy()
    last_step = 0.0
    step_now = target - p[index]
    _, _, multiplier = polish(p, y, periods, 1e-3, tolerance)
    trial = p.copy()
    while p[index] != target:
        left = target - p[index]
        if abs(step_now) > abs(left):
            step_now = left
        guess = y.copy()
        if last_step != 0.0:
            guess += (y - before) * (step_now / last_step)
        trial[index] = target if step_now == left else p[index] + step_now
        found, _, next_multiplier = polish(trial, guess, periods, 0.1, tolerance)
        if found and abs(next_multiplier) < 1.0 and np.max(np.abs(guess - y)[:2]) < 0.2:
            before[:] = y
            y[:] = guess
            p[index] = trial[index]
            last_step = step_now
            multiplier = next_multiplier
            step_now *= 1.5
        else:
            step_now *= 0.5
            if abs(step_now) < resolution:
                break
    return multiplier


@kernel
def land(p, y, periods, near, out):
    """Take a motion onto the stable orbit that it is near; false if there is none.

    A motion that spirals in seems to repeat after several periods: its divisors are tried first.
    """
    multiplier = complex(np.nan, np.nan)
    for n in range(1, periods + 1):
        if periods % n == 0:
            found, residual, multiplier = polish(p, y, n, 100.0 * NEAR, POLISH_TOLERANCE)
            if found or (n == periods and near <= NEAREST):
                out.period, out.residual, out.multiplier = n, residual, multiplier
                break
    if out.period == 0 or abs(multiplier) >= 1.0:
        out.period = 0
        return False
    out.outcome = SETTLED
    return True


@kernel
def follow_tangent(tangents, rates, k):
    """Renormalise a tangent after its period k and add its growth to its batch of BLOCK periods."""
    size = math.sqrt(np.sum(tangents * tangents))
    tangents /= size
    rates[k // BLOCK] += math.log(size)


@kernel
def exponent(rates):
    """Mean growth of a batch, its standard error, and whether the last batches grow as well."""
    mean = np.mean(rates)
    error = math.sqrt(np.sum((rates - mean) ** 2) / (len(rates) * (len(rates) - 1.0)))
    return mean, error, np.mean(rates[-RECENT:]) > 0.5 * mean


@kernel
def settle(p, y, start, tolerance, patience, limit, out):
    """Run a motion until it has settled, is certainly chaotic, or `limit` periods are gone.

    The state y is given at the time `start`, at most the strobe's, and is replaced by the last
    one at a strobe, or by the orbit's.

    After half the patience the largest Lyapunov exponent is followed as well, by one
    tangent, its error from batches of BLOCK periods. A motion that is chaotic beyond doubt
    (CONFIDENCE standard errors, its last batches included, since a transient may just have
    ended) is let go after `patience` periods, or at the limit if its exponent is WEAK: a slow
    spiral can look like weak chaos for a while. One in doubt is not let go. A loose mass that
    has not touched a wall for `patience` periods is taken as non-colliding.

    To the record `out` go outcome, period, residual, dominant multiplier, periods_run, and the
    exponent per unit time.
    """
    period = 2.0 * math.pi / p[0]
    weight = 1.0 / math.sqrt(1.0 + p[4] * (1.0 + p[5]))
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
        n = nearby_period(ring, k, weight if side != 0 else 1.0, 20.0 * tolerance, near)
        if n > 0:
            if land(p, y, n, near, out):
                break
            near = max(0.1 * near, NEAREST)
        if quiet >= patience and p[3] < math.inf:
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


@kernel
def extremum(c, order, length, start):
    """Largest |polynomial| over [0, length], at least `start`: eight points, then Newton's."""
    best = start
    for i in range(9):
        t = length * i / 8.0
        value, slope = polynomial(c, order, t)
        if abs(value) > best - 0.1:
            for _ in range(6):
                bend = 0.0
                for k in range(order, 1, -1):
                    bend = bend * t + k * (k - 1) * c[k]
                if bend == 0.0:
                    break
                t = min(max(t - slope / bend, 0.0), length)
                value, slope = polynomial(c, order, t)
        best = max(best, abs(value))
    return best


@kernel
def series_of_step(work, side, y, t):
    """Displacement and relative displacement at time t into the step that started at y in `side`."""
    if side == 0:
        x, v = polynomial(work[0], FLIGHT_ORDER, t)
        return x, v, x + (y[2] - y[0]) + (y[3] - y[1]) * t, v + (y[3] - y[1])
    x, v = polynomial(work[0], CONTACT_ORDER, t)
    q, w = polynomial(work[1], CONTACT_ORDER, t)
    return x, v, q, w


@kernel
def measure(p, y, periods, tolerance, out):
    """Record of `periods` periods from a strobe on: extremum, contacts, symmetry, first harmonics.

    `maximum_displacement` is the extremum of |Z1|; `contacts` is per forcing period;
    `asymmetry` the distance of the state half the time later from the mirrored start, which
    vanishes for a symmetric motion of odd period; the harmonics are complex amplitudes c of
    Re(c exp(i W T)) in Z1 and Z2, by the trapezoidal rule.
    """
    work = workspace()
    none = np.empty((0, 4))
    period = 2.0 * math.pi / p[0]
    begin = strobe_time(p)
    end = begin + periods * period
    spacing = period / SAMPLES
    start = y.copy()
    state = y.copy()
    half = begin + 0.5 * periods * period if periods % 2 == 1 else math.inf
    side = side_of(p, y)
    largest, contacts, t, sample = abs(y[0]), 0, begin, 0
    first, second = 0.0j, 0.0j
    out.asymmetry = np.nan
    while t < end:
        stop = min(end, half) if t < half else end
        start[:] = state
        before = side
        length, side = step(p, state, none, side, t, stop - t, tolerance, work)
        order = FLIGHT_ORDER if before == 0 else CONTACT_ORDER
        largest = extremum(work[0], order, length, largest)
        contacts += before == 0 and side != 0
        while begin + sample * spacing < t + length and sample < periods * SAMPLES:
            x, _, z, _ = series_of_step(work, before, start, begin + sample * spacing - t)
            z += before * p[3] if before != 0 else 0.0
            angle = p[0] * (begin + sample * spacing)
            turn = complex(math.cos(angle), -math.sin(angle))
            first += x * turn
            second += z * turn
            sample += 1
        t = stop if length >= stop - t else t + length
        if t == half:
            weight = 1.0 / math.sqrt(1.0 + p[4] * (1.0 + p[5])) if side != 0 else 1.0
            out.asymmetry = distance(-state, y, weight)
    out.maximum_displacement = largest
    out.contacts = contacts / periods
    out.harmonic_displacement = first * (2.0 / sample)
    out.harmonic_relative = second * (2.0 / sample)


@kernel
def settle_and_measure(p, y, start, tolerance, patience, limit, watched, out):
    """`settle`, then `measure` over one period of the motion, or `watched` periods if unsettled."""
    settle(p, y, start, tolerance, patience, limit, out)
    out.state[:] = y
    if out.outcome != DIVERGED:
        measure(p, y, out.period if out.outcome == SETTLED else watched, tolerance, out)


@kernel
def settle_many(parameters, states, start, tolerance, patience, limit, watched, out):
    """`settle_and_measure` for rows of parameters (m, 7), states (m, 4) and starts (m,)."""
    for i in range(len(out)):
        y = states[i].copy()
        settle_and_measure(parameters[i], y, start[i], tolerance, patience, limit, watched, out[i])


@kernel
def trace(p, y, t, times, tolerance, states, log):
    """States (len(times), 4) at increasing times from t on, and a log of the contacts.

    A row of `log` is a contact: wall, beginning, end, and Z2' at both. The last state is left
    in y. Returns the number of contacts; those beyond the log's length are counted only.
    """
    work = workspace()
    none = np.empty((0, 4))
    start = y.copy()
    side = side_of(p, y)
    contacts = 0
    if side != 0:
        contacts = record_beginning(log, contacts, side, t, y[3])
    sample = 0
    while sample < len(times) and times[sample] <= t:
        states[sample] = y
        sample += 1
    while sample < len(times):
        start[:] = y
        before = side
        # the last sample is an end of a step, so that y is the state there
        left = times[-1] - t
        length, side = step(p, y, none, side, t, left, tolerance, work)
        while sample < len(times) and (times[sample] - t < length or length >= left):
            x, v, z, w = series_of_step(work, before, start, min(times[sample] - t, length))
            states[sample, 0], states[sample, 1] = x, v
            states[sample, 2], states[sample, 3] = z + (before * p[3] if before != 0 else 0.0), w
            sample += 1
        t += length
        if before == 0 and side != 0:
            contacts = record_beginning(log, contacts, side, t, y[3])
        elif before != 0 and side == 0 and contacts <= len(log):
            log[contacts - 1, 2], log[contacts - 1, 4] = t, y[3]
    return contacts


@kernel
def record_beginning(log, contacts, side, t, speed):
    """Open a row of the contact log; returns the number of contacts."""
    if contacts < len(log):
        log[contacts, 0], log[contacts, 1], log[contacts, 2] = side, t, np.nan
        log[contacts, 3], log[contacts, 4] = speed, np.nan
    return contacts + 1


def measured(p, y, periods, tolerance):
    """Record of `measure` alone, for a state on an orbit."""
    records = np.zeros(1, MOTION)
    measure(p, y, periods, tolerance, records[0])
    return records[0]


@kernel
def first_collisions(parameters, states, limit, tolerance, periods):
    """Forcing periods from T = 0 to the first contact of each motion, infinite if none by then."""
    none = np.empty((0, 4))
    work = workspace()
    for i in range(len(states)):
        p = parameters[i]
        y = states[i].copy()
        t = 0.0
        side = side_of(p, y)
        end = limit * 2.0 * math.pi / p[0]
        while side == 0 and t < end:
            length, side = step(p, y, none, side, t, end - t, tolerance, work)
            t += length
        periods[i] = t * p[0] / (2.0 * math.pi) if side != 0 else np.inf
