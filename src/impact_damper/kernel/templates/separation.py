"""Template (see `step`): search for the separation, at which a contact ends.

A contact ends when q + LAG q' falls to zero. q is the depth of the loose mass in the wall. With
LAG = 0 (the paper's rule) the wall may pull. With LAG = DASHPOT / CONTACT_STIFFNESS it never pulls.
"""

# Longest step, in natural periods of the contact: LONGEST_DEEPENING if the depth q grows at the
# beginning of the step, LONGEST_RETURNING if q falls.
LONGEST_DEEPENING, LONGEST_RETURNING = 0.55, 0.4
# `find_separation` defines a phase. If this phase advances at a rate within 25 % of the natural
# frequency, a step has at most one separation. In a step the phase then advances by less than
# 0.55 * 1.25 < 3/4 revolution if the depth grows at first, else by less than 0.4 * 1.25 = 1/2.
PHASE_MARGIN = 0.25


def fast_exp2(y):
    """Return 2^y with a relative error below 0.3 %."""
    whole = np.floor(y)
    part = y - whole
    power = number(np.int64((whole + 1023.0) * 2.0**52))
    return power * (1.0 + part * (0.6565 + 0.3435 * part))


def time_to_zero(f, slope, natural):
    """Estimate how long it takes until x = 0. Now x = f and x' = slope, and x'' = -natural^2 x."""
    u = natural * f * (natural * f)
    v = slope * slope
    return -f * (15.0 * v + 4.0 * u) / (slope * (15.0 * v + 9.0 * u))


def predict_separation(a):
    """Compute the LENGTH of a step in contact, and predict the time T <= LENGTH of separation."""
    for i in range(LANES):
        wall = a[SIDE + i]
        q = wall * a[Y2 + i] - a[CLEARANCE + i]
        w = wall * a[Y3 + i]
        x = a[Y0 + i]
        v = a[Y1 + i]
        h = a[DAMPING + i]
        mobility = 1.0 + a[INVERSE_MASS_RATIO + i]
        natural = math.sqrt(a[CONTACT_STIFFNESS + i] * mobility)
        loss = a[DASHPOT + i] * mobility
        longest = (LONGEST_DEEPENING if w >= 0.0 else LONGEST_RETURNING) * 2.0 * math.pi / natural
        length = min(a[LONGEST + i], longest)
        # If q = 0, the contact has just begun. It lasts about half a damped natural period, plus a
        # correction for g, which is Z1'' without the damper. If q is not 0, g is neglected.
        g = a[COSINE + i] - spring(a, x, i, LANES) - h * v
        slope = spring_slope(a, x, i, LANES)
        drift = -a[FREQUENCY + i] * a[SINE + i] - slope * v - h * g
        slowest = 0.01 * natural * natural
        half = math.pi / math.sqrt(max(natural * natural - 0.25 * loss * loss, slowest))
        mean = wall * (g + a[ACROSS + i] + 0.5 * half * drift) + h * w / mobility
        left = fast_exp2(-0.5 * loss * half / math.log(2.0))
        begun = half + (1.0 + left) * mean / (left * w * natural * natural + TINY)
        guess = begun if q == 0.0 else time_to_zero(q, w, natural)
        guess = guess - a[LAG + i]
        a[NATURAL + i] = natural
        a[LENGTH + i] = length
        a[T + i] = guess if 0.0 < guess < length else length


