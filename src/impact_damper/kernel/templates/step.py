"""One Taylor step of the integration, for one trajectory or several side by side.

The trajectories of a step are all in flight or all in contact. A trajectory's step ends at the next
event or before. Events: a contact begins or ends, or the loose mass stops or begins to slide.

The files in this folder are templates. `instances.instance` joins them into one module. A module
has a fixed number of lanes. Each lane holds one trajectory. The array `a` holds all numbers of the
trajectories, the array `d` all numbers of their tangents. A name in capitals, such as Y0, is the
index in `a` at which a row begins: a[Y0 + i] belongs to lane i. `instances` describes the rows.
"""

# The 64 bits of the float 1.0, read as an integer.
ONE = 1023 << 52
# The last terms of the series of Z1' and Z2' in a step should be below SAFETY * tolerance * SCALE.
# SCALE is the largest of 1, |Z1| and |Z1'|, in contact also of |Z2'|. With SAFETY = 0.05 the errors
# of settled motions are below 10 times the tolerance.
SAFETY = 0.05
# A flight is shortened only if the last terms of its series exceed EXCESS times `largest_tail`.
EXCESS = 4.0
# A step in flight that begins at |Z2| > d0 lasts at most OUTSIDE times LAG.
OUTSIDE = 2.0
# If the loose mass is nearer to a wall than NEAREST times d0 and approaches it, and if the step is
# so short that TIME + T equals TIME, the step ends in contact with this wall.
NEAREST = 1e-9


def largest_tail(a, i):
    """Return how large the last terms in the Taylor series of a velocity in lane i may be."""
    return SAFETY * a[TOLERANCE + i] * a[SCALE + i]


