"""Parameters packed into the array that kernels read.

Kernels (compiled functions) take the parameters as an array `p` of COUNT numbers, made by `pack`,
and read each by the name of its index, as in `p[FREQUENCY]`. The numbers are W, h, omega_l^2, k3,
F, U, V, d0, r1, 1/rm (see `parameters`) and the dashpot's coefficient 2 zeta_c sqrt(r1 rm), in the
order of NAMES. `design_slopes` is the derivative of `pack`.
"""

import math

import numpy as np

from impact_damper.system.bounds import MOST_STIFF
from impact_damper.system.checks import check_frequency
from impact_damper.system.parameters import check_damper, check_oscillator

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
# Parameters by which `design_slopes` differentiates; linear_stiffness is omega_l^2. Those in SIMPLE
# are numbers of the array themselves.
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
    """Return the parameters as the array that kernels read; `damper=None` for no damper.

    Returns
    -------
    numpy.ndarray, shape (COUNT,)
        Each parameter at the index of its name. Without a damper the clearance is infinite and the
        contact's parameters are 0.

    Raises
    ------
    TypeError
        If an argument is not of its type.
    ValueError
        If the frequency is out of range, or the natural frequency of the contact too high for it.
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
        raise ValueError(
            f"contact_stiffness = {damper.contact_stiffness:g}: with mass_ratio = "
            f"{damper.mass_ratio:g} and frequency = {frequency:g}: must be so small that the "
            f"contact is at most {MOST_STIFF:g} times as fast as the forcing (steps of a contact)"
        )
    p[CLEARANCE] = damper.clearance
    p[CONTACT_STIFFNESS] = damper.contact_stiffness
    p[INVERSE_MASS_RATIO] = 1 / damper.mass_ratio
    p[DASHPOT] = damper.dashpot
    return p


def design_slopes(p) -> np.ndarray:
    """Return the derivative of packed parameters by the parameters DESIGN.

    Parameters
    ----------
    p : array, shape (COUNT,)
        Packed parameters.

    Returns
    -------
    numpy.ndarray, shape (COUNT, len(DESIGN))
        The last three columns, of the contact, are 0 without a damper.
    """
    slopes = np.zeros((COUNT, len(DESIGN)))
    for column, index in enumerate(SIMPLE.values()):
        slopes[index, column] = 1.0
    if not np.isfinite(p[CLEARANCE]):
        return slopes
    mass_ratio, stiffness = 1 / p[INVERSE_MASS_RATIO], p[CONTACT_STIFFNESS]
    # The dashpot is `most` times s, with s = -ln e/(pi^2 + ln^2 e)^(1/2).
    most = 2 * math.sqrt(stiffness * mass_ratio / (1 + mass_ratio))
    share = p[DASHPOT] / most
    rest = 1 - share**2
    restitution = math.exp(-math.pi * share / math.sqrt(rest))
    slopes[DASHPOT, -3] = -most * rest**1.5 / (math.pi * restitution)
    slopes[CONTACT_STIFFNESS, -2] = 1.0
    slopes[DASHPOT, -2] = p[DASHPOT] / (2 * stiffness)
    slopes[INVERSE_MASS_RATIO, -1] = -1 / mass_ratio**2
    slopes[DASHPOT, -1] = p[DASHPOT] / (2 * mass_ratio * (1 + mass_ratio))
    return slopes
