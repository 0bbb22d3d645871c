"""Contact of curved elastic bodies after Hertz: F = (4/3) E* sqrt(R) q^(3/2).

Here q is the approach of the bodies, 1/E* the sum of (1 - nu^2)/E over both bodies, and 1/R the sum
of their curvatures (K. L. Johnson, Contact Mechanics, 1985, sections 4.2 and 11.4).
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from impact_damper.model.bounds import shown
from impact_damper.model.names import names_arguments
from impact_damper.model.units import convert, physical


@names_arguments
@dataclass(frozen=True)
class Material:
    """An elastic material.

    Attributes
    ----------
    youngs_modulus : float
        E, Pa; given as a number, text with units or quantity of pint.
    poissons_ratio : float
        nu, from 0 to 0.5.
    yield_strength : float or None
        Y in tension, Pa; None if it is not known.

    Raises
    ------
    TypeError, ValueError
        If a value is out of range.

    Examples
    --------
    >>> Material("210 GPa", 0.3).youngs_modulus
    210000000000.0
    """

    youngs_modulus: float = physical("pressure", above=0)
    poissons_ratio: float = physical("number", least=0, most=0.5)
    yield_strength: float | None = physical("pressure", above=0, default=None)

    def __post_init__(self):
        convert(self)


class Impact(NamedTuple):
    """An elastic impact of two bodies by Hertz's law.

    Attributes
    ----------
    compression : float
        Largest approach of the bodies, m.
    force : float
        Largest force, N.
    duration : float
        s.
    stiffness : float
        Stiffness of the linear spring that is compressed as far in this impact, N/m.
    """

    compression: float
    force: float
    duration: float
    stiffness: float


# Duration of an impact, in units of the largest compression divided by the speed:
# (4/5) sqrt(pi) Gamma(2/5)/Gamma(9/10).
DURATION = 2.9432752
# Pressure p0 of a ball at which a material begins to yield, in units of its yield strength, for
# nu = 0.3 (Johnson, section 6.1).
YIELD = 1.6


@names_arguments
@dataclass(frozen=True)
class HertzContact:
    """Contact of a loose mass that is a ball, or has a rounded face, with the walls of its gap.

    Attributes
    ----------
    radius : float
        Radius R of the loose mass where it touches the wall, m. If the wall is curved too, 1/R is
        the sum of the curvatures.
    loose, wall : Material
        Materials of the loose mass and of the walls; `wall` is `loose` if it is not given.

    Raises
    ------
    TypeError, ValueError
        If a value is not of its kind or out of range.

    Examples
    --------
    >>> import impact_damper as idm
    >>> contact = idm.HertzContact("20 mm", idm.Material("210 GPa", 0.3))
    >>> f"{contact.pressure(500.0):.3g}"
    '1.48e+09'
    """

    radius: float = physical("displacement", above=0)
    loose: Material
    wall: Material | None = None

    def __post_init__(self):
        convert(self)
        if self.wall is None:
            object.__setattr__(self, "wall", self.loose)
        for name in ("loose", "wall"):
            if not isinstance(getattr(self, name), Material):
                raise TypeError(f"{name} = {shown(getattr(self, name))}: must be a Material")

    @classmethod
    def of_ball(cls, radius, **material):
        """Return the contact of a ball and walls of one material, with arguments of `Material`."""
        return cls(radius, Material(**material))

    @property
    def modulus(self) -> float:
        """Effective modulus E*, Pa."""
        compliances = [
            (1 - each.poissons_ratio**2) / each.youngs_modulus for each in (self.loose, self.wall)
        ]
        return 1 / sum(compliances)

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

        Returns
        -------
        str
            "yes" if p0 is at least YIELD times the yield strength of one material. Otherwise
            "unknown" if a yield strength is not given, and "no" if both are.
        """
        strengths = [each.yield_strength for each in (self.loose, self.wall)]
        if any(each is not None and pressure >= YIELD * each for each in strengths):
            return "yes"
        return "unknown" if None in strengths else "no"

    def impact(self, speed, mass) -> Impact:
        """Return the elastic impact of two bodies.

        At the largest compression q the elastic energy (2/5) K q^(5/2) equals the kinetic energy
        mass speed^2/2. A linear spring of the stiffness (4/5) K sqrt(q) stores the same energy at
        the same compression. Its largest force is 4/5 of Hertz's, and the impact lasts 6.7 %
        longer.

        Parameters
        ----------
        speed : float
            Relative speed before the impact, m/s, above 0.
        mass : float
            Effective mass m1 m2/(m1 + m2), kg.
        """
        k = self.coefficient
        q = (5 * mass * speed**2 / (4 * k)) ** 0.4
        return Impact(q, k * q**1.5, DURATION * q / speed, 0.8 * k * q**0.5)