def limit_length(a, series, order, excess):
    """Shorten LENGTH so that the last two terms of a velocity's series are below `largest_tail`.

    The coefficients c[k] of the displacement stand in the rows from `series` on, and the highest k
    is `order`. At the new LENGTH t, each of the last two terms k c[k] t^(k-1) has at most the
    modulus `largest_tail`. Before the call TAIL has the largest modulus of any velocity's last two
    terms at the old LENGTH. If TAIL is at most `excess` * `largest_tail`, LENGTH is not changed.
    """
    for i in range(LANES):
        most = bits(largest_tail(a, i))
        last = most - bits(abs(order * a[series + order * LANES + i]))
        before = most - bits(abs((order - 1) * a[series + (order - 1) * LANES + i]))
        last = (last >> 28) * ((1 << 28) // (order - 1))
        before = (before >> 28) * ((1 << 28) // (order - 2))
        shorter = min(a[LENGTH + i], number(ONE + min(last, before)))
        a[LENGTH + i] = shorter if a[TAIL + i] > excess * largest_tail(a, i) else a[LENGTH + i]


def predict_length(a):
    """Predict the LENGTH of a flight, at most LONGEST, from three coefficients of middle order.

    Let x[k] be the Taylor coefficients of Z1. It is assumed that |k x[k]| = SCALE / r^(k-1). SCALE
    is the largest of 1, |Z1| and |Z1'|. Each of the orders k = EARLY, EARLY + 1 and EARLY + 2 gives
    an r. With the smallest r, the last term of Z1' reaches `largest_tail` at the time LENGTH.
    """
    last = FLIGHT_ORDER - 1
    for i in range(LANES):
        a[SCALE + i] = max(1.0, max(abs(a[Y0 + i]), abs(a[Y1 + i])))
        fall = ((bits(SAFETY * a[TOLERANCE + i]) - ONE) >> 28) * ((1 << 28) // last)
        top = bits(a[SCALE + i])
        first = (top - bits(abs(EARLY * a[X + EARLY * LANES + i]))) >> 28
        second = (top - bits(abs((EARLY + 1) * a[X + (EARLY + 1) * LANES + i]))) >> 28
        third = (top - bits(abs((EARLY + 2) * a[X + (EARLY + 2) * LANES + i]))) >> 28
        first *= (1 << 28) // (EARLY - 1)
        second *= (1 << 28) // EARLY
        third *= (1 << 28) // (EARLY + 1)
        length = number(ONE + fall + min(first, min(second, third)))
        a[LENGTH + i] = min(a[LONGEST + i], length)
        a[T + i] = a[LENGTH + i]


def end_flight(a):
    """Shorten flights that are too long for their series. Store Z1 and Z1' at each flight's end."""
    flight_slope(a)
    beyond = 0
    for i in range(LANES):
        beyond += 1 if a[TAIL + i] > EXCESS * largest_tail(a, i) else 0
    if beyond > 0:
        limit_length(a, X, FLIGHT_ORDER, EXCESS)
        for i in range(LANES):
            a[T + i] = min(a[T + i], a[LENGTH + i])
        flight_slope(a)
    for i in range(LANES):
        a[END_Z1 + i] = a[Z1 + i]
        a[END_Z1_SLOPE + i] = a[Z1_SLOPE + i]


def flight_step(a):
    """Do a step in flight. SIDE becomes the wall (-1 or 1) if a contact begins, and 0 otherwise."""
    forcing(a)
    load_across(a)
    if a[STICKS] > 0.0:
        series_held(a, False)
    else:
        flight_series(a)
    predict_length(a)
    walls = 0
    outside = 0
    for i in range(LANES):
        a[MODE + i] = MISSED
        walls += 1 if a[CLEARANCE + i] < math.inf else 0
        apart = max(abs(a[Y2 + i]) - a[CLEARANCE + i], a[STUCK + i])
        a[APART + i] = apart
        outside += 1 if apart > 0.0 else 0
    if outside > 0:
        shorten_outside(a)
    if walls > 0:
        expect_contact(a)
    look_ahead(a)
    end_flight(a)
    if walls > 0:
        flight_change(a)
        find_contact(a)
    if outside > 0:
        find_return(a)
    if a[ROUGH] > 0.0:
        find_turn(a, False)
    find_sway(a)
    for i in range(LANES):
        t = a[T + i]
        # `stuck` is true if a step towards a wall is too short to change TIME (see NEAREST).
        near = 1.0 if a[Y2 + i] > 0.0 else -1.0
        stuck = a[TIME + i] + t == a[TIME + i] and t < a[LONGEST + i] and near * a[Y3 + i] > 0.0
        stuck = stuck and near * a[Y2 + i] > (1.0 - NEAREST) * a[CLEARANCE + i]
        a[WALL + i] = near if stuck else a[WALL + i]
        deep = a[MODE + i] == MET_DEEP
        met = a[MODE + i] == MET or deep or stuck
        offset = a[Y2 + i] - a[Y0 + i]
        drift = a[Y3 + i] - a[Y1 + i]
        flown = a[END_Z1 + i] + offset + drift * t + a[SWAY + i]
        a[Y0 + i] = a[END_Z1 + i]
        a[Y1 + i] = a[END_Z1_SLOPE + i]
        a[Y2 + i] = a[WALL + i] * a[CLEARANCE + i] if met and not deep else flown
        a[Y3 + i] = a[END_Z1_SLOPE + i] + drift + a[SWAY_SLOPE + i]
        a[SIDE + i] = a[WALL + i] if met else 0.0
        a[LENGTH + i] = t
    if a[ROUGH] > 0.0:
        end_turn(a)
    if a[STICKS] > 0.0:
        let_go(a)


def shorten_outside(a):
    """Limit steps in flight that begin at |Z2| > d0 to the length OUTSIDE times LAG."""
    for i in range(LANES):
        shorter = min(a[LENGTH + i], OUTSIDE * a[LAG + i])
        a[LENGTH + i] = shorter if is_outside(a, i) else a[LENGTH + i]
        a[T + i] = a[LENGTH + i]


def flight_tangents(a, d):
    """Integrate tangents over the flight that `flight_step` has just integrated."""
    if a[STICKS] > 0.0:
        keep_tangents(a, d)
    flight_squares(a)
    flight_tangent_series(a, d)
    for i in range(TANGENTS):
        d[2 * TANGENTS + i] -= d[i]
        d[3 * TANGENTS + i] -= d[TANGENTS + i]
    flight_tangent_value(a, d)
    for i in range(TANGENTS):
        d[2 * TANGENTS + i] += d[i] + d[3 * TANGENTS + i] * a[LENGTH + i % LANES]
        d[3 * TANGENTS + i] += d[TANGENTS + i]
    dashpot_jump(a, d, -1.0)
    if a[ROUGH] > 0.0:
        friction_jump(a, d)


def contact_tangents(a, d):
    """Integrate tangents over the step in contact that `contact_step` has just integrated."""
    if a[STICKS] > 0.0:
        keep_tangents(a, d)
    contact_squares(a)
    contact_tangent_series(a, d)
    contact_tangent_value(a, d)
    dashpot_jump(a, d, 1.0)
    if a[ROUGH] > 0.0:
        friction_jump(a, d)


def dashpot_jump(a, d, direction):
    """Let tangents jump at the beginning or end of a contact (saltation matrix).

    At |Z2| = d0 the force of the wall's dashpot begins (direction -1) or ends (direction +1). No
    other force jumps. Therefore the tangent's velocities jump in proportion to the tangent's Z2. If
    a contact begins or ends at |Z2| > d0, the wall's force is 0 there, and no tangent jumps.
    """
    for i in range(TANGENTS):
        j = i % LANES
        begun = a[SIDE + j] != 0.0
        crossed = begun if direction < 0.0 else not begun
        crossed = crossed and abs(a[Y2 + j]) == a[CLEARANCE + j]
        jump = direction * a[DASHPOT + j] * d[2 * TANGENTS + i] if crossed else 0.0
        d[TANGENTS + i] += jump
        d[3 * TANGENTS + i] += jump * (1.0 + a[INVERSE_MASS_RATIO + j])


def contact_step(a):
    """Do a step in contact. SIDE becomes 0 in lanes whose contact ends."""
    forcing(a)
    load_across(a)
    predict_separation(a)
    if a[STICKS] > 0.0:
        series_held(a, True)
    elif a[SWAYS] > 0.0:
        contact_series_across(a)
    else:
        contact_series(a)
    look_ahead(a)
    contact_bound(a)
    beyond = 0
    for i in range(LANES):
        scale = max(1.0, max(abs(a[Y0 + i]), abs(a[Y1 + i])))
        a[SCALE + i] = max(scale, abs(a[Y3 + i]))
        beyond += 1 if a[TAIL + i] > largest_tail(a, i) else 0
    if beyond > 0:
        limit_length(a, X, CONTACT_ORDER, 1.0)
        limit_length(a, Q, CONTACT_ORDER, 1.0)
        for i in range(LANES):
            a[T + i] = min(a[T + i], a[LENGTH + i])
        contact_bound(a)
    find_separation(a)
    if a[ROUGH] > 0.0:
        find_turn(a, True)
    for i in range(LANES):
        separated = a[MODE + i] == MET
        wall = a[SIDE + i] * a[CLEARANCE + i]
        a[Y0 + i] = a[END_Z1 + i]
        a[Y1 + i] = a[END_Z1_SLOPE + i]
        a[Y2 + i] = wall if separated and a[LAG + i] == 0.0 else wall + a[END_DEPTH + i]
        a[Y3 + i] = a[END_DEPTH_SLOPE + i]
        a[SIDE + i] = 0.0 if separated else a[SIDE + i]
        a[LENGTH + i] = a[T + i]
    if a[ROUGH] > 0.0:
        end_turn(a)
    if a[STICKS] > 0.0:
        let_go(a)
