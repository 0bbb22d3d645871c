"""The search for events in a step, and that of the beginning of a contact in a flight.

The absence of an event is certified by bounds on how the gap bends over the step; a bound on its
second derivative marches to the first root without passing it. Where one event at most is
possible, steps of third order find it.

This file is a template, as `step` is, and is compiled in one module with it.
"""

import math

from impact_damper.kernel.compiling import kernel_only

LANES: int

ROUNDING = 2.0**-50
# A search ends with a move whose cube, beside that of the time in which the gap bends, is below
# this share of the tolerance: what is left out of the speed.
LAST_MOVE = 0.01
# Largest, for powers k of t in [0, 1], of (t - t^k) / k: 0.1283 for the third.
SAG = 0.13
MARCH, BRACKET, ENDING, MET, MISSED = 0.0, 1.0, 2.0, 3.0, 4.0
TINY = 1e-300
FAR = 1e200


@kernel_only
def safe_advance(gap, closing, bound):
    """Time within which a gap that closes at a given speed cannot vanish.

    First root of gap - closing t - bound t^2/2, with bound on the second derivative.
    """
    gap = max(gap, 0.0)
    root = math.sqrt(closing * closing + 2.0 * bound * gap)
    above = 2.0 * gap if closing > 0.0 else root - closing
    below = closing + root if closing > 0.0 else bound + TINY
    return above / below


@kernel_only
def march(t, f, closing, ahead, length, fine):
    """Next time and mode while a gap f, now f(t), is certainly positive for the time `ahead`."""
    met = closing and (f <= fine or t + ahead == t)
    ends = not t + ahead < length
    following = t if met else (length if ends else t + ahead)
    return following, MET if met else (ENDING if ends else MARCH)


@kernel_only
def bent(first, bend):
    """Step of third order, from one of second order and the relative bend of the gap."""
    return first * (1.0 - 0.5 * bend * first)


@kernel_only
def is_last(a, i, move, rate):
    """Whether what a move leaves out is far below the tolerance, of a gap that bends at a rate."""
    turn = max(rate, 2.0 / a[LENGTH + i]) * move
    return abs(turn * turn * turn) <= max(LAST_MOVE * a[TOLERANCE + i], ROUNDING)


@kernel_only
def close_in(a, i, t, f, first, bend, rate, fine):
    """Next move and mode between LOW and HIGH, where a gap is positive and where not; f at t is.

    There is one root between them; or at most one, if HIGH is FAR, before the end.
    """
    low = a[LOW + i] = t if f > 0.0 else a[LOW + i]
    high = a[HIGH + i] = a[HIGH + i] if f > 0.0 else t
    length = a[LENGTH + i]
    move = bent(first, bend)
    inside = low < t + move and t + move < high
    past = high == FAR and not t + move < length
    last = inside and not past and is_last(a, i, move, max(rate, abs(bend)))
    if abs(f) <= fine:
        return 0.0, MET
    if f > 0.0 and not t < length:
        return 0.0, MISSED
    inner = move if inside else 0.5 * (low + min(high, length)) - t
    step = length - t if past else inner
    # Nor is there more to be had where the move is rounding, or no number.
    moved = t + step > t or t + step < t
    return step, MET if last or not moved else BRACKET


@kernel_only
def end_at(a, i, row, end, move, going):
    """Value and slope after a last move, from those before it and the curve, if still going."""
    value, slope = a[row + i], a[row + LANES + i]
    curve, jerk = a[row + 2 * LANES + i], a[row + 3 * LANES + i]
    value += move * (slope + move * (0.5 * curve + move * (jerk / 6.0)))
    slope += move * (curve + move * (0.5 * jerk))
    a[end + i] = value if going else a[end + i]
    a[end + LANES + i] = slope if going else a[end + LANES + i]


@kernel_only
def go_on(a, i, mode, t, move):
    """Keep where a search in a lane has come to, after a last move; 1 if it has not ended."""
    going = a[MODE + i] <= ENDING
    a[T + i] = t
    a[MODE + i] = mode
    end_at(a, i, Z1, END_Z1, move, going)
    return 1 if mode <= ENDING else 0


@kernel_only
def loose_mass(a, i, t):
    """Z2 and its speed in flight, from Z1 and its slope at t."""
    drift = a[Y3 + i] - a[Y1 + i]
    return a[Z1 + i] + (a[Y2 + i] - a[Y0 + i]) + drift * t, a[Z1_SLOPE + i] + drift


@kernel_only
def first_guess(a, i):
    """When a wall would be met by the first terms of the gap's series."""
    gap = min(a[CLEARANCE + i], FAR) - a[WALL + i] * a[Y2 + i]
    speed = abs(a[Y3 + i])
    bend = a[WALL + i] * a[G + i]
    return 2.0 * gap / (speed + math.sqrt(max(speed * speed + 2.0 * bend * gap, 0.0)))


@kernel_only
def gap_ahead(a, i, t):
    """The gap to the WALL at t, a step of second order to where it closes, and its relative bend.

    From Z1, its slope and curve there.
    """
    z, w = loose_mass(a, i, t)
    closing = a[WALL + i] * w
    gap = min(a[CLEARANCE + i], FAR) - a[WALL + i] * z
    return gap, gap / closing, a[WALL + i] * a[Z1_CURVE + i] / closing


