"""Contact of curved elastic bodies after Hertz: F = (4/3) E* sqrt(R) q^(3/2).

Here q is the approach of the bodies, 1/E* the sum of (1 - nu^2)/E over both bodies, and 1/R the sum
of their curvatures (K. L. Johnson, Contact Mechanics, 1985, sections 4.2 and 11.4).
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from impact_damper.model.bounds import names_arguments
from impact_damper.model.units import convert, physical

# Duration of an impact, in units of the largest compression divided by the speed:
# (4/5) sqrt(pi) Gamma(2/5)/Gamma(9/10).
DURATION = 2.9432752
# Pressure p0 of a ball at which a material begins to yield, in units of its yield strength, for
# nu = 0.3 (Johnson, section 6.1).
YIELD = 1.6
POISSON_RANGE = {"least": 0, "most": 0.5}


class Impact(NamedTuple):
    """Largest compression (m) and force (N) of an elastic impact, and its duration (s)."""

    compression: float
    force: float
    duration: float


@names_arguments
@dataclass(frozen=True)
class HertzContact:
    """Contact of a loose mass that is a ball, or has a rounded face, with the walls of its gap.

    Each value is a number in the SI unit, text with units, or a quantity of pint.

    Attributes
    ----------
    radius : float
        Radius R of the loose mass where it touches the wall, m. If the wall is curved too, 1/R is
        the sum of the curvatures.
    youngs_modulus : float
        E of the loose mass, Pa.
    poissons_ratio : float
        nu of the loose mass, from 0 to 0.5.
    yield_strength : float or None
        Yield strength of the loose mass in tension, Pa; None if it is not known.
    wall_youngs_modulus, wall_poissons_ratio, wall_yield_strength : float or None
        The same for walls of another material, with at least the first two.

    Raises
    ------
    TypeError, ValueError
        If a value is not of its kind or out of range.

    Examples
    --------
    >>> import impact_damper as idm
    >>> steel = idm.HertzContact("20 mm", "210 GPa", 0.3)
    >>> f"{steel.pressure(500.0):.3g} Pa, {steel.stiffness(speed=0.3, mass=0.57):.3g} N/m"
    '1.48e+09 Pa, 8.6e+07 N/m'
    """

    radius: float = physical("displacement", above=0)
    youngs_modulus: float = physical("pressure", above=0)
    poissons_ratio: float = physical("number", **POISSON_RANGE)
    yield_strength: float | None = physical("pressure", above=0, default=None)
    wall_youngs_modulus: float | None = physical("pressure", above=0, default=None)
    wall_poissons_ratio: float | None = physical("number", **POISSON_RANGE, default=None)
    wall_yield_strength: float | None = physical("pressure", above=0, default=None)

    def __post_init__(self):
        convert(self)
        if self.wall_youngs_modulus is None:
            for name in ("youngs_modulus", "poissons_ratio", "yield_strength"):
                object.__setattr__(self, f"wall_{name}", getattr(self, name))
        elif self.wall_poissons_ratio is None:
            raise ValueError("wall_poissons_ratio: must be given with wall_youngs_modulus")

    @property
    def modulus(self) -> float:
        """Effective modulus E*, Pa."""
        loose = (1 - self.poissons_ratio**2) / self.youngs_modulus
        return 1 / (loose + (1 - self.wall_poissons_ratio**2) / self.wall_youngs_modulus)

    @property
    def coefficient(self) -> float:
        """Coefficient K of the force K q^(3/2), N/m^1.5."""
        return 4 / 3 * self.radius**0.5 * self.modulus

    def pressure(self, force) -> float:
        """Return the largest pressure p0 = (6 F E*^2/(pi^3 R^2))^(1/3), Pa, under a force F, N.

        From Johnson, equation 4.24. The mean pressure is 2/3 of p0.
        """
        return (6 * force * self.modulus**2 / (math.pi**3 * self.radius**2)) ** (1 / 3)

    def yields(self, pressure) -> str:
        """Return whether the loose mass or the wall yields at a largest pressure p0, Pa.

        "yes" if p0 is at least YIELD times the yield strength of one of them. Otherwise "unknown"
        if a yield strength is not given, and "no" if both are.
        """
        strengths = [self.yield_strength, self.wall_yield_strength]
        if any(each is not None and pressure >= YIELD * each for each in strengths):
            return "yes"
        return "unknown" if None in strengths else "no"

    def compression(self, speed, mass) -> float:
        """Return the largest compression q of an elastic impact, m.

        At q the elastic energy (2/5) K q^(5/2) equals the kinetic energy mass speed^2/2. The speed
        (m/s) is the relative one before the impact, the mass (kg) the effective m1 m2/(m1 + m2).
        """
        return (5 * mass * speed**2 / (4 * self.coefficient)) ** 0.4

    def impact(self, speed, mass) -> Impact:
        """Return an elastic impact; the arguments are those of `compression`, the speed above 0."""
        q = self.compression(speed, mass)
        return Impact(q, self.coefficient * q**1.5, DURATION * q / speed)

    def stiffness(self, speed, mass) -> float:
        """Return the stiffness of the linear spring that is compressed as far in an impact, N/m.

        The spring stores the same energy. Its largest force is 4/5 of Hertz's, and the impact lasts
        6.7 % longer. The arguments are those of `compression`.
        """
        return 0.8 * self.coefficient * self.compression(speed, mass) ** 0.5
