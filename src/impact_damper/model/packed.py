"""The array `p` of dimensionless parameters that kernels (compiled functions) read."""

import numpy as np

from impact_damper.model.bounds import MOST_STIFF, check_frequency, shown
from impact_damper.model.exit_rules import NO_TENSION
from impact_damper.model.parameters import NONLINEAR, Oscillator, check_damper, parameters_in
from impact_damper.model.text import number

# Names of the packed parameters, in order. FREQUENCY is W. STIFFNESS is omega_l^2. DASHPOT is the
# coefficient of the walls' dashpot. FRICTION is per unit of loose mass. LAG is the time DASHPOT /
# CONTACT_STIFFNESS if the walls never pull. If the walls may pull, LAG is 0.
FIELDS = [each.name for each in parameters_in(Oscillator)]
NAMES = (
    "FREQUENCY",
    *("STIFFNESS" if name == "linear_frequency" else name.upper() for name in FIELDS),
    "CLEARANCE",
    "CONTACT_STIFFNESS",
    "INVERSE_MASS_RATIO",
    "DASHPOT",
    "LAG",
    "GRAVITY",
    "FRICTION",
)
COUNT = len(NAMES)
FREQUENCY, DAMPING, STIFFNESS, CUBIC, FORCE, UNBALANCE, BASE = range(COUNT - 7)
CLEARANCE, CONTACT_STIFFNESS, INVERSE_MASS_RATIO, DASHPOT = range(COUNT - 7, COUNT - 3)
LAG, GRAVITY, FRICTION = range(COUNT - 3, COUNT)


def pack(oscillator, damper, frequency) -> np.ndarray:
    """Return the parameters as the array that kernels read, shape (COUNT,).

    Without a damper (None) the clearance is infinite and the damper's other parameters are 0. Raise
    TypeError if an argument has the wrong type. Raise ValueError if W is out of range, or if the
    natural frequency of the contact exceeds MOST_STIFF times W.
    """
    p = np.zeros(COUNT)
    p[FREQUENCY] = frequency = check_frequency(frequency)
    if not isinstance(oscillator, Oscillator):
        raise TypeError(f"oscillator = {shown(oscillator)}: must be an Oscillator")
    p[1 : 1 + len(FIELDS)] = [getattr(oscillator, name) for name in FIELDS]
    p[STIFFNESS] = oscillator.linear_frequency**2
    if damper is None:
        p[CLEARANCE] = np.inf
        return p
    check_damper(damper)
    if damper.contact_frequency > MOST_STIFF * frequency:
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
    p[LAG] = p[DASHPOT] / p[CONTACT_STIFFNESS] if damper.exit_rule == NO_TENSION else 0.0
    p[GRAVITY] = damper.gravity
    p[FRICTION] = damper.friction
    return p


def cubic_spring(p) -> tuple:
    """Return omega_l^2 and k3. Raise ValueError if the spring has other nonlinear terms."""
    for name in NONLINEAR:
        value = p[NAMES.index(name.upper())]
        if value and name != "cubic":
            raise ValueError(f"{name} = {number(value)}: must be 0 in closed forms (cubic springs)")
    return p[STIFFNESS], p[CUBIC]
