"""The forcing at the beginning of a step.

This file is a template, as `step` is, and is compiled in one module with it.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import kernel_only
from impact_damper.kernel.equation import forcing_amplitude

LANES: int

# A quarter turn in two parts, the first short enough for exact multiples of it.
QUARTER = 1.5707963267341256
QUARTER_REST = 6.077100506506192e-11
# Angle by which a forcing known for a time close by is turned, by four terms of its series.
NEAR = 1e-4


@kernel_only
def find_forcing(a):
    """COSINE and SINE of the forcing phase at KNOWN, times the amplitude of the forcing.

    By their series within an eighth of a turn.
    """
    for i in range(LANES):
        angle = a[FREQUENCY + i] * a[KNOWN + i]
        turns = np.floor(angle * (2.0 / math.pi) + 0.5)
        a[TURNS + i] = turns
        a[ANGLE + i] = (angle - turns * QUARTER) - turns * QUARTER_REST
    circular_series(a)
    for i in range(LANES):
        t = a[ANGLE + i]
        u = t * t
        c = 1.0 + u * a[COSINE + i]
        s = t + t * u * a[SINE + i]
        half = 0.5 * a[TURNS + i]
        odd = half != np.floor(half)
        half = 0.5 * np.floor(half)
        amplitude = forcing_amplitude(a, i, LANES)
        signed = amplitude if half == np.floor(half) else -amplitude
        a[COSINE + i] = signed * (-s if odd else c)
        a[SINE + i] = signed * (c if odd else s)


@kernel_only
def forcing(a):
    """COSINE and SINE of the forcing phase at TIME, times the amplitude of the forcing.

    A trajectory alone, which has looked ahead, may know them, or those of a time close by.
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


@kernel_only
def look_ahead(a):
    """For one trajectory, which would wait for it, the forcing at T, where the step may end."""
    if LANES == 1:
        a[KNOWN] = a[TIME] + a[T]
        find_forcing(a)
