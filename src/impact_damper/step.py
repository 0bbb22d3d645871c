"""One certified Taylor step of the event-driven flow, for one trajectory or several in lockstep.

A step takes trajectories that are all in flight, or all in contact, to the next event or to
the end of the step, whichever is first for each. Events are the beginning and the end of
contacts. The absence of an event is certified by a bound on the second derivative of the gap
over the step; the same bound marches to the first root without passing it.

This file is a template: `widths.instance` compiles it for each number of lanes and each pair of
orders that is wanted, after the constants and the functions that `series` writes for them. All
numbers stand in flat arrays, `a` for trajectories and `d` for tangents; names in capitals are
the beginnings of their rows. Trajectories do not touch each other: what one comes to does not
depend on its neighbours.
"""

import math

import numpy as np

from impact_damper.accelerate import kernel

LANES: int
TANGENTS: int
FLIGHT_ORDER: int
CONTACT_ORDER: int
SIZE: int
TANGENT_SIZE: int

ROUNDING = 2.0**-50
# Longest steps in contact, while it deepens and on the way back, in natural periods of it, and
# the share of its natural frequency by which its phase may turn faster, so that a step turns
# the phase by less than three quarters of a turn, and half a turn: past one release at most.
DEEPER, BACK, TURNING = 0.55, 0.4, 0.25
MARCH, BRACKET, ENDING, MET, MISSED = 0.0, 1.0, 2.0, 3.0, 4.0
TINY = 1e-300
ONE = 1023 << 52
FAR = 1e200
# Local errors pass through contacts, which amplify them; this share of the tolerance
# keeps the error of settled motions within 10 times of it.
SAFETY = 0.05
# A quarter turn in two parts, the first short enough for exact multiples of it.
QUARTER = 1.5707963267341256
QUARTER_REST = 6.077100506506192e-11
# Series of cosine and sine, without their first terms.
COSINES = tuple((-1.0) ** k / math.factorial(2 * k) for k in range(1, 9))
SINES = tuple((-1.0) ** k / math.factorial(2 * k + 1) for k in range(1, 9))


@kernel
def bits(x):
    """The bits of a number: if positive, about 2^52 times its logarithm to base 2, plus ONE."""
    return np.float64(x).view(np.int64)


@kernel
def number(x):
    """The number of some bits."""
    return np.int64(x).view(np.float64)


@kernel
def fast_exp2(y):
    """Power of 2, to 0.3 %."""
    whole = np.floor(y)
    part = y - whole
    power = number(np.int64((whole + 1023.0) * 2.0**52))
    return power * (1.0 + part * (0.6565 + 0.3435 * part))


@kernel
def paired(c, u):
    """Polynomial of eight terms, added up pair by pair."""
    v = u * u
    low = (c[0] + c[1] * u) + (c[2] + c[3] * u) * v
    high = (c[4] + c[5] * u) + (c[6] + c[7] * u) * v
    return low + high * (v * v)


@kernel
def forcing(a):
    """COSINE and SINE of the forcing phase, by their series within an eighth of a turn."""
    for i in range(LANES):
        angle = a[FREQUENCY + i] * a[TIME + i]
        turns = np.floor(angle * (2.0 / math.pi) + 0.5)
        t = (angle - turns * QUARTER) - turns * QUARTER_REST
        u = t * t
        c = paired(COSINES, u)
        s = paired(SINES, u)
        c = 1.0 + u * c
        s = t + t * u * s
        half = 0.5 * turns
        odd = half != np.floor(half)
        half = 0.5 * np.floor(half)
        sign = 1.0 if half == np.floor(half) else -1.0
        a[COSINE + i] = sign * (-s if odd else c)
        a[SINE + i] = sign * (c if odd else s)


