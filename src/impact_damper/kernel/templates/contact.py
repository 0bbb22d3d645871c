"""Root search for events within a step, and the search for the first contact of a flight.

An event is a root of the *gap*: the distance to a wall in flight, the penetration in contact. Each
search is in one of five modes, which it keeps in the row MODE.

    MARCH     several roots are possible. A bound on the second derivative of the gap gives a time
              within which the gap cannot vanish; the search advances by such times, so that it
              never passes the first root
    BRACKET   at most one root is possible. A safeguarded iteration of third order finds it
    ENDING    the search has marched to the end of the step without a root
    MET       the root has been found
    MISSED    there is certainly no root in the step

This file is a template (see `step`): all templates are compiled together as one module.
"""

import math

from impact_damper.kernel.compiling import kernel_only

LANES: int

ROUNDING = 2.0**-50
# Stop the iteration for a root once (move / time in which the gap bends)^3 is below LAST_MOVE times
# the tolerance: the cube is the size of the term that is neglected in the speed.
LAST_MOVE = 0.01
# Upper bound of (t - t^k) / k over t in [0, 1] and powers k >= 2. The largest is 0.1283, for k = 3.
SAG = 0.13
MARCH, BRACKET, ENDING, MET, MISSED = 0.0, 1.0, 2.0, 3.0, 4.0
TINY = 1e-300
FAR = 1e200


@kernel_only
def safe_advance(gap, closing, bound):
    """Return a time within which the gap cannot vanish.

    It is the first root of gap - closing t - bound t^2/2, where `closing` is the speed at which the
    gap closes and `bound` an upper bound on the modulus of its second derivative.
    """
    gap = max(gap, 0.0)
    root = math.sqrt(closing * closing + 2.0 * bound * gap)
    above = 2.0 * gap if closing > 0.0 else root - closing
    below = closing + root if closing > 0.0 else bound + TINY
    return above / below


@kernel_only
def march_step(t, f, closing, ahead, length, fine):
    """Return the next time and mode of a search in mode MARCH.

    The gap f at t is certainly positive for the time `ahead`. The root is at t if f is below the
    rounding error `fine` and the gap closes, or if `ahead` is too short to advance t.
    """
    met = closing and (f <= fine or t + ahead == t)
    ends = not t + ahead < length
    following = t if met else (length if ends else t + ahead)
    return following, MET if met else (ENDING if ends else MARCH)


@kernel_only
def chebyshev(first, bend):
    """Return a step of Chebyshev's method, which is of third order.

    `first` is the step of Newton's method, and `bend` the second derivative over the first.
    """
    return first * (1.0 - 0.5 * bend * first)


@kernel_only
def is_last_move(a, i, move, rate):
    """Return whether a move is so short that the terms it neglects are far below the tolerance.

    `rate` is the inverse of the time in which the gap bends.
    """
    turn = max(rate, 2.0 / a[LENGTH + i]) * move
    return abs(turn * turn * turn) <= max(LAST_MOVE * a[TOLERANCE + i], ROUNDING)


@kernel_only
def bracketed_step(a, i, t, f, first, bend, rate, fine):
    """Return the next move and mode of a search in mode BRACKET: one safeguarded iteration.

    f is the gap at t, positive at LOW and not positive at HIGH, with one root between them. HIGH is
    FAR while no such time is known: then at most one root lies between LOW and the end of the step.
    A move that would leave the bracket is replaced by bisection.

    Parameters
    ----------
    first, bend : float
        As of `chebyshev`; or another first guess and the bend that it leaves out.
    rate : float
        Least rate at which the gap is taken to bend, for `is_last_move`.
    fine : float
        Rounding error of the gap.
    """
    low = a[LOW + i] = t if f > 0.0 else a[LOW + i]
    high = a[HIGH + i] = a[HIGH + i] if f > 0.0 else t
    length = a[LENGTH + i]
    move = chebyshev(first, bend)
    inside = low < t + move and t + move < high
    past = high == FAR and not t + move < length
    last = inside and not past and is_last_move(a, i, move, max(rate, abs(bend)))
    if abs(f) <= fine:
        return 0.0, MET
    if f > 0.0 and not t < length:
        return 0.0, MISSED
    inner = move if inside else 0.5 * (low + min(high, length)) - t
    step = length - t if past else inner
    # The search also ends where the move is below the rounding of t, or is NaN.
    moved = t + step > t or t + step < t
    return step, MET if last or not moved else BRACKET


@kernel_only
def store_end(a, i, row, end, move, going):
    """Store value and slope after a last move, where a search is `going` on.

    They follow from the four rows from `row` on, which are value, slope, curve and jerk before it.
    """
    value, slope = a[row + i], a[row + LANES + i]
    curve, jerk = a[row + 2 * LANES + i], a[row + 3 * LANES + i]
    value += move * (slope + move * (0.5 * curve + move * (jerk / 6.0)))
    slope += move * (curve + move * (0.5 * jerk))
    a[end + i] = value if going else a[end + i]
    a[end + LANES + i] = slope if going else a[end + LANES + i]


