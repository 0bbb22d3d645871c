"""Parameters packed into the array `p` of COUNT dimensionless numbers that kernels read."""

import math

import numpy as np

from impact_damper.model.bounds import MOST_STIFF, check_frequency
from impact_damper.model.parameters import (
    NONLINEAR,
    Oscillator,
    check_damper,
    check_oscillator,
    parameters_in,
)
from impact_damper.model.text import number

# W, the fields of `Oscillator` in their order, with omega_l^2 in place of omega_l, and then d0, r1,
# 1/rm and the coefficient 2 zeta_c sqrt(r1 rm) of the dashpot.
FIELDS = [each.name for each in parameters_in(Oscillator)]
NAMES = (
    "FREQUENCY",
    *("STIFFNESS" if name == "linear_frequency" else name.upper() for name in FIELDS),
    "CLEARANCE",
    "CONTACT_STIFFNESS",
    "INVERSE_MASS_RATIO",
    "DASHPOT",
)
COUNT = len(NAMES)
FREQUENCY, DAMPING, STIFFNESS, CUBIC, FORCE, UNBALANCE, SHAKER = range(COUNT - 4)
CLEARANCE, CONTACT_STIFFNESS, INVERSE_MASS_RATIO, DASHPOT = range(COUNT - 4, COUNT)
# DESIGN: parameters with respect to which `design_slopes` differentiates; linear_stiffness is
# omega_l^2. SIMPLE: the parameters among these that the array holds unchanged, each with its index.
SIMPLE = {
    "damping": DAMPING,
    "linear_stiffness": STIFFNESS,
    "cubic": CUBIC,
    "force": FORCE,
    "unbalance": UNBALANCE,
    "clearance": CLEARANCE,
    "frequency": FREQUENCY,
}
DESIGN = (*SIMPLE, "restitution", "contact_stiffness", "mass_ratio")


def pack(oscillator, damper, frequency) -> np.ndarray:
    """Return the parameters as the array that kernels read, shape (COUNT,).

    Without a damper (None) the clearance is infinite and the contact's parameters are 0. TypeError
    if an argument has the wrong type, ValueError if W is out of range, or the natural frequency of
    the contact exceeds MOST_STIFF W.
    """
    p = np.zeros(COUNT)
    p[FREQUENCY] = frequency = check_frequency(frequency)
    check_oscillator(oscillator)
    p[1 : 1 + len(FIELDS)] = [getattr(oscillator, name) for name in FIELDS]
    p[STIFFNESS] = oscillator.linear_frequency**2
    if damper is None:
        p[CLEARANCE] = np.inf
        return p
    check_damper(damper)
    natural = math.sqrt(damper.contact_stiffness * (1 + 1 / damper.mass_ratio))
    if natural > MOST_STIFF * frequency:
        told = oscillator.scales.told
        raise ValueError(
            f"{told('contact_stiffness', damper.contact_stiffness, 'stiffness')}: with "
            f"{told('mass_ratio', damper.mass_ratio, 'number')} and "
            f"{told('frequency', frequency, 'frequency')}: must be so small that the contact is at "
            f"most {number(MOST_STIFF)} times as fast as the forcing (otherwise a run takes too "
            "many steps)"
        )
    p[CLEARANCE] = damper.clearance
    p[CONTACT_STIFFNESS] = damper.contact_stiffness
    p[INVERSE_MASS_RATIO] = 1 / damper.mass_ratio
    p[DASHPOT] = damper.dashpot
    return p


def cubic_spring(p) -> tuple:
    """Return omega_l^2 and k3, for closed forms; other terms of the spring are refused."""
    for name in NONLINEAR:
        value = p[NAMES.index(name.upper())]
        if value and name != "cubic":
            raise ValueError(f"{name} = {number(value)}: must be 0 in closed forms (cubic springs)")
    return p[STIFFNESS], p[CUBIC]


def design_slopes(p) -> np.ndarray:
    """Return the derivatives of packed parameters by the parameters DESIGN, a column for each."""
    slopes = np.zeros((COUNT, len(DESIGN)))
    for column, index in enumerate(SIMPLE.values()):
        slopes[index, column] = 1.0
    if not np.isfinite(p[CLEARANCE]):
        return slopes
    mass_ratio, stiffness = 1 / p[INVERSE_MASS_RATIO], p[CONTACT_STIFFNESS]
    # The dashpot coefficient is `critical` times the damping ratio s of the relative motion,
    # s = -ln e/(pi^2 + ln^2 e)^(1/2).
    critical = 2 * math.sqrt(stiffness * mass_ratio / (1 + mass_ratio))
    ratio = p[DASHPOT] / critical
    rest = 1 - ratio**2
    restitution = math.exp(-math.pi * ratio / math.sqrt(rest))
    slopes[DASHPOT, -3] = -critical * rest**1.5 / (math.pi * restitution)
    slopes[CONTACT_STIFFNESS, -2] = 1.0
    slopes[DASHPOT, -2] = p[DASHPOT] / (2 * stiffness)
    slopes[INVERSE_MASS_RATIO, -1] = -1 / mass_ratio**2
    slopes[DASHPOT, -1] = p[DASHPOT] / (2 * mass_ratio * (1 + mass_ratio))
    return slopes