def find_separation(a):
    """Set T to the first time in [0, LENGTH] at which q + LAG q' falls to zero: the separation.

    Before the call T is a guess. If there is a separation, MODE becomes MET. If there is certainly
    none, T becomes LENGTH and MODE becomes MISSED. END_Z1 and END_Z1_SLOPE receive Z1 and Z1' at T.
    END_DEPTH and END_DEPTH_SLOPE receive the depth Z2 - SIDE d0 and the slope of the depth at T.

    Here q is the depth times SIDE, n the natural frequency of the contact, and `loss` is DASHPOT
    (1 + 1/rm). `rest` is an upper bound on |Z2''| without the wall's force, during the step. Then
    |q'' + n^2 q + loss q'| is at most `rest`. The phase is the angle of the point (n q, q') around
    the origin, and R is the distance of this point from the origin. R falls at most at the rate
    rest + loss R. Therefore R is at least `least` during the step. The phase advances at the rate
    n, to within rest/R + loss/2. q + LAG q' is zero twice in a revolution of the phase. If
    rest/least + loss/2 is below PHASE_MARGIN n, the step has at most one root, and the search
    begins in mode BRACKET. Otherwise it begins in mode MARCH.
    """
    penetration_values(a)
    uncertain = 0
    for i in range(LANES):
        q = a[SIDE + i] * a[Q + i]
        w = a[SIDE + i] * a[Q + LANES + i]
        length = a[LENGTH + i]
        natural = a[NATURAL + i]
        loss = a[DASHPOT + i] * (1.0 + a[INVERSE_MASS_RATIO + i])
        rest = a[BOUND + i] + a[MOST + i]
        speed = math.sqrt(w * w + natural * natural * q * q)
        least = 0.99 * fast_exp2(-loss * length / math.log(2.0)) * speed - rest * length
        certain = least > 0.0 and rest + 0.5 * loss * least < PHASE_MARGIN * natural * least
        a[BOUND + i] = rest + (natural + loss) * (speed + rest * length)
        a[JERK_BOUND + i] = natural * natural * (speed + rest * length) + loss * a[BOUND + i]
        a[FINE + i] = ROUNDING * (abs(q) + abs(w) * (length + a[LAG + i]))
        a[LOW + i] = 0.0
        a[HIGH + i] = FAR
        stuck = a[STUCK + i] > 0.0
        a[MODE + i] = ENDING if stuck else (BRACKET if certain else MARCH)
        a[T + i] = length if stuck else (a[T + i] if certain else 0.0)
        uncertain += 0 if certain and not stuck else 1
    if uncertain > 0:
        bound_lagging(a)
        penetration_values(a)
    running = 1
    while running > 0:
        running = 0
        for i in range(LANES):
            t = a[T + i]
            mode = a[MODE + i]
            lag = a[LAG + i]
            f = a[SIDE + i] * (a[DEPTH + i] + lag * a[DEPTH_SLOPE + i])
            slope = a[SIDE + i] * (a[DEPTH_SLOPE + i] + lag * a[DEPTH_CURVE + i])
            curve = a[SIDE + i] * (a[DEPTH_CURVE + i] + lag * a[DEPTH_JERK + i])
            fine = a[FINE + i]
            move = 0.0
            if mode == MARCH:
                ahead = safe_advance(f, -slope, a[BOUND + i])
                t, mode = march_step(t, f, slope <= 0.0, ahead, a[LENGTH + i], fine)
            elif mode == BRACKET:
                natural = a[NATURAL + i]
                bend = (curve + natural * natural * f) / slope
                first = time_to_zero(f, slope, natural)
                move, mode = bracketed_step(a, i, t, f, first, bend, natural, fine)
                t += move
            elif mode == ENDING:
                mode = MISSED
            store_end(a, i, DEPTH, END_DEPTH, move, a[MODE + i] <= ENDING)
            running += store_search(a, i, mode, t, move)
        if running > 0:
            penetration_values(a)


def bound_lagging(a):
    """Change BOUND from a bound on |q''| into a bound on |q'' + LAG q'''|. q is the depth."""
    lagging = 0
    for i in range(LANES):
        lagging += 1 if a[LAG + i] > 0.0 else 0
        a[Z1_JERK + i] = 0.0
    if lagging > 0:
        contact_jerk(a)
    for i in range(LANES):
        jerk = a[Z1_JERK + i] + a[FREQUENCY + i] * a[MOST + i] + a[JERK_BOUND + i]
        a[BOUND + i] += a[LAG + i] * jerk
