"""Parameters packed into the array that kernels read.

Kernels (compiled functions) take the parameters as an array `p` of COUNT dimensionless numbers,
which `pack` returns. They read each number by the name of its index, for example `p[FREQUENCY]`.
The numbers are W, h, omega_l^2, k3, F, U, V, d0, r1, 1/rm (see `parameters`) and the coefficient
2 zeta_c sqrt(r1 rm) of the dashpot, in the order of NAMES. `design_slopes` returns the derivatives
of these numbers with respect to the parameters of a design.
"""

import math

import numpy as np

from impact_damper.model.bounds import MOST_STIFF, check_frequency
from impact_damper.model.parameters import check_damper, check_oscillator
from impact_damper.model.text import number

NAMES = (
    "FREQUENCY",
    "DAMPING",
    "STIFFNESS",
    "CUBIC",
    "FORCE",
    "UNBALANCE",
    "SHAKER",
    "CLEARANCE",
    "CONTACT_STIFFNESS",
    "INVERSE_MASS_RATIO",
    "DASHPOT",
)
COUNT = len(NAMES)
(
    FREQUENCY,
    DAMPING,
    STIFFNESS,
    CUBIC,
    FORCE,
    UNBALANCE,
    SHAKER,
    CLEARANCE,
    CONTACT_STIFFNESS,
    INVERSE_MASS_RATIO,
    DASHPOT,
) = range(COUNT)
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
    """Return the parameters as the array that kernels read.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
        None for an oscillator without damper.
    frequency : float
        Forcing frequency W, dimensionless.

    Returns
    -------
    numpy.ndarray, shape (COUNT,)
        Each parameter at the index of its name. Without a damper the clearance is infinite and the
        contact's parameters are 0.

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If the frequency is out of range, or if the natural frequency of the contact is more than
        MOST_STIFF times the forcing frequency.
    """
    p = np.zeros(COUNT)
    p[FREQUENCY] = frequency = check_frequency(frequency)
    check_oscillator(oscillator)
    p[DAMPING] = oscillator.damping
    p[STIFFNESS] = oscillator.linear_frequency**2
    p[CUBIC] = oscillator.cubic
    p[FORCE] = oscillator.force
    p[UNBALANCE] = oscillator.unbalance
    p[SHAKER] = oscillator.shaker
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
    """Return omega_l^2 and k3, for closed forms that contain only these two terms of the spring."""
    return p[STIFFNESS], p[CUBIC]


def design_slopes(p) -> np.ndarray:
    """Return the derivatives of packed parameters with respect to the parameters DESIGN.

    Parameters
    ----------
    p : array, shape (COUNT,)
        Packed parameters.

    Returns
    -------
    numpy.ndarray, shape (COUNT, len(DESIGN))
        One column for each parameter. Without a damper the last three columns, for the parameters
        of the contact, are 0.
    """
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
