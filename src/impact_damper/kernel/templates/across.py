"""Template (see `step`): Z2'' - Z1'' without the wall's force, called the acceleration across.

The acceleration across (the gap) is DRAW - BASE A cos(W T). A is the amplitude of the forcing. DRAW
is gravity along the gap plus the friction of sliding, per unit of loose mass. BASE is 1 if the base
moves, otherwise 0. Z1 is measured from the base. SWAY is the acceleration across, integrated twice
over time from the beginning of the step.
"""

# Phase angle x (rad) below which (x - sin x) / x^3 is computed from its Taylor series.
SMALL = 0.5


def is_outside(a, i):
    """Return whether a step in flight begins at |Z2| > d0 and the loose mass does not stick."""
    return abs(a[Y2 + i]) > a[CLEARANCE + i] and a[STUCK + i] == 0.0


def load_across(a):
    """Compute ACROSS, which is Z2'' - Z1'' without the wall's force at the beginning of a step.

    MOST becomes an upper bound on |Z2'' - Z1''| during the step, without the wall's force. SWAYS
    becomes the number of lanes with gravity, friction or a moving base.
    """
    acting = 0
    rough = 0
    for i in range(LANES):
        acting += 1 if abs(a[GRAVITY + i]) + a[BASE + i] + a[FRICTION + i] > 0.0 else 0
        rough += 1 if a[FRICTION + i] > 0.0 else 0
    # The rows that are set here are 0 already if SWAYS was 0 in the last step and stays 0.
    if acting > 0 or a[SWAYS] > 0.0:
        for i in range(LANES):
            a[DRAW + i] = a[GRAVITY + i]
            a[BASE_COSINE + i] = a[BASE + i] * a[COSINE + i]
            a[BASE_SINE + i] = a[BASE + i] * a[SINE + i]
        load_friction(a)
        for i in range(LANES):
            a[ACROSS + i] = a[DRAW + i] - a[BASE_COSINE + i]
            size = abs(a[BASE_COSINE + i]) + abs(a[BASE_SINE + i])
            a[MOST + i] = abs(a[DRAW + i]) + size
            a[SWAY + i] = 0.0
            a[SWAY_SLOPE + i] = 0.0
            a[SWAY_CURVE + i] = 0.0
            a[SWAY_JERK + i] = 0.0
        a[SWAYS] = acting
        a[ROUGH] = rough


def find_sway(a):
    """Compute SWAY and its first three derivatives at the time T of the step.

    SWAY is the part of Z2 - Z1 that gravity, friction and a moving base cause in the step.
    """
    if a[SWAYS] > 0.0:
        for i in range(LANES):
            a[ANGLE + i] = 0.5 * a[FREQUENCY + i] * a[T + i]
        find_circle(a)
        for i in range(LANES):
            t = a[T + i]
            angle = a[FREQUENCY + i] * t
            square = angle * angle
            half = a[CIRCLE_SINE + i]
            sine = 2.0 * half * a[CIRCLE_COSINE + i]
            cosine = 1.0 - 2.0 * half * half
            series = (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))) / 6.0
            series += (square * square) * (square * square) / 39916800.0
            # `first` is (1 - cos x) / x^2, and `second` is (x - sin x) / x^3, for x = `angle`.
            first = 2.0 * half * half / square if square > 1e-16 else 0.5
            second = series if square < SMALL * SMALL else (angle - sine) / (angle * square)
            c = a[BASE_COSINE + i]
            s = a[BASE_SINE + i]
            draw = a[DRAW + i]
            a[SWAY + i] = t * t * (0.5 * draw - (c * first - s * angle * second))
            a[SWAY_SLOPE + i] = t * (draw - (c * (1.0 - square * second) - s * angle * first))
            a[SWAY_CURVE + i] = draw - (c * cosine - s * sine)
            a[SWAY_JERK + i] = a[FREQUENCY + i] * (c * sine + s * cosine)


def flight_values(a):
    """Compute Z1, SWAY (see `find_sway`) and their derivatives at the time T of a flight."""
    flight_slope(a)
    flight_curve(a)
    find_sway(a)