@kernel_only
def expect_contact(a):
    """Move T from LENGTH to where a contact may be expected before it.

    By the first terms of the series, and then by half of them: the others need not be waited for.
    """
    expected = 0
    for i in range(LANES):
        length = a[LENGTH + i]
        wall = a[WALL + i] = 1.0 if a[Y3 + i] > 0.0 else -1.0
        reached = wall * (a[Y2 + i] + length * (a[Y3 + i] + 0.5 * length * a[G + i]))
        a[MODE + i] = BRACKET if reached > a[CLEARANCE + i] else MISSED
        expected += 1 if reached > a[CLEARANCE + i] else 0
    if expected > 0:
        guess_contact(a)


@kernel_only
def guess_contact(a):
    """Move T to where trajectories whose MODE is BRACKET may meet a wall; others' to LENGTH."""
    for i in range(LANES):
        a[T + i] = min(first_guess(a, i), a[LENGTH + i])
    flight_early(a)
    for i in range(LANES):
        _, first, bend = gap_ahead(a, i, a[T + i])
        t = a[T + i] + bent(first, bend)
        inside = a[MODE + i] == BRACKET and 0.0 < t and t < a[LENGTH + i]
        a[T + i] = t if inside else a[LENGTH + i]


@kernel_only
def find_contact(a):
    """Move T to the first time in [0, T] at which |Z2| reaches the clearance from inside.

    Z1 and its slope are known at T. WALL becomes the wall and MODE becomes MET; or T stays and
    MODE becomes MISSED, when there is certainly none. END_Z1 and END_Z1_SLOPE remain those of Z1
    at T. Where T is before LENGTH a contact is expected at it, and may be a little later.

    The terms of Z1' but the first come to CHANGE at most. Each term of Z1 stays within SAG times
    its share of CHANGE T of its chord; so does Z2. From a wall behind, Z2 stays off where the
    mean of two bounds is positive: by the chord, and by what the first speed is changed to.
    Likewise the speed keeps its sign where the mean of its bounds from both ends does: then only
    one wall can be met, and once.
    """
    unsettled = 0
    expected = 0
    for i in range(LANES):
        t = a[T + i]
        clearance = min(a[CLEARANCE + i], FAR)
        speed = abs(a[Y3 + i])
        change = a[CHANGE + i]
        wall = 1.0 if a[Y3 + i] > 0.0 else -1.0
        z, final = loose_mass(a, i, t)
        ahead = clearance - wall * z
        behind = clearance + wall * z
        sag = SAG * change * t
        clear = min(clearance - wall * a[Y2 + i], ahead) > sag
        left = behind + speed * t > 0.5 * change * t
        certain = speed + wall * final > change
        awaited = certain and t < a[LENGTH + i]
        missed = not awaited and ((clear and left) or (certain and ahead > 0.0))
        a[WALL + i] = wall
        a[MODE + i] = MISSED if missed else (BRACKET if certain else MARCH)
        expected += 1 if awaited else 0
        unsettled += 0 if missed else 1
    if expected > 0:
        unsettled = meet_expected(a)
    if unsettled > 0:
        search_contact(a)


@kernel_only
def meet_expected(a):
    """`find_contact` where T is before LENGTH, at a wall neared all the time, nearly."""
    flight_curve(a)
    unsettled = 0
    for i in range(LANES):
        t = a[T + i]
        awaited = a[MODE + i] == BRACKET and t < a[LENGTH + i]
        gap, first, bend = gap_ahead(a, i, t)
        move = bent(first, bend)
        inside = 0.0 < t + move and t + move <= a[LENGTH + i]
        met = awaited and inside and is_last(a, i, move, abs(bend))
        otherwise = MISSED if awaited and gap > 0.0 else a[MODE + i]
        a[MODE + i] = MET if met else otherwise
        a[T + i] = t + move if met else t
        end_at(a, i, Z1, END_Z1, move, met)
        unsettled += 1 if a[MODE + i] < MET else 0
    return unsettled


@kernel_only
def search_contact(a):
    """`find_contact` for trajectories that meet a wall in the step, or may do so."""
    for i in range(LANES):
        a[LENGTH + i] = a[T + i]
        a[LOW + i] = 0.0
        a[HIGH + i] = FAR
    guess_contact(a)
    uncertain = 0
    for i in range(LANES):
        a[T + i] = 0.0 if a[MODE + i] == MARCH else a[T + i]
        uncertain += 1 if a[MODE + i] == MARCH else 0
    look_ahead(a)
    if uncertain > 0:
        flight_bound(a)
    running = 1
    while running > 0:
        flight_slope(a)
        flight_curve(a)
        running = 0
        for i in range(LANES):
            t = a[T + i]
            mode = a[MODE + i]
            bound = a[BOUND + i]
            clearance = min(a[CLEARANCE + i], FAR)
            fine = ROUNDING * clearance
            z, w = loose_mass(a, i, t)
            wall = a[WALL + i]
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
                t, mode = march(t, clearance - wall * z, wall * w > 0.0, ahead, a[LENGTH + i], fine)
            elif mode == BRACKET:
                gap, first, bend = gap_ahead(a, i, t)
                move, mode = close_in(a, i, t, gap, first, bend, 0.0, fine)
                t += move
            elif mode == ENDING:
                mode = MISSED
            a[WALL + i] = wall
            running += go_on(a, i, mode, t, move)
