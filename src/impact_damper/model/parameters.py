"""Dataclasses of the oscillator and of the damper.

All quantities are dimensionless, scaled as in section 2.1 of Chatterjee, Mallik and Ghosh (1995).
Lengths are scaled by x0 = (F/k1)^(1/3) and times by 1/w0 = sqrt(m1/(k1 x0^2)), with the amplitude F
of the force, the coefficient k1 of the cubic spring and the primary mass m1. Z1 is the displacement
of the primary mass, Z2 the displacement of the primary mass relative to the loose mass, W the
forcing frequency and T the time; primes are derivatives by T. zeta_c, also written zc, is the
damping ratio of the contact. This module imports no NumPy, because Snakemake reads it at every dry
run.
"""

import math
from dataclasses import dataclass, field, fields

from impact_damper.model.bounds import (
    AMPLITUDE_RANGE,
    CLEARANCE_RANGE,
    DAMPING_RANGE,
    MASS_RATIO_RANGE,
    RESTITUTION_RANGE,
    STIFFNESS_RANGE,
    check_parameters,
    names_arguments,
    parameter,
    shown,
)
from impact_damper.model.units import UNITLESS, Scales

# Fields of `Oscillator` that are 0 for a linear spring, and the highest power of Z1 in the force of
# the spring.
NONLINEAR = ("cubic",)
SPRING_POWER = 3


def _told(part, scales, name):
    """Return a parameter as "name = value", in the unit of the user."""
    facts = part.__dataclass_fields__[name].metadata
    shown_name = facts["machine"] or name if scales.si else name
    return scales.told(shown_name, getattr(part, name), facts["kind"])


def check_oscillator(oscillator):
    """Raise TypeError if `oscillator` is not an Oscillator."""
    if not isinstance(oscillator, Oscillator):
        raise TypeError(f"oscillator = {shown(oscillator)}: must be an Oscillator")


def check_damper(damper):
    """Raise TypeError if `damper` is not a Damper; None is not allowed either."""
    if not isinstance(damper, Damper):
        raise TypeError(f"damper = {shown(damper)}: must be a Damper")


@names_arguments
@dataclass(frozen=True)
class Oscillator:
    """Harmonically forced Duffing oscillator, equation (3) without the damper.

    The spring is hardening if `cubic` is positive, linear if it is 0 and softening if it is
    negative.

    Attributes
    ----------
    damping : float
        h = c1/(m1 w0), dimensionless.
    linear_frequency : float
        omega_l = sqrt(kl/(m1 w0^2)), dimensionless; 0 for a purely cubic spring.
    cubic : float
        Coefficient k3 of Z1^3 in the spring's force, dimensionless; 1 in the paper's scales.
    force : float
        Term F of the forcing amplitude F + U W^2 + V/W^2, dimensionless; 1 in the paper's scales.
        For an unforced decay F, U and V are 0.
    unbalance : float
        U, dimensionless. The term U W^2 of the forcing amplitude represents a rotating unbalance.
        Without a damper it may also represent a base that moves with the amplitude U, and Z1 is
        then the displacement relative to the base. With a damper use `machine.Machine` for a moving
        base, because the loose mass is then forced too.
    shaker : float
        V, dimensionless. The term V/W^2 of the forcing amplitude represents a base whose
        acceleration has the same amplitude a at each frequency, as on a shaker. Then V = omega_l^2
        a, and Z1 is the displacement in a frame at rest. Allowed only with a linear spring.

    scales : Scales
        Scales of the machine that the oscillator describes, in whose units errors are told; all 1
        by default.

    Raises
    ------
    TypeError, ValueError
        If a value is not a number or out of range, or if `shaker` is given with a cubic spring.

    Examples
    --------
    >>> oscillator = Oscillator(damping=0.215)
    >>> oscillator.linear_frequency, oscillator.cubic
    (0.0, 1.0)
    """

    damping: float = parameter(DAMPING_RANGE, "damping", "h", "damping")
    linear_frequency: float = parameter(
        {"least": 0.0, "most": 100.0},
        "frequency",
        "omega_l",
        "0 for a purely cubic spring",
        machine="natural_frequency",
        default=0.0,
    )
    cubic: float = parameter(
        {"least": -1e6, "most": 1e6},
        "cubic_stiffness",
        "k3",
        "coefficient of the cubic spring",
        machine="cubic_stiffness",
        default=1.0,
    )
    force: float = parameter(
        AMPLITUDE_RANGE, "force", "F", "amplitude of the external force", default=1.0
    )
    unbalance: float = parameter(
        AMPLITUDE_RANGE, "unbalance", "U", "adds U W^2 to the amplitude of the force", default=0.0
    )
    shaker: float = parameter(
        AMPLITUDE_RANGE, "shaker", "V", "adds V/W^2 to the amplitude of the force", default=0.0
    )
    scales: Scales = field(default=UNITLESS, repr=False, compare=False, kw_only=True)

    def __post_init__(self):
        check_parameters(self)
        if self.shaker:
            self.check_linear(
                f"with {self.told('shaker')} (on a moving base the force of a nonlinear spring "
                "is not harmonic)"
            )

    def check_linear(self, why):
        """Raise ValueError if the spring is not linear; `why` ends the message."""
        for name in NONLINEAR:
            if getattr(self, name) != 0:
                raise ValueError(f"{self.told(name)}: must be 0 {why}")

    def told(self, *names) -> str:
        """Return fields as "name = value" in the unit of the user, with the names of `Machine`."""
        return ", ".join(_told(self, self.scales, name) for name in names)

    @property
    def is_linear(self) -> bool:
        """Whether the spring is linear."""
        return not any(getattr(self, name) for name in NONLINEAR)

    @property
    def softens(self) -> bool:
        """Whether the spring pushes outward at large |Z1|, so that a motion may escape."""
        return self.cubic < 0

    @property
    def hardening(self) -> float:
        """Coefficient of a^3 in the first harmonic of the spring's force under Z1 = a cos t."""
        return 0.75 * self.cubic

    def nonlinear_force(self, displacement):
        """Return the force of the spring without its linear part, at displacements Z1."""
        return self.cubic * displacement**3

    def nonlinear_slope(self, displacement):
        """Return the derivative of `nonlinear_force` with respect to Z1."""
        return 3 * self.cubic * displacement**2

    def forcing_amplitude(self, frequency):
        """Return the amplitude F + U W^2 + V/W^2 of the force at forcing frequencies W."""
        return self.force + self.unbalance * frequency**2 + self.shaker / frequency**2


