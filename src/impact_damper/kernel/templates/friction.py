"""Template (see `step`): Coulomb friction of the loose mass on its floor.

SLIDE is the sign of Z2'. While the loose mass slides, friction changes Z1'' by PUSH and Z2'' - Z1''
by -FRICTION * SLIDE. While the loose mass sticks (STUCK is 1), both masses move together:

    (1 + rm) Z1'' = g - rm (GRAVITY - BASE A cos(W T))

g is Z1'' without the damper, and A the amplitude of the forcing. The loose mass sticks as long as
the friction needed to hold it is below FRICTION.
"""


def load_friction(a):
    """Decide at the beginning of a step whether the loose mass sticks, or which way it slides."""
    a[STICKS] = 0.0
    for i in range(LANES):
        friction = a[FRICTION + i]
        w = a[Y3 + i]
        inverse = a[INVERSE_MASS_RATIO + i]
        a[PUSH + i] = 0.0
        a[STUCK + i] = 0.0
        if friction > 0.0:
            g = a[COSINE + i] - a[DAMPING + i] * a[Y1 + i] - spring(a, a[Y0 + i], i, LANES)
            across = a[GRAVITY + i] - a[BASE_COSINE + i]
            needed = (g + across) * inverse / (1.0 + inverse) - inverse * wall_force(a, i)
            a[SLIDE + i] = 1.0 if (w if w != 0.0 else needed) > 0.0 else -1.0
            a[PUSH + i] = -friction * a[SLIDE + i] / inverse
            a[DRAW + i] = a[GRAVITY + i] - friction * a[SLIDE + i]
            if w == 0.0 and abs(needed) < friction:
                a[STUCK + i] = 1.0
                a[STICKS] = 1.0
                a[PUSH + i] = -a[GRAVITY + i] / (1.0 + inverse)
                a[DRAW + i] = a[GRAVITY + i]


def wall_force(a, i):
    """Return the wall's force divided by the primary mass, at the beginning of a step."""
    wall = a[SIDE + i]
    depth = a[Y2 + i] - wall * a[CLEARANCE + i]
    force = a[CONTACT_STIFFNESS + i] * depth + a[DASHPOT + i] * a[Y3 + i]
    return force if wall != 0.0 else 0.0


def hold(a):
    """Change parameters in lanes whose loose mass sticks, since both masses move as one body.

    The parameters of damping and spring are divided by 1 + rm. The stiffness and the dashpot of the
    wall (last in `instances.HELD`) become 0, because the wall's force is internal to this body.
    """
    for k in range(len(HELD_ROWS)):
        row, free = HELD_ROWS[k], FREE_ROWS[k]
        for i in range(LANES):
            inverse = a[INVERSE_MASS_RATIO + i]
            share = inverse / (1.0 + inverse) if k < len(HELD_ROWS) - 2 else 0.0
            a[free + i] = a[row + i]
            a[row + i] *= share if a[STUCK + i] > 0.0 else 1.0
    for i in range(LANES):
        a[HELD_Z2 + i] = a[Y2 + i]
    load_rates(a)


def let_go(a):
    """Restore the parameters that `hold` has replaced."""
    for k in range(len(HELD_ROWS)):
        for i in range(LANES):
            a[HELD_ROWS[k] + i] = a[FREE_ROWS[k] + i]
    load_rates(a)


def load_rates(a):
    """If LANES is 1, fill the rows H with DAMPING/k, and D with DASHPOT/k, for all orders k."""
    if LANES == 1:
        for k in range(max(FLIGHT_ORDER, CONTACT_ORDER) - 1):
            a[H + k] = a[DAMPING] * (1.0 / max(k, 1))
            a[D + k] = a[DASHPOT] * (1.0 / max(k, 1))


def series_held(a, touching):
    """Compute a step's Taylor series if a loose mass sticks. In contact `touching` is true."""
    hold(a)
    for i in range(LANES):
        inverse = a[INVERSE_MASS_RATIO + i]
        share = (inverse + a[BASE + i]) / (1.0 + inverse)
        a[LOW + i] = a[COSINE + i]
        a[HIGH + i] = a[SINE + i]
        a[COSINE + i] *= share if a[STUCK + i] > 0.0 else 1.0
        a[SINE + i] *= share if a[STUCK + i] > 0.0 else 1.0
    if touching:
        contact_series_across(a)
    else:
        flight_series(a)
    for i in range(LANES):
        a[COSINE + i] = a[LOW + i]
        a[SINE + i] = a[HIGH + i]


def find_turn(a, touching):
    """Find the first turn or slip before T. `touching` says whether the step is in contact.

    At a turn a sliding loose mass stops (Z2' = 0). At a slip a sticking loose mass begins to slide.
    If a turn or slip is found, MODE becomes TURNED, T becomes the time of this event, and the rows
    END_Z1, END_Z1_SLOPE, END_DEPTH and END_DEPTH_SLOPE receive the values at this time.
    """
    if touching:
        contact_jerk(a)
    else:
        flight_jerk(a)
    running = 0
    for i in range(LANES):
        rough = a[FRICTION + i] > 0.0
        jerk = (a[Z1_JERK + i] if touching else a[JERK_BOUND + i]) + a[FREQUENCY + i] * a[MOST + i]
        jerk += a[JERK_BOUND + i] if touching and a[STUCK + i] == 0.0 else 0.0
        a[BOUND + i] = jerk
        a[LIMIT + i] = a[T + i]
        a[TURN + i] = MARCH if rough else MISSED
        a[T + i] = 0.0 if rough else a[T + i]
        running += 1 if rough else 0
    while running > 0:
        if touching:
            penetration_values(a)
        else:
            flight_values(a)
        running = 0
        for i in range(LANES):
            if a[TURN + i] == MARCH:
                step_to_turn(a, i, touching)
                running += 1 if a[TURN + i] == MARCH else 0


