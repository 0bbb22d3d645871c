"""The search for events in a step: the beginning of a contact in flight, its end in contact.

The absence of an event is certified by a bound on the second derivative of the gap over the
step; the same bound marches to the first root without passing it. Where one event at most is
possible, steps of third order find it.

This file is a template, as `step` is, and is compiled in one module with it.
"""

import math

import numpy as np

from impact_damper.accelerate import kernel

LANES: int

ROUNDING = 2.0**-50
# Longest steps in contact, while it deepens and on the way back, in natural periods of it, and
# the share of its natural frequency by which its phase may turn faster, so that a step turns
# the phase by less than three quarters of a turn, and half a turn: past one release at most.
DEEPER, BACK, TURNING = 0.55, 0.4, 0.25
# A search ends with a move whose square, beside that of the time in which the gap bends, is below
# this share of the tolerance: what is left out of the speed.
LAST_MOVE = 0.01
MARCH, BRACKET, ENDING, MET, MISSED = 0.0, 1.0, 2.0, 3.0, 4.0
TINY = 1e-300
FAR = 1e200


@kernel
def fast_exp2(y):
    """Power of 2, to 0.3 %."""
    whole = np.floor(y)
    part = y - whole
    power = number(np.int64((whole + 1023.0) * 2.0**52))
    return power * (1.0 + part * (0.6565 + 0.3435 * part))


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
def swing(move, natural):
    """Arctangent of natural * move, over `natural`, nearly."""
    u = (natural * move) ** 2
    return move * (15.0 + 4.0 * u) / (15.0 + 9.0 * u)


@kernel
def close_in(t, f, slope, curve, natural, low, high, length, fine, tolerance):
    """Next move and mode between `low` and `high`, where a gap is positive and where not.

    There is one root between them; or at most one, if `high` is FAR, before the end.

    A step of third order, of the arctangent of the gap where that swings at a natural
    frequency. It is the last where what it leaves out is far below the tolerance.
    """
    bend = (curve + natural * natural * f) / slope
    move = -f / slope
    move = swing(move, natural) * (1.0 - 0.5 * bend * move)
    inside = low < t + move and t + move < high
    rate = max(max(natural, 2.0 / length), abs(bend))
    last = inside and (rate * move) ** 2 <= max(LAST_MOVE * tolerance, ROUNDING)
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
def go_on(a, i, mode, t, move, low, high):
    """Keep where a search in a lane has come to, after a last move; 1 if it has not ended."""
    going = a[MODE + i] <= ENDING
    a[LOW + i] = low
    a[HIGH + i] = high
    a[T + i] = t
    a[MODE + i] = mode
    value = a[VALUE + i] + move * (a[SLOPE + i] + 0.5 * move * a[CURVE + i])
    a[END_VALUE + i] = value if going else a[END_VALUE + i]
    a[END_SLOPE + i] = a[SLOPE + i] + move * a[CURVE + i] if going else a[END_SLOPE + i]
    return 1 if mode <= ENDING else 0


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
        bend = a[WALL + i] * a[G + i]
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
                move, mode = close_in(
                    t, f, -wall * w, curve, 0.0, low, high, length, fine, a[TOLERANCE + i]
                )
                t += move
            elif mode == ENDING:
                mode = MISSED
            a[WALL + i] = wall
            running += go_on(a, i, mode, t, move, low, high)


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
        w = wall * a[W + i]
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
        # From the wall half a period of the contact, and what the mean of g adds to it, with Z1'
        # as the contact changes it; back to the wall, as without g.
        half = math.pi / math.sqrt(max(natural * natural - 0.25 * loss * loss, TINY))
        mean = wall * (a[G + i] + 0.5 * half * a[G + LANES + i]) + a[DAMPING + i] * w / mobility
        left = fast_exp2(-0.5 * loss * half / math.log(2.0))
        begun = half + (1.0 + left) * mean / (left * w * natural * natural + TINY)
        guess = begun if q == 0.0 else swing(-q / w, natural)
        a[T + i] = (guess if 0.0 < guess < length else length) if certain else 0.0
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
            if mode == MARCH:
                ahead = safe_advance(f, -slope, bound)
                t, mode = march(t, f, slope <= 0.0, ahead, length, fine)
            elif mode == BRACKET:
                low = t if f > 0.0 else low
                high = high if f > 0.0 else t
                move, mode = close_in(
                    t, f, slope, curve, a[NATURAL + i], low, high, length, fine, a[TOLERANCE + i]
                )
                t += move
            elif mode == ENDING:
                mode = MISSED
            running += go_on(a, i, mode, t, move, low, high)
