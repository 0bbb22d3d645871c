"""Search for the first contact of a flight, with the kernels of `root_search`.

This file is a template (see `step`): all templates are compiled together as one module.
"""

import math

from impact_damper.kernel.compiling import kernel_only

LANES: int

# Upper bound of (t - t^k) / k over t in [0, 1] and powers k >= 2. The largest is 0.1283, for k = 3.
SAG = 0.13


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
    """Move T from LENGTH to the expected time of a contact, if one is expected in the step.

    Whether a contact is expected follows from the first three terms of the series, and its time
    from half of all terms: the processor need not wait for the last coefficients.
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
    stays and MODE becomes MISSED. In either case END_Z1 and END_Z1_SLOPE become Z1 and its slope at
    T. Before the call Z1 and its slope at T must be known. T is before LENGTH if a contact is
    expected at T; the contact may lie a little later.

    Most flights are decided here by bounds, without a search. CHANGE is the sum of the moduli of
    all terms of Z1' after the first, at T. The bounds hold for any series, so they do not depend on
    the spring.

    - `clear`: each term of Z1 departs from its chord over [0, T] by at most SAG times its share of
      CHANGE T. So does Z2. No wall is met ahead if Z2 is further from it than this at both ends.
    - `left`: there are two lower bounds on the distance from the wall behind, one from the chord,
      the other from the initial speed minus CHANGE. If their mean is positive, this wall is not met
      again.
    - `certain`: there is a lower bound on the speed from either end. If the mean of both is
      positive, the speed keeps its sign: only the wall ahead can be met, and only once.
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
    """Decide `find_contact` for trajectories with a contact expected at T, by one iteration.

    This is enough for most. Return the number of trajectories that are still undecided.
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
    """Decide `find_contact` by iteration for trajectories that its bounds leave undecided."""
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