def step_to_turn(a, i, touching):
    """Continue `find_turn` in lane i: move T, or end the search. In contact `touching` is true."""
    t, bound = a[T + i], a[BOUND + i]
    stuck = a[STUCK + i] > 0.0
    if touching:
        w, curve = a[DEPTH_SLOPE + i], a[DEPTH_CURVE + i]
    else:
        w = a[Z1_SLOPE + i] + (a[Y3 + i] - a[Y1 + i]) + a[SWAY_SLOPE + i]
        curve = a[Z1_CURVE + i] + a[SWAY_CURVE + i]
    if stuck:
        force = wall_force_held(a, i) if touching else 0.0
        needed = a[Z1_CURVE + i] + a[SWAY_CURVE + i] - a[INVERSE_MASS_RATIO + i] * force
        f = a[FRICTION + i] - abs(needed)
        rise = a[Z1_JERK + i] + a[SWAY_JERK + i]
        closing = rise * needed > 0.0
        fine = 4.0 * ROUNDING * a[FRICTION + i]
        ahead = max(f, 0.0) / (bound + TINY)
        a[SLIDE + i] = 1.0 if needed > 0.0 else -1.0
    else:
        f = a[SLIDE + i] * w
        slowing = -a[SLIDE + i] * curve
        closing = slowing > 0.0 and t > 0.0
        fine = ROUNDING * (abs(a[Y3 + i]) + bound * a[LIMIT + i] * a[LIMIT + i])
        ahead = safe_advance(f, slowing, bound)
    met = closing and (f <= fine or t + ahead == t)
    shortest = math.sqrt(8.0 * fine / (bound + TINY)) if f <= fine else 0.0
    following = t + max(ahead, max(shortest, ROUNDING * t))
    if met:
        a[TURN + i] = MET
        a[MODE + i] = TURNED
        a[BEND + i] = curve
        a[END_Z1 + i] = a[Z1 + i]
        a[END_Z1_SLOPE + i] = a[Z1_SLOPE + i]
        a[END_DEPTH + i] = a[DEPTH + i]
        a[END_DEPTH_SLOPE + i] = 0.0
    elif following < a[LIMIT + i]:
        a[T + i] = following
    else:
        a[TURN + i] = MISSED
        a[T + i] = a[LIMIT + i]


def wall_force_held(a, i):
    """Return the wall's force divided by the primary mass, while the loose mass sticks."""
    return a[FREE_CONTACT_STIFFNESS + i] * (a[Y2 + i] - a[SIDE + i] * a[CLEARANCE + i])


def end_turn(a):
    """Set Z2' to 0 if the loose mass stands still, and to TINY * SLIDE if it begins to slide."""
    for i in range(LANES):
        slipped = a[STUCK + i] > 0.0 and a[MODE + i] == TURNED
        held = a[STUCK + i] > 0.0 and not slipped
        still = held or (a[MODE + i] == TURNED and not slipped)
        a[Y3 + i] = 0.0 if still else a[Y3 + i]
        a[Y3 + i] = TINY * a[SLIDE + i] if slipped else a[Y3 + i]
        a[Y2 + i] = a[HELD_Z2 + i] if a[STUCK + i] > 0.0 else a[Y2 + i]


def keep_tangents(a, d):
    """Call `hold`, which changes parameters, and store each tangent's Z2 in the row KEPT."""
    hold(a)
    for i in range(TANGENTS):
        d[KEPT + i] = d[2 * TANGENTS + i]


def friction_jump(a, d):
    """Let tangents jump when a sliding loose mass stops (saltation matrix), and call `let_go`.

    When the loose mass stops, the friction per unit of loose mass jumps by J. Let b be Z2'' before
    the jump, and w the tangent's Z2'. The tangent's Z1' jumps by -rm w J/b, and w jumps by
    -(1 + rm) w J/b. If the loose mass has stuck during the step, w becomes 0, and the tangent's Z2
    keeps its value from the beginning of the step (KEPT).
    """
    for i in range(TANGENTS):
        j = i % LANES
        inverse = a[INVERSE_MASS_RATIO + j]
        limit = a[FRICTION + j]
        stuck = a[STUCK + j] > 0.0
        before = limit * a[SLIDE + j]
        needed = a[BEND + j] * inverse / (1.0 + inverse) + before
        jump = min(max(needed, -limit), limit) - before
        turned = a[MODE + j] == TURNED and not stuck
        ratio = jump / a[BEND + j] * d[3 * TANGENTS + i] if turned else 0.0
        d[TANGENTS + i] -= ratio / inverse if turned else 0.0
        d[3 * TANGENTS + i] -= ratio * (1.0 + 1.0 / inverse) if turned else 0.0
        d[2 * TANGENTS + i] = d[KEPT + i] if stuck else d[2 * TANGENTS + i]
        d[3 * TANGENTS + i] = 0.0 if stuck else d[3 * TANGENTS + i]
    if a[STICKS] > 0.0:
        let_go(a)
