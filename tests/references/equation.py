"""The equations of motion, (3), (4) and (20) to (24) of the paper, independent of the package.

p is the array of packed parameters. x, v are Z1, Z1', and z, w are Z2, Z2'. The functions take
numbers, arrays, or polynomials. SPRINGS has oscillators with every term of the equation.
"""

import math
from dataclasses import replace

from impact_damper.model.packed import (
    BASE,
    CLEARANCE,
    CONTACT_STIFFNESS,
    CUBIC,
    DAMPING,
    DASHPOT,
    FORCE,
    FREQUENCY,
    FRICTION,
    GRAVITY,
    INVERSE_MASS_RATIO,
    STIFFNESS,
    UNBALANCE,
)
from impact_damper.model.parameters import Oscillator

SPRINGS = {
    "linear": Oscillator(0.1, 1.3, cubic=0.0, force=0.7),
    "softening": Oscillator(0.05, 1.0, cubic=-0.5, force=0.04),
    "shaken": Oscillator(0.2, 0.8, cubic=0.3, force=0.4, unbalance=0.15),
    "unbalance": Oscillator(0.1, 1.0, cubic=0.02, force=0.0, unbalance=0.3),
    "soft and shaken": Oscillator(0.1, 1.0, cubic=-0.1, force=0.05, unbalance=0.05),
    "on a base": Oscillator(0.1, 1.2, cubic=0.1, force=0.1, unbalance=0.05, base=1.0),
    "hard": Oscillator(0.3, 0.0, cubic=20.0, force=5.0),
}


def amplitude(p):
    """Return the amplitude of the forcing."""
    return p[FORCE] + p[UNBALANCE] * p[FREQUENCY] ** 2


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


def rates(p, side=0, slide=1):
    """Return the function (t, y) -> y' of the state (Z1, Z1', Z2, Z2'), for SciPy.

    `side` is the wall in contact, or 0. `slide` is the sign of Z2', or 0 if the loose mass sticks.
    """

    def right(t, y):
        x, v, z, w = y
        cosine = math.cos(p[FREQUENCY] * t)
        free = flight(p, x, v, cosine)
        force = contact(p, side, z, w) if side else 0.0
        across = p[GRAVITY] - p[BASE] * amplitude(p) * cosine
        if slide == 0:
            return [v, free - (free + across) / (1 + p[INVERSE_MASS_RATIO]), 0.0, 0.0]
        rub = p[FRICTION] * slide
        own = free - force - rub / p[INVERSE_MASS_RATIO] if rub else free - force
        return [v, own, w, own + across - rub - p[INVERSE_MASS_RATIO] * force]

    return right


def has_closed_forms(oscillator):
    """Return whether the closed forms for one harmonic, with a damper, accept the oscillator."""
    try:
        return math.isfinite(oscillator.hardening) and not oscillator.base
    except ValueError:
        return False


# Oscillators that the closed forms for one harmonic accept.
KNOWN = {name: each for name, each in SPRINGS.items() if has_closed_forms(each)}


def in_other_units(oscillator, damper, frequency, length, time):
    """Return oscillator, damper and frequency in other units: the motion Z/length over T/time.

    The equation Z1'' + h Z1' + omega_l^2 Z1 + k3 Z1^3 = (F + U W^2) cos(W T) keeps its form. If
    both units are powers of two, the conversion is exact.
    """
    acceleration = length / time**2
    other = replace(
        oscillator,
        damping=oscillator.damping * time,
        linear_frequency=oscillator.linear_frequency * time,
        cubic=oscillator.cubic * (length * time) ** 2,
        force=oscillator.force / acceleration,
        unbalance=oscillator.unbalance / length,
    )
    if damper is not None:
        damper = replace(
            damper,
            clearance=damper.clearance / length,
            contact_stiffness=damper.contact_stiffness * time**2,
            gravity=damper.gravity / acceleration,
            friction=damper.friction / acceleration,
        )
    return other, damper, frequency * time
