"""The equations of motion, (3), (4) and (20) to (24) of the paper, independent of the package.

p is the array of packed parameters (`system.packed`). x, v are Z1, Z1', and z, w are Z2, Z2'. The
functions take numbers, arrays, or expressions of heyoka.py.
"""

import math

from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    CUBIC,
    DAMPING,
    DASHPOT,
    FORCE,
    FREQUENCY,
    INVERSE_MASS_RATIO,
    SHAKER,
    STIFFNESS,
    UNBALANCE,
)


def amplitude(p):
    """Return the amplitude of the forcing."""
    return p[FORCE] + p[UNBALANCE] * p[FREQUENCY] ** 2 + p[SHAKER] / p[FREQUENCY] ** 2


def spring(p, x):
    """Return the restoring force of the spring."""
    return p[STIFFNESS] * x + p[CUBIC] * x * x * x


def slope(p, x):
    """Return the derivative of `spring` with respect to x."""
    return p[STIFFNESS] + 3 * p[CUBIC] * x * x


def potential(p, x):
    """Return the energy stored in the spring."""
    return p[STIFFNESS] * x**2 / 2 + p[CUBIC] * x**4 / 4


def flight(p, x, v, cosine):
    """Return Z1'' without contact, with cosine = cos(W T)."""
    return amplitude(p) * cosine - p[DAMPING] * v - spring(p, x)


def contact(p, side, z, w):
    """Return the contact force of the wall `side`, -1 or 1; positive in the direction of Z2."""
    return p[CONTACT_STIFFNESS] * (z - side * p[CLEARANCE]) + p[DASHPOT] * w


def rates(p, side=0):
    """Return the function (t, y) -> y' of the state (Z1, Z1', Z2, Z2'), for SciPy.

    `side` is the wall in contact, or 0.
    """

    def right(t, y):
        x, v, z, w = y
        free = flight(p, x, v, math.cos(p[FREQUENCY] * t))
        force = contact(p, side, z, w) if side else 0.0
        return [v, free - force, w, free - force - p[INVERSE_MASS_RATIO] * force]

    return right
