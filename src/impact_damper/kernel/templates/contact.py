"""Template (see `step`): search for the beginning of a contact within a flight."""

# Upper bound on (t - t^k)/k for 0 <= t <= 1 and k = 2, 3, ... The maximum is 0.1283, at k = 3.
SAG = 0.13


def loose_mass(a, i, t):
    """Return Z2 and Z2' at time t of a flight. Z2 - Z1 - SWAY (see `find_sway`) is linear in t."""
    drift = a[Y3 + i] - a[Y1 + i]
    place = a[Z1 + i] + (a[Y2 + i] - a[Y0 + i]) + drift * t
    return place + a[SWAY + i], a[Z1_SLOPE + i] + drift + a[SWAY_SLOPE + i]


def first_guess(a, i):
    """Estimate when a contact begins, from the state at the beginning of the flight."""
    distance = min(a[CLEARANCE + i], FAR) - a[WALL + i] * a[Y2 + i]
    speed = abs(a[Y3 + i])
    bend = a[WALL + i] * (a[G + i] + a[ACROSS + i])
    return 2.0 * distance / (speed + math.sqrt(max(speed * speed + 2.0 * bend * distance, 0.0)))


def distance_ahead(a, i, t):
    """Return the distance f of the loose mass to WALL at time t, and -f/f' and f''/f'.

    Z1, SWAY (see `find_sway`) and their first two derivatives must have been computed for time t.
    """
    z, w = loose_mass(a, i, t)
    closing = a[WALL + i] * w
    curve = a[Z1_CURVE + i] + a[SWAY_CURVE + i]
    distance = min(a[CLEARANCE + i], FAR) - a[WALL + i] * z
    return distance, distance / closing, a[WALL + i] * curve / closing


def expect_contact(a):
    """Set T to the estimated time of a contact, if a contact is expected in the flight of a lane.

    A contact is expected if the first three terms of the Taylor series of Z2 give |Z2| > d0 at the
    time LENGTH. In lanes in which no contact is expected, T keeps its value, which is LENGTH.
    """
    expected = 0
    for i in range(LANES):
        length = a[LENGTH + i]
        wall = a[WALL + i] = 1.0 if a[Y3 + i] > 0.0 else -1.0
        bend = 0.5 * length * (a[G + i] + a[ACROSS + i])
        reached = wall * (a[Y2 + i] + length * (a[Y3 + i] + bend))
        reaches = reached > a[CLEARANCE + i] and a[APART + i] <= 0.0
        a[MODE + i] = BRACKET if reaches else MISSED
        expected += 1 if reaches else 0
    if expected > 0:
        guess_contact(a)


def guess_contact(a):
    """If MODE is BRACKET, set T to the estimated time of a contact. Otherwise set T to LENGTH."""
    for i in range(LANES):
        a[T + i] = min(first_guess(a, i), a[LENGTH + i])
    flight_early(a)
    find_sway(a)
    for i in range(LANES):
        _, first, bend = distance_ahead(a, i, a[T + i])
        t = a[T + i] + chebyshev(first, bend)
        inside = a[MODE + i] == BRACKET and 0.0 < t and t < a[LENGTH + i]
        a[T + i] = t if inside else a[LENGTH + i]


def find_contact(a):
    """Move T to the first time in [0, T] at which |Z2| reaches the clearance d0 from inside.

    If there is such a time, MODE becomes MET, and WALL becomes the wall in contact. Otherwise MODE
    becomes MISSED, and T keeps its value. END_Z1 and END_Z1_SLOPE hold Z1 and Z1' at T, before the
    call and after it. If T < LENGTH before the call, T is the time at which `expect_contact`
    expects a contact. Since this time may be too early, a contact slightly after T is found too. If
    the loose mass sticks, or if the flight begins at |Z2| > d0, MODE becomes MISSED at once.

    Bounds decide most flights without a search. `change` is an upper bound on the change of Z2' in
    the flight. The loose mass approaches the wall ahead at the beginning of the flight.

    - `clear` is true if the loose mass cannot reach the wall ahead: the values of Z2 at 0 and at T
      are more than `sag` away from this wall. Z2 as a function of time deviates by at most `sag`
      from the straight line between both values.
    - `left` is true if a lower bound on the distance to the opposite wall is positive. This bound
      is the mean of two: one from `change` and the straight line, one from `change` and Z2' at 0.
    - `certain` is true if a lower bound on the speed towards the wall ahead is positive. This bound
      is the mean of two: one from `change` and Z2' at 0, one from `change` and Z2' at T.
    """
    undecided = 0
    expected = 0
    find_sway(a)
    for i in range(LANES):
        t = a[T + i]
        clearance = min(a[CLEARANCE + i], FAR)
        speed = abs(a[Y3 + i])
        change = a[CHANGE + i] + a[MOST + i] * t
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
        missed = missed or a[APART + i] > 0.0
        a[WALL + i] = wall
        a[MODE + i] = MISSED if missed else (BRACKET if certain else MARCH)
        expected += 1 if awaited else 0
        undecided += 0 if missed else 1
    if expected > 0:
        undecided = meet_expected(a)
    if undecided > 0:
        undecided = exclude_contacts(a)
    if undecided > 0:
        search_contact(a)


