"""The search for the end of a contact.

This file is a template, as `step` is, and is compiled in one module with it.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import kernel_only
from impact_damper.kernel.equation import spring, spring_slope

LANES: int

# Longest steps in contact, while it deepens and on the way back, in natural periods of it, and
# the share of its natural frequency by which its phase may turn faster, so that a step turns
# the phase by less than three quarters of a turn, and half a turn: past one release at most.
DEEPER, BACK, TURNING = 0.55, 0.4, 0.25


@kernel_only
def fast_exp2(y):
    """Power of 2, to 0.3 %."""
    whole = np.floor(y)
    part = y - whole
    power = number(np.int64((whole + 1023.0) * 2.0**52))
    return power * (1.0 + part * (0.6565 + 0.3435 * part))


@kernel_only
def swing(f, slope, natural):
    """Time, nearly, in which what swings at a natural frequency with f and this slope is at zero.

    Arctangent of natural * move over natural, where the move is -f / slope.
    """
    u = (natural * f) ** 2
    v = slope * slope
    return -f * (15.0 * v + 4.0 * u) / (slope * (15.0 * v + 9.0 * u))


@kernel_only
def foresee_release(a):
    """NATURAL frequency, LENGTH, and a guess at T in it where the contact ends.

    By the state alone: the series need not be waited for.
    """
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
        longest = (DEEPER if w >= 0.0 else BACK) * 2.0 * math.pi / natural
        length = min(a[LONGEST + i], longest)
        # From the wall half a period of the contact, and what the mean of g adds to it, with Z1'
        # as the contact changes it; back to the wall, as without g.
        g = a[COSINE + i] - spring(a, x, i, LANES) - h * v
        slope = spring_slope(a, x, i, LANES)
        drift = -a[FREQUENCY + i] * a[SINE + i] - slope * v - h * g
        half = math.pi / math.sqrt(max(natural * natural - 0.25 * loss * loss, TINY))
        mean = wall * (g + 0.5 * half * drift) + h * w / mobility
        left = fast_exp2(-0.5 * loss * half / math.log(2.0))
        begun = half + (1.0 + left) * mean / (left * w * natural * natural + TINY)
        guess = begun if q == 0.0 else swing(q, w, natural)
        a[NATURAL + i] = natural
        a[LENGTH + i] = length
        a[T + i] = guess if 0.0 < guess < length else length


@kernel_only
def find_release(a):
    """Move T to the first time in [0, LENGTH] at which the penetration returns to zero.

    At first T is a guess. MODE becomes MET; or T the LENGTH and MODE MISSED, when there is
    certainly none. END_Z1, END_DEPTH and their slopes are of Z1 and of the penetration at T. With
    g the part of its acceleration that does not come from the wall, |g| <= G = BOUND,

        q'' = g - w^2 q - D q',

    so that R = (q'^2 + w^2 q^2)^(1/2) grows at most, and falls at most but for the dashpot, at
    the rate G: a bound on q''. The phase of (w q, q') turns at the rate w, but for G/R + D/2 at
    most. Where that is little, q has one root at most before the phase has turned once.
    """
    contact_values(a)
    uncertain = 0
    for i in range(LANES):
        q = a[SIDE + i] * a[Q + i]
        w = a[SIDE + i] * a[Q + LANES + i]
        length = a[LENGTH + i]
        natural = a[NATURAL + i]
        loss = a[DASHPOT + i] * (1.0 + a[INVERSE_MASS_RATIO + i])
        rest = a[BOUND + i]
        speed = math.sqrt(w * w + natural * natural * q * q)
        least = 0.99 * fast_exp2(-loss * length / math.log(2.0)) * speed - rest * length
        certain = least > 0.0 and rest + 0.5 * loss * least < TURNING * natural * least
        a[BOUND + i] = rest + (natural + loss) * (speed + rest * length)
        a[FINE + i] = ROUNDING * (abs(q) + abs(w) * length)
        a[LOW + i] = 0.0
        a[HIGH + i] = FAR
        a[MODE + i] = BRACKET if certain else MARCH
        a[T + i] = a[T + i] if certain else 0.0
        uncertain += 0 if certain else 1
    if uncertain > 0:
        contact_values(a)
    running = 1
    while running > 0:
        running = 0
        for i in range(LANES):
            t = a[T + i]
            mode = a[MODE + i]
            f = a[SIDE + i] * a[DEPTH + i]
            slope = a[SIDE + i] * a[DEPTH_SLOPE + i]
            curve = a[SIDE + i] * a[DEPTH_CURVE + i]
            fine = a[FINE + i]
            move = 0.0
            if mode == MARCH:
                ahead = safe_advance(f, -slope, a[BOUND + i])
                t, mode = march(t, f, slope <= 0.0, ahead, a[LENGTH + i], fine)
            elif mode == BRACKET:
                natural = a[NATURAL + i]
                bend = (curve + natural * natural * f) / slope
                first = swing(f, slope, natural)
                move, mode = close_in(a, i, t, f, first, bend, natural, fine)
                t += move
            elif mode == ENDING:
                mode = MISSED
            end_at(a, i, DEPTH, END_DEPTH, move, a[MODE + i] <= ENDING)
            running += go_on(a, i, mode, t, move)
        if running > 0:
            contact_values(a)
