"""The forcing at the beginning of a step.

This file is a template, as `step` is, and is compiled in one module with it.
"""

import math

import numpy as np

from impact_damper.accelerate import kernel

LANES: int

# A quarter turn in two parts, the first short enough for exact multiples of it.
QUARTER = 1.5707963267341256
QUARTER_REST = 6.077100506506192e-11
# Angle by which a forcing known for a time close by is turned, by four terms of its series.
NEAR = 1e-4
# Series of cosine and sine, without their first terms.
COSINES = tuple((-1.0) ** k / math.factorial(2 * k) for k in range(1, 9))
SINES = tuple((-1.0) ** k / math.factorial(2 * k + 1) for k in range(1, 9))


@kernel
def paired(c, u):
    """Polynomial of eight terms, added up pair by pair."""
    v = u * u
    low = (c[0] + c[1] * u) + (c[2] + c[3] * u) * v
    high = (c[4] + c[5] * u) + (c[6] + c[7] * u) * v
    return low + high * (v * v)


@kernel
def cosine_and_sine(angle):
    """Of an angle, by their series within an eighth of a turn."""
    turns = np.floor(angle * (2.0 / math.pi) + 0.5)
    t = (angle - turns * QUARTER) - turns * QUARTER_REST
    u = t * t
    c = paired(COSINES, u)
    s = paired(SINES, u)
    c = 1.0 + u * c
    s = t + t * u * s
    half = 0.5 * turns
    odd = half != np.floor(half)
    half = 0.5 * np.floor(half)
    sign = 1.0 if half == np.floor(half) else -1.0
    return sign * (-s if odd else c), sign * (c if odd else s)


@kernel
def forcing(a):
    """COSINE and SINE of the forcing phase at TIME."""
    if LANES == 1:
        known_forcing(a)
    else:
        for i in range(LANES):
            a[COSINE + i], a[SINE + i] = cosine_and_sine(a[FREQUENCY + i] * a[TIME + i])


@kernel
def known_forcing(a):
    """`forcing` of one trajectory, which has looked ahead."""
    if a[TIME] == a[KNOWN]:
        return
    t = a[FREQUENCY] * (a[TIME] - a[KNOWN])
    if abs(t) < NEAR:
        c, s = a[COSINE], a[SINE]
        u = t * t
        a[COSINE] = (c - t * s) - u * (0.5 * c - t * (s / 6.0))
        a[SINE] = (s + t * c) - u * (0.5 * s + t * (c / 6.0))
    else:
        a[COSINE], a[SINE] = cosine_and_sine(a[FREQUENCY] * a[TIME])


@kernel
def look_ahead(a):
    """For one trajectory, which would wait for it, the forcing at T, where the step may end."""
    if LANES == 1:
        a[KNOWN] = a[TIME] + a[T]
        a[COSINE], a[SINE] = cosine_and_sine(a[FREQUENCY] * a[KNOWN])