def meet_expected(a):
    """Find expected contacts by one Chebyshev step. Return how many lanes are still undecided."""
    flight_curve(a)
    find_sway(a)
    undecided = 0
    for i in range(LANES):
        t = a[T + i]
        awaited = a[MODE + i] == BRACKET and t < a[LENGTH + i]
        distance, first, bend = distance_ahead(a, i, t)
        move = chebyshev(first, bend)
        inside = 0.0 < t + move and t + move <= a[LENGTH + i]
        met = awaited and inside and is_last_move(a, i, move, abs(bend))
        otherwise = MISSED if awaited and distance > 0.0 else a[MODE + i]
        a[MODE + i] = MET if met else otherwise
        a[T + i] = t + move if met else t
        store_end(a, i, Z1, END_Z1, move, met)
        undecided += 1 if a[MODE + i] < MET else 0
    return undecided


def exclude_contacts(a):
    """Set MODE to MISSED in lanes whose loose mass certainly meets no wall in [0, T].

    Return how many lanes are still undecided. Let the cubic polynomial C have the values and slopes
    of Z2 at the times 0 and T. Then |Z2 - C| is at most `most` = T^4 max|Z2''''| / 384. In each
    half of [0, T], C has four Bernstein coefficients, and |C| is at most their largest modulus.
    Both halves share the coefficient at T/2, so there are seven coefficients, c0 to c6. |Z2| is at
    most the largest of |c0|, |c1|, |c2| + 4/3 `most`, |c3| + `most`, |c4| + 4/3 `most`, |c5|, |c6|.
    """
    flight_snap(a)
    undecided = 0
    for i in range(LANES):
        t = a[T + i]
        square = t * t
        turn = a[FREQUENCY + i] * a[FREQUENCY + i]
        most = (a[SNAP + i] + turn * a[MOST + i]) * (square * square) / 384.0
        final, slope = loose_mass(a, i, t)
        first = a[Y2 + i] + t * a[Y3 + i] / 3.0
        second = final - t * slope / 3.0
        middle = 0.5 * (first + second)
        outer = max(abs(a[Y2 + i] + first), abs(second + final))
        inner = max(abs(0.5 * (a[Y2 + i] + first) + middle), abs(0.5 * (second + final) + middle))
        top = abs(0.25 * (a[Y2 + i] + final) + 1.5 * middle)
        reach = 0.5 * max(outer, max(inner + 8.0 / 3.0 * most, top + 2.0 * most))
        missed = a[MODE + i] < MET and max(reach, abs(final)) < a[CLEARANCE + i]
        a[MODE + i] = MISSED if missed else a[MODE + i]
        undecided += 1 if a[MODE + i] < MET else 0
    return undecided


def search_contact(a):
    """Search for the contact in lanes that the bounds of `find_contact` leave undecided."""
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
        flight_values(a)
        running = 0
        for i in range(LANES):
            t = a[T + i]
            mode = a[MODE + i]
            bound = a[BOUND + i] + a[MOST + i]
            clearance = min(a[CLEARANCE + i], FAR)
            fine = ROUNDING * clearance
            z, w = loose_mass(a, i, t)
            wall = a[WALL + i]
            move = 0.0
            if mode == MARCH:
                upper = safe_advance(clearance - z, w, bound)
                lower = safe_advance(clearance + z, -w, bound)
                wall = 1.0 if upper < lower else -1.0
                # When the loose mass leaves a wall, its distance is at first a rounding error.
                shortest = math.sqrt(8.0 * fine / (bound + TINY))
                receding = max(shortest, ROUNDING * t) if wall * w <= 0.0 else 0.0
                ahead = max(min(upper, lower), receding)
                # No contact begins at t if the loose mass rests on a wall and does not approach it.
                t, mode = march_step(
                    t, clearance - wall * z, wall * w > 0.0, ahead, a[LENGTH + i], fine
                )
            elif mode == BRACKET:
                distance, first, bend = distance_ahead(a, i, t)
                move, mode = bracketed_step(a, i, t, distance, first, bend, 0.0, fine)
                t += move
            elif mode == ENDING:
                mode = MISSED
            a[WALL + i] = wall
            running += store_search(a, i, mode, t, move)