@kernel_only
def store_search(a, i, mode, t, move):
    """Store time, mode and Z1 of a search after a move; return 1 if it goes on, else 0."""
    going = a[MODE + i] <= ENDING
    a[T + i] = t
    a[MODE + i] = mode
    store_end(a, i, Z1, END_Z1, move, going)
    return 1 if mode <= ENDING else 0


@kernel_only
def loose_mass(a, i, t):
    """Return Z2 and Z2' in flight, from Z1 and its slope at t: the loose mass moves uniformly."""
    drift = a[Y3 + i] - a[Y1 + i]
    return a[Z1 + i] + (a[Y2 + i] - a[Y0 + i]) + drift * t, a[Z1_SLOPE + i] + drift


@kernel_only
def first_guess(a, i):
    """Return the time of the contact by the first three terms of the gap's series."""
    gap = min(a[CLEARANCE + i], FAR) - a[WALL + i] * a[Y2 + i]
    speed = abs(a[Y3 + i])
    bend = a[WALL + i] * a[G + i]
    return 2.0 * gap / (speed + math.sqrt(max(speed * speed + 2.0 * bend * gap, 0.0)))


@kernel_only
def gap_ahead(a, i, t):
    """Return the gap to the WALL at t, the step of Newton's method to its root, and its bend.

    The bend is the second derivative over the first (see `chebyshev`). Z1, its slope and its curve
    at t are known.
    """
    z, w = loose_mass(a, i, t)
    closing = a[WALL + i] * w
    gap = min(a[CLEARANCE + i], FAR) - a[WALL + i] * z
    return gap, gap / closing, a[WALL + i] * a[Z1_CURVE + i] / closing


@kernel_only
def expect_contact(a):
    """Move T from LENGTH to the time at which a contact is expected, if one is.

    The expectation follows from the first three terms of the series, and the time from half of all
    terms, so that the processor need not wait for the last coefficients.
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
    """Move T to the expected contact of trajectories whose MODE is BRACKET, else to LENGTH."""
    for i in range(LANES):
        a[T + i] = min(first_guess(a, i), a[LENGTH + i])
    flight_early(a)
    for i in range(LANES):
        _, first, bend = gap_ahead(a, i, a[T + i])
        t = a[T + i] + chebyshev(first, bend)
        inside = a[MODE + i] == BRACKET and 0.0 < t and t < a[LENGTH + i]
        a[T + i] = t if inside else a[LENGTH + i]


@kernel_only
def find_contact(a):
    """Move T to the first contact in [0, T]: where |Z2| reaches the clearance from inside.

    If there is one, WALL becomes the wall and MODE becomes MET. If there is certainly none, T
    stays and MODE becomes MISSED. END_Z1 and END_Z1_SLOPE are those of Z1 at T in either case. At
    the call Z1 and its slope are known at T. Where T is before LENGTH, a contact is expected at T,
    and may lie a little later.

    Most flights are decided here by bounds, without a search. All terms of Z1' after the first,
    without their signs, add up to CHANGE at T. The bounds hold for any series, so they do not
    depend on the spring.

    - `clear`: each term of Z1 departs from its chord over [0, T] by at most SAG times its share of
      CHANGE T. So does Z2. No wall is met ahead if Z2 is further from it than this at both ends.
    - `left`: the wall behind is not met again where the mean of two lower bounds on the distance is
      positive, that from the chord and that from the first speed reduced by CHANGE.
    - `certain`: the speed keeps its sign where the mean of its lower bounds from both ends is
      positive. Then only the wall ahead can be met, and only once.
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
    """Do `find_contact` where a contact is expected at T: one iteration is enough for most.

    Return the number of trajectories that are still undecided.
    """
    flight_curve(a)
    unsettled = 0
    for i in range(LANES):
        t = a[T + i]
        awaited = a[MODE + i] == BRACKET and t < a[LENGTH + i]
        gap, first, bend = gap_ahead(a, i, t)
        move = chebyshev(first, bend)
        inside = 0.0 < t + move and t + move <= a[LENGTH + i]
        met = awaited and inside and is_last_move(a, i, move, abs(bend))
        otherwise = MISSED if awaited and gap > 0.0 else a[MODE + i]
        a[MODE + i] = MET if met else otherwise
        a[T + i] = t + move if met else t
        store_end(a, i, Z1, END_Z1, move, met)
        unsettled += 1 if a[MODE + i] < MET else 0
    return unsettled


@kernel_only
def search_contact(a):
    """Do `find_contact` for trajectories that its bounds have not decided, by iteration."""
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
                # From a wall that recedes, the gap within `shortest` is below its rounding error.
                shortest = math.sqrt(8.0 * fine / (bound + TINY))
                receding = max(shortest, ROUNDING * t) if wall * w <= 0.0 else 0.0
                ahead = max(min(upper, lower), receding)
                # A mass at rest on the wall is judged by its acceleration, a little later.
                t, mode = march_step(
                    t, clearance - wall * z, wall * w > 0.0, ahead, a[LENGTH + i], fine
                )
            elif mode == BRACKET:
                gap, first, bend = gap_ahead(a, i, t)
                move, mode = bracketed_step(a, i, t, gap, first, bend, 0.0, fine)
                t += move
            elif mode == ENDING:
                mode = MISSED
            a[WALL + i] = wall
            running += store_search(a, i, mode, t, move)
