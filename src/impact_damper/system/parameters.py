"""Dataclasses of the oscillator and of the damper, and their parameters packed for kernels.

Everything is dimensionless, scaled as in section 2.1 of Chatterjee, Mallik and
Ghosh (1995): lengths by x0 = (F/k1)^(1/3), times by 1/w0 = sqrt(m1/(k1 x0^2)).
"""

import math
from dataclasses import dataclass, fields

import numpy as np

from impact_damper.system import packed
from impact_damper.system.bounds import (
    CLEARANCE_RANGE,
    DAMPING_RANGE,
    LINEAR_FREQUENCY_RANGE,
    MASS_RATIO_RANGE,
    MOST_STIFF,
    RESTITUTION_RANGE,
    STIFFNESS_RANGE,
    check_parameters,
    parameter,
    shown,
)
from impact_damper.system.checks import check_frequency


def check_oscillator(oscillator):
    """Raise TypeError if `oscillator` is not an Oscillator."""
    if not isinstance(oscillator, Oscillator):
        raise TypeError(f"oscillator = {shown(oscillator)}: must be an Oscillator")


def check_damper(damper):
    """Raise TypeError if `damper` is not a Damper, where None would have no meaning."""
    if not isinstance(damper, Damper):
        raise TypeError(f"damper = {shown(damper)}: must be a Damper")


@dataclass(frozen=True)
class Oscillator:
    """Harmonically forced hard Duffing oscillator, equation (3) without the damper.

    Attributes
    ----------
    damping : float
        h = c1/(m1 w0), dimensionless.
    linear_frequency : float
        omega_l = sqrt(kl/(m1 w0^2)), dimensionless; 0 for a purely cubic spring.

    Raises
    ------
    TypeError, ValueError
        If a value is not a number or out of range.
    """

    damping: float = parameter(DAMPING_RANGE, "h, damping")
    linear_frequency: float = parameter(
        LINEAR_FREQUENCY_RANGE, "omega_l, 0 for a purely cubic spring", default=0.0
    )

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class Damper:
    """Loose mass in a gap, with spring and dashpot at its walls (figures 1 and 9).

    Attributes
    ----------
    mass_ratio : float
        r_m = m2/m1, dimensionless.
    clearance : float
        d0 = d/(2 x0), half the free space, dimensionless.
    restitution : float
        Coefficient of restitution e (xi in the paper), 1 for elastic contact.
    contact_stiffness : float
        r1 = k2/(m1 w0^2), dimensionless; 2000 throughout the paper.

    Raises
    ------
    TypeError, ValueError
        If a value is not a number or out of range.
    """

    mass_ratio: float = parameter(MASS_RATIO_RANGE, "rm, loose mass over primary mass")
    clearance: float = parameter(CLEARANCE_RANGE, "d0, half the free space")
    restitution: float = parameter(RESTITUTION_RANGE, "e, 1 for elastic contact", default=1.0)
    contact_stiffness: float = parameter(
        STIFFNESS_RANGE, "r1, stiffness of the contact springs", default=2000.0
    )

    def __post_init__(self):
        check_parameters(self)

    @property
    def contact_damping(self) -> float:
        """Damping ratio of the contact zeta_c for this restitution, equation (25)."""
        logarithm = math.log(self.restitution)
        return -logarithm / math.sqrt((1 + self.mass_ratio) * (math.pi**2 + logarithm**2))

    @property
    def dashpot(self) -> float:
        """Dashpot coefficient 2 zeta_c sqrt(r1 rm) of equation (22)."""
        return 2 * self.contact_damping * math.sqrt(self.contact_stiffness * self.mass_ratio)


def pack(oscillator, damper, frequency) -> np.ndarray:
    """Return the parameters as the array that kernels read; `damper=None` for no damper.

    Returns
    -------
    numpy.ndarray, shape (packed.COUNT,)
        In the places that `packed` names. Without a damper the clearance is infinite and the
        contact's parameters are 0.

    Raises
    ------
    TypeError
        If an argument is not of its type.
    ValueError
        If the frequency is out of range, or the contact too fast for it.
    """
    p = np.zeros(packed.COUNT)
    p[packed.FREQUENCY] = frequency = check_frequency(frequency)
    check_oscillator(oscillator)
    p[packed.DAMPING] = oscillator.damping
    p[packed.STIFFNESS] = oscillator.linear_frequency**2
    if damper is None:
        p[packed.CLEARANCE] = np.inf
        return p
    check_damper(damper)
    natural = math.sqrt(damper.contact_stiffness * (1 + 1 / damper.mass_ratio))
    if natural > MOST_STIFF * frequency:
        raise ValueError(
            f"contact_stiffness = {damper.contact_stiffness:g}: with mass_ratio = "
            f"{damper.mass_ratio:g} and frequency = {frequency:g}: must be so small that the "
            f"contact is at most {MOST_STIFF:g} times as fast as the forcing (steps of a contact)"
        )
    p[packed.CLEARANCE] = damper.clearance
    p[packed.CONTACT_STIFFNESS] = damper.contact_stiffness
    p[packed.INVERSE_MASS_RATIO] = 1 / damper.mass_ratio
    p[packed.DASHPOT] = damper.dashpot
    return p


def describe(*parts) -> dict:
    """Return the fields of dataclasses as one dictionary of numbers; None has no fields."""
    return {
        field.name: getattr(part, field.name)
        for part in parts
        if part is not None
        for field in fields(part)
    }