def penetration_values(a):
    """Compute Z1, the depth, SWAY (see `find_sway`) and their derivatives at time T in contact."""
    find_sway(a)
    contact_values(a)


def find_return(a):
    """Find the first contact in [0, T] in lanes whose flight begins beyond a wall, at |Z2| > d0.

    Let q be |Z2| - d0 at this wall, and f = q + LAG q'. Two kinds of contact are possible:

    - f rises to zero while q > 0, so that this wall begins to push. MODE becomes MET_DEEP.
    - |Z2| reaches d0 from inside, at this or at the opposite wall. MODE becomes MET.

    WALL, T, END_Z1 and END_Z1_SLOPE are set as in `find_contact`. No search is needed if f falls
    during the whole step and the opposite wall is out of reach.
    """
    flight_bound(a)
    flight_jerk(a)
    running = 0
    for i in range(LANES):
        t = a[T + i]
        bound = a[BOUND + i] + a[MOST + i]
        a[BOUND + i] = bound
        a[JERK_BOUND + i] += a[FREQUENCY + i] * a[MOST + i]
        speed = abs(a[Y3 + i])
        change = a[CHANGE + i] + a[MOST + i] * t
        falls = a[Y2 + i] * a[Y3 + i] < 0.0 and speed - change > a[LAG + i] * bound
        falls = falls and (speed + change) * t < 2.0 * a[CLEARANCE + i]
        searched = is_outside(a, i) and not falls
        a[WALL + i] = (1.0 if a[Y2 + i] > 0.0 else -1.0) if searched else a[WALL + i]
        a[MODE + i] = MARCH if searched else a[MODE + i]
        a[LENGTH + i] = t
        a[T + i] = 0.0 if searched else t
        running += 1 if searched else 0
    while running > 0:
        flight_values(a)
        running = 0
        for i in range(LANES):
            t = a[T + i]
            mode = a[MODE + i]
            if mode == MARCH:
                t, mode = step_outside(a, i, t)
            elif mode == ENDING:
                mode = MISSED
            running += store_search(a, i, mode, t, 0.0)


def step_outside(a, i, t):
    """Continue the search of `find_return` at time t in lane i. Return the next time and mode."""
    wall, lag, bound = a[WALL + i], a[LAG + i], a[BOUND + i]
    clearance = a[CLEARANCE + i]
    z, w = loose_mass(a, i, t)
    q = wall * z - clearance
    slope = wall * w
    f = q + lag * slope
    rise = slope + lag * wall * (a[Z1_CURVE + i] + a[SWAY_CURVE + i])
    # `fine` is the rounding error of q and f (see `find_return`). Errors of Z1 and Z1' count too.
    fine = abs(a[Y0 + i]) + clearance + lag * (abs(a[Y1 + i]) + abs(slope))
    fine *= ROUNDING
    bent = bound + lag * a[JERK_BOUND + i]
    # q is WALL * Z2 - d0 and f is q + LAG q'. No contact with WALL begins while q or f is negative.
    deep = safe_advance(-q, slope, bound) if q <= fine else 0.0
    pressed = safe_advance(-f, rise, bent) if f <= fine else 0.0
    across = safe_advance(2.0 * clearance + q, -slope, bound)
    # The flight begins at f = q + LAG q' = 0. A positive f that falls at t = 0 is a rounding error.
    pushes = rise > 0.0 or (f > fine and t > 0.0)
    here = q >= -fine and f >= -fine and (q > fine or slope > 0.0) and pushes
    other = 2.0 * clearance + q <= fine and slope < 0.0
    shortest = math.sqrt(8.0 * fine / (bent + TINY))
    ahead = max(min(max(deep, pressed), across), max(shortest, ROUNDING * t))
    a[WALL + i] = -wall if other else wall
    following = min(t + ahead, a[LENGTH + i])
    ending = MARCH if following < a[LENGTH + i] else ENDING
    met = MET_DEEP if here and q > fine else MET
    return t if here or other else following, met if here or other else ending
