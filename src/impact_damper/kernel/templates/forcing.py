"""Template (see `step`): cosine and sine of the forcing's phase at the beginning of a step."""

# QUARTER + QUARTER_REST is pi/2. QUARTER has few binary digits, so that its multiples are exact.
QUARTER = 1.5707963267341256
QUARTER_REST = 6.077100506506192e-11
# `forcing` updates COSINE and SINE by a Taylor series if W t has changed by less than NEAR (rad).
NEAR = 1e-4


def find_circle(a):
    """Compute CIRCLE_COSINE = cos(ANGLE) and CIRCLE_SINE = sin(ANGLE), with ANGLE in rad."""
    for i in range(LANES):
        angle = a[ANGLE + i]
        turns = np.floor(angle * (2.0 / math.pi) + 0.5)
        a[TURNS + i] = turns
        a[ANGLE + i] = (angle - turns * QUARTER) - turns * QUARTER_REST
    circular_series(a)
    for i in range(LANES):
        t = a[ANGLE + i]
        u = t * t
        c = 1.0 + u * a[CIRCLE_COSINE + i]
        s = t + t * u * a[CIRCLE_SINE + i]
        half = 0.5 * a[TURNS + i]
        odd = half != np.floor(half)
        half = 0.5 * np.floor(half)
        sign = 1.0 if half == np.floor(half) else -1.0
        a[CIRCLE_COSINE + i] = sign * (-s if odd else c)
        a[CIRCLE_SINE + i] = sign * (c if odd else s)


def find_forcing(a):
    """For t = KNOWN, set by the caller, compute (F + U W^2) cos(W t) and (F + U W^2) sin(W t)."""
    for i in range(LANES):
        a[ANGLE + i] = a[FREQUENCY + i] * a[KNOWN + i]
    find_circle(a)
    for i in range(LANES):
        amplitude = forcing_amplitude(a, i, LANES)
        a[COSINE + i] = amplitude * a[CIRCLE_COSINE + i]
        a[SINE + i] = amplitude * a[CIRCLE_SINE + i]


def forcing(a):
    """Compute COSINE = A cos(W t) and SINE = A sin(W t) at the time t = TIME. A is F + U W^2.

    Before the call both rows hold values for the time KNOWN. If LANES is 1 and KNOWN is close to
    TIME, the new values follow from the old ones by the addition theorem.
    """
    t = a[FREQUENCY] * (a[TIME] - a[KNOWN])
    if LANES > 1 or not abs(t) < NEAR:
        for i in range(LANES):
            a[KNOWN + i] = a[TIME + i]
        find_forcing(a)
    elif t != 0.0:
        c, s = a[COSINE], a[SINE]
        u = t * t
        a[COSINE] = (c - t * s) - u * (0.5 * c - t * (s / 6.0))
        a[SINE] = (s + t * c) - u * (0.5 * s + t * (c / 6.0))


def look_ahead(a):
    """If LANES is 1, compute COSINE and SINE for the expected end of the step, TIME + T."""
    if LANES == 1:
        a[KNOWN] = a[TIME] + a[T]
        find_forcing(a)