@names_arguments
@dataclass(frozen=True)
class Damper:
    """Loose mass in a gap whose walls have a spring and a dashpot (figures 1 and 9 of the paper).

    Attributes
    ----------
    mass_ratio : float
        r_m = m2/m1, dimensionless.
    clearance : float
        d0 = d/(2 x0), half of the gap d, dimensionless.
    restitution : float
        Coefficient of restitution e (xi in the paper), dimensionless; 1 for elastic contact.
    contact_stiffness : float
        r1 = k2/(m1 w0^2), dimensionless; 2000 throughout the paper.

    Raises
    ------
    TypeError, ValueError
        If a value is not a number or out of range.

    Examples
    --------
    >>> Damper(mass_ratio=0.12, clearance=2.0)
    Damper(mass_ratio=0.12, clearance=2.0, restitution=1.0, contact_stiffness=2000.0)
    """

    mass_ratio: float = parameter(
        MASS_RATIO_RANGE, "mass", "rm", "loose mass over primary mass", machine="mass"
    )
    clearance: float = parameter(
        CLEARANCE_RANGE,
        "clearance",
        "d0",
        "half of the gap of the loose mass",
        machine="clearance_each_side",
    )
    restitution: float = parameter(
        RESTITUTION_RANGE, "number", "e", "1 for elastic contact", default=1.0
    )
    contact_stiffness: float = parameter(
        STIFFNESS_RANGE, "stiffness", "r1", "stiffness of the contact springs", default=2000.0
    )

    def __post_init__(self):
        check_parameters(self)

    @property
    def contact_damping(self) -> float:
        """Damping ratio zeta_c of the contact for this restitution, equation (25)."""
        logarithm = math.log(self.restitution)
        return -logarithm / math.sqrt((1 + self.mass_ratio) * (math.pi**2 + logarithm**2))

    @property
    def dashpot(self) -> float:
        """Dashpot coefficient 2 zeta_c sqrt(r1 rm) of equation (22)."""
        return 2 * self.contact_damping * math.sqrt(self.contact_stiffness * self.mass_ratio)


def parameters_in(part) -> list:
    """Return the fields of a dataclass, or of its instance, that hold parameters."""
    return [each for each in fields(part) if each.type is not Scales]


# Symbol of each parameter by the parameter's name. Tables and captions print the symbols.
SYMBOLS = {
    each.name: each.metadata["symbol"]
    for part in (Oscillator, Damper)
    for each in parameters_in(part)
} | {"frequency": "W"}


def describe(*parts) -> dict:
    """Return the parameters in several dataclasses as one dictionary; a part None has none."""
    return {
        each.name: getattr(part, each.name)
        for part in parts
        if part is not None
        for each in parameters_in(part)
    }


def pick(kind, values) -> dict:
    """Return those entries of `values` whose keys are parameters of the dataclass `kind`."""
    return {each.name: values[each.name] for each in parameters_in(kind) if each.name in values}