@kernel
def limit_length(a, series, order):
    """Shorten LENGTH so that the last two terms of a series stay below the tolerance.

    Those of the slope do as well. Roots are taken by division of the bits, within a few per cent.
    """
    for i in range(LANES):
        allowed = bits(SAFETY * a[TOLERANCE + i] * a[SCALE + i])
        last = allowed - bits(order * abs(a[series + order * LANES + i]))
        before = allowed - bits((order - 1.0) * abs(a[series + (order - 1) * LANES + i]))
        last = (last >> 28) * ((1 << 28) // (order - 1))
        before = (before >> 28) * ((1 << 28) // (order - 2))
        a[LENGTH + i] = min(a[LENGTH + i], number(ONE + min(last, before)))


@kernel
def safe_advance(gap, closing, bound):
    """Time within which a gap that closes at a given speed cannot vanish.

    First root of gap - closing t - bound t^2/2, with bound on the second derivative.
    """
    gap = max(gap, 0.0)
    root = math.sqrt(closing * closing + 2.0 * bound * gap)
    above = 2.0 * gap if closing > 0.0 else root - closing
    below = closing + root if closing > 0.0 else bound + TINY
    return above / below


@kernel
def march(t, f, closing, ahead, length, fine):
    """Next time and mode while a gap f, now f(t), is certainly positive for the time `ahead`."""
    met = closing and (f <= fine or t + ahead == t)
    ends = not t + ahead < length
    following = t if met else (length if ends else t + ahead)
    return following, MET if met else (ENDING if ends else MARCH)


@kernel
def close_in(t, f, slope, curve, natural, low, high, length, fine):
    """Next move and mode between `low` and `high`, where a gap is positive and where not.

    There is one root between them; or at most one, if `high` is FAR, before the end.

    A step of third order, of the arctangent of the gap where that swings at a natural
    frequency. It is the last where what it leaves out is rounding.
    """
    move = -f / slope
    u = (natural * move) ** 2
    bend = (curve + natural * natural * f) / slope
    move *= (15.0 + 4.0 * u) / (15.0 + 9.0 * u) * (1.0 - 0.5 * bend * move)
    inside = low < t + move and t + move < high
    rate = max(max(natural, 2.0 / length), abs(bend))
    last = inside and (rate * move) ** 2 <= 4.0 * ROUNDING
    if abs(f) <= fine:
        return 0.0, MET
    if f > 0.0 and not t < length:
        return 0.0, MISSED
    past = high == FAR and not t + move < length
    inner = move if inside else 0.5 * (low + min(high, length)) - t
    step = length - t if past else inner
    # Nor is there more to be had where the move is rounding, or no number.
    moved = t + step > t or t + step < t
    return step, MET if last or not moved else BRACKET


@kernel
def find_contact(a):
    """Move T to the first time in [0, LENGTH] at which |Z2| reaches the clearance from inside.

    WALL becomes the wall and MODE becomes MET; or T the LENGTH and MODE MISSED, when there is
    certainly none. END_VALUE and END_SLOPE are of Z1 at T. Where the speed of Z2 certainly keeps
    its sign, only one wall can be met, and once.
    """
    for i in range(LANES):
        a[T + i] = a[LENGTH + i]
    flight_slope_x(a)
    unsettled = 0
    for i in range(LANES):
        length = a[LENGTH + i]
        clearance = min(a[CLEARANCE + i], FAR)
        speed = abs(a[Y3 + i])
        change = a[BOUND + i] * length
        wall = 1.0 if a[Y3 + i] > 0.0 else -1.0
        z = a[VALUE + i] + (a[Y2 + i] - a[Y0 + i]) + (a[Y3 + i] - a[Y1 + i]) * length
        clear = clearance - abs(a[Y2 + i]) > (speed + 0.5 * change) * length
        certain = clear or speed > change
        missed = clear or (certain and clearance - wall * z > 0.0)
        a[WALL + i] = wall
        a[MODE + i] = MISSED if missed else (BRACKET if certain else MARCH)
        a[END_VALUE + i] = a[VALUE + i]
        a[END_SLOPE + i] = a[SLOPE + i]
        unsettled += 0 if missed else 1
    if unsettled > 0:
        search_contact(a)


@kernel
def search_contact(a):
    """`find_contact` for trajectories that meet a wall in the step, or may do so."""
    for i in range(LANES):
        # Where the gap would close by the first terms of its series.
        gap = min(a[CLEARANCE + i], FAR) - a[WALL + i] * a[Y2 + i]
        speed = abs(a[Y3 + i])
        bend = 2.0 * a[WALL + i] * a[X + 2 * LANES + i]
        guess = 2.0 * gap / (speed + math.sqrt(max(speed * speed + 2.0 * bend * gap, 0.0)))
        length = a[LENGTH + i]
        a[LOW + i] = 0.0
        a[HIGH + i] = FAR
        if a[MODE + i] != MISSED:
            a[T + i] = guess if a[MODE + i] == BRACKET and guess < length else 0.0
    running = 1
    while running > 0:
        flight_curve_x(a)
        running = 0
        for i in range(LANES):
            t = a[T + i]
            mode = a[MODE + i]
            bound = a[BOUND + i]
            clearance = min(a[CLEARANCE + i], FAR)
            fine = ROUNDING * clearance
            drift = a[Y3 + i] - a[Y1 + i]
            z = a[VALUE + i] + (a[Y2 + i] - a[Y0 + i]) + drift * t
            w = a[SLOPE + i] + drift
            wall = a[WALL + i]
            low = a[LOW + i]
            high = a[HIGH + i]
            length = a[LENGTH + i]
            move = 0.0
            going = mode <= ENDING
            if mode == MARCH:
                upper = safe_advance(clearance - z, w, bound)
                lower = safe_advance(clearance + z, -w, bound)
                wall = 1.0 if upper < lower else -1.0
                # From a wall that recedes, a penetration within so short a time is below rounding.
                shortest = math.sqrt(8.0 * fine / (bound + TINY))
                receding = max(shortest, ROUNDING * t) if wall * w <= 0.0 else 0.0
                ahead = max(min(upper, lower), receding)
                # At rest on a wall the acceleration decides, a little later.
                t, mode = march(t, clearance - wall * z, wall * w > 0.0, ahead, length, fine)
            elif mode == BRACKET:
                f = clearance - wall * z
                low = t if f > 0.0 else low
                high = high if f > 0.0 else t
                curve = -wall * a[CURVE + i]
                move, mode = close_in(t, f, -wall * w, curve, 0.0, low, high, length, fine)
                t += move
            elif mode == ENDING:
                mode = MISSED
            a[WALL + i] = wall
            a[LOW + i] = low
            a[HIGH + i] = high
            a[T + i] = t
            a[MODE + i] = mode
            value = a[VALUE + i] + move * (a[SLOPE + i] + 0.5 * move * a[CURVE + i])
            a[END_VALUE + i] = value if going else a[END_VALUE + i]
            a[END_SLOPE + i] = a[SLOPE + i] + move * a[CURVE + i] if going else a[END_SLOPE + i]
            running += 1 if mode <= ENDING else 0


@kernel
def find_release(a):
    """Move T to the first time in [0, LENGTH] at which the penetration returns to zero.

    MODE becomes MET; or T the LENGTH and MODE MISSED, when there is certainly none. END_VALUE
    and END_SLOPE are of the penetration at T. With g the part of its acceleration that does
    not come from the wall, |g| <= G = BOUND,

        q'' = g - w^2 q - D q',

    so that R = (q'^2 + w^2 q^2)^(1/2) grows at most, and falls at most but for the dashpot, at
    the rate G: a bound on q''. The phase of (w q, q') turns at the rate w, but for G/R + D/2 at
    most. Where that is little, q has one root at most before the phase has turned once.
    """
    for i in range(LANES):
        wall = a[SIDE + i]
        q = wall * a[Q + i]
        w = wall * a[Q + LANES + i]
        length = a[LENGTH + i]
        mobility = 1.0 + a[INVERSE_MASS + i]
        natural = math.sqrt(a[CONTACT + i] * mobility)
        loss = a[DASHPOT + i] * mobility
        rest = a[BOUND + i]
        speed = math.sqrt(w * w + natural * natural * q * q)
        least = 0.99 * fast_exp2(-loss * length / math.log(2.0)) * speed - rest * length
        certain = least > 0.0 and rest + 0.5 * loss * least < TURNING * natural * least
        a[NATURAL + i] = natural
        a[BOUND + i] = rest + (natural + loss) * (speed + rest * length)
        a[FINE + i] = ROUNDING * (abs(q) + abs(w) * length)
        a[LOW + i] = 0.0
        a[HIGH + i] = FAR
        a[MODE + i] = BRACKET if certain else MARCH
        half = math.pi / math.sqrt(max(natural * natural - 0.25 * loss * loss, TINY))
        a[T + i] = (half if half < length and q == 0.0 else length) if certain else 0.0
    running = 1
    while running > 0:
        contact_curve_q(a)
        running = 0
        for i in range(LANES):
            t = a[T + i]
            mode = a[MODE + i]
            f = a[SIDE + i] * a[VALUE + i]
            slope = a[SIDE + i] * a[SLOPE + i]
            curve = a[SIDE + i] * a[CURVE + i]
            bound = a[BOUND + i]
            fine = a[FINE + i]
            low = a[LOW + i]
            high = a[HIGH + i]
            length = a[LENGTH + i]
            move = 0.0
            going = mode <= ENDING
            if mode == MARCH:
                ahead = safe_advance(f, -slope, bound)
                t, mode = march(t, f, slope <= 0.0, ahead, length, fine)
            elif mode == BRACKET:
                low = t if f > 0.0 else low
                high = high if f > 0.0 else t
                move, mode = close_in(t, f, slope, curve, a[NATURAL + i], low, high, length, fine)
                t += move
            elif mode == ENDING:
                mode = MISSED
            a[LOW + i] = low
            a[HIGH + i] = high
            a[T + i] = t
            a[MODE + i] = mode
            value = a[VALUE + i] + move * (a[SLOPE + i] + 0.5 * move * a[CURVE + i])
            a[END_VALUE + i] = value if going else a[END_VALUE + i]
            a[END_SLOPE + i] = a[SLOPE + i] + move * a[CURVE + i] if going else a[END_SLOPE + i]
            running += 1 if mode <= ENDING else 0


@kernel
def flight_step(a):
    """Step of trajectories in flight; SIDE becomes the wall on which a contact begins, or 0."""
    forcing(a)
    flight_series(a)
    for i in range(LANES):
        a[LENGTH + i] = a[LONGEST + i]
        a[SCALE + i] = max(1.0, max(abs(a[Y0 + i]), abs(a[Y1 + i])))
    limit_length(a, X, FLIGHT_ORDER)
    walls = 0
    for i in range(LANES):
        a[BOUND + i] = 0.0
        walls += 1 if a[CLEARANCE + i] < math.inf else 0
    if walls > 0:
        flight_bound(a)
    find_contact(a)
    for i in range(LANES):
        t = a[T + i]
        met = a[MODE + i] == MET
        offset = a[Y2 + i] - a[Y0 + i]
        drift = a[Y3 + i] - a[Y1 + i]
        free = a[END_VALUE + i] + offset + drift * t
        a[Y0 + i] = a[END_VALUE + i]
        a[Y1 + i] = a[END_SLOPE + i]
        a[Y2 + i] = a[WALL + i] * a[CLEARANCE + i] if met else free
        a[Y3 + i] = a[END_SLOPE + i] + drift
        a[SIDE + i] = a[WALL + i] if met else 0.0
        a[LENGTH + i] = t


@kernel
def flight_tangents(a, d):
    """Carry tangents through the flight that `flight_step` has just made."""
    flight_tangent_series(a, d)
    for i in range(TANGENTS):
        d[2 * TANGENTS + i] -= d[i]
        d[3 * TANGENTS + i] -= d[TANGENTS + i]
    flight_tangent_value(a, d)
    for i in range(TANGENTS):
        d[2 * TANGENTS + i] += d[i] + d[3 * TANGENTS + i] * a[LENGTH + i % LANES]
        d[3 * TANGENTS + i] += d[TANGENTS + i]
    dashpot_jump(a, d, -1.0)


@kernel
def contact_tangents(a, d):
    """Carry tangents through the contact that `contact_step` has just made."""
    contact_tangent_series(a, d)
    contact_tangent_value(a, d)
    dashpot_jump(a, d, 1.0)


@kernel
def dashpot_jump(a, d, direction):
    """Jump of tangents where the dashpot's force has set in (-1) or ended (+1).

    Saltation across Z2 = +-d0: only the force is discontinuous, so the jump is linear in
    the relative displacement, does not depend on the speed, and has determinant 1.
    """
    for i in range(TANGENTS):
        j = i % LANES
        begun = a[SIDE + j] != 0.0
        crossed = begun if direction < 0.0 else not begun
        jump = direction * a[DASHPOT + j] * d[2 * TANGENTS + i] if crossed else 0.0
        d[TANGENTS + i] += jump
        d[3 * TANGENTS + i] += jump * (1.0 + a[INVERSE_MASS + j])


@kernel
def contact_step(a):
    """Step of trajectories in contact, whose SIDE becomes 0 where it ends."""
    forcing(a)
    contact_series(a)
    for i in range(LANES):
        natural = math.sqrt(a[CONTACT + i] * (1.0 + a[INVERSE_MASS + i]))
        deeper = a[SIDE + i] * a[Y3 + i] >= 0.0
        a[LENGTH + i] = min(a[LONGEST + i], (DEEPER if deeper else BACK) * 2.0 * math.pi / natural)
        scale = max(1.0, max(abs(a[Y0 + i]), abs(a[Y1 + i])))
        a[SCALE + i] = max(scale, abs(a[Y3 + i]))
    limit_length(a, X, CONTACT_ORDER)
    limit_length(a, Q, CONTACT_ORDER)
    contact_bound(a)
    find_release(a)
    contact_slope_x(a)
    for i in range(LANES):
        released = a[MODE + i] == MET
        wall = a[SIDE + i] * a[CLEARANCE + i]
        a[Y0 + i] = a[VALUE + i]
        a[Y1 + i] = a[SLOPE + i]
        a[Y2 + i] = wall if released else wall + a[END_VALUE + i]
        a[Y3 + i] = a[END_SLOPE + i]
        a[SIDE + i] = 0.0 if released else a[SIDE + i]
        a[LENGTH + i] = a[T + i]
