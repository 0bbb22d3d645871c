"""Contact of curved elastic bodies after Hertz: F = (4/3) E* sqrt(R) q^(3/2).

F is the force and q the approach of the bodies. 1/E* is the sum of (1 - nu^2)/E over both bodies,
1/R the sum of both curvatures (K. L. Johnson, Contact Mechanics, 1985, sections 4.2 and 11.4).
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from impact_damper.model.bounds import names_arguments
from impact_damper.model.units import convert, optional, physical

# An elastic impact lasts DURATION q/v. q is the largest compression, and v the relative speed
# before the impact. DURATION is (4/5) sqrt(pi) Gamma(2/5)/Gamma(9/10).
DURATION = 2.9432752
# A material under a ball yields if p0, the pressure at the centre of the contact, is at least YIELD
# times the yield strength (Johnson, section 6.1, for Poisson's ratio nu = 0.3).
YIELD = 1.6
POISSON_RANGE = {"least": 0, "most": 0.5}
WALLS = "of the walls, if they are of another material"


class Impact(NamedTuple):
    """An elastic impact: largest compression (m), largest force (N) and duration (s)."""

    compression: float
    force: float
    duration: float


@names_arguments
@dataclass(frozen=True)
class HertzContact:
    """Contact of the loose mass (a ball or a body with a rounded face) with the walls of its gap.

    Each value is a number in the SI unit, text with units, or a quantity of pint. For curved walls
    1/radius is the sum of the curvatures of loose mass and wall.

    Raises
    ------
    TypeError, ValueError
        If a value is missing or out of range, or has a wrong type or unit.

    Examples
    --------
    >>> import impact_damper as idm
    >>> steel = idm.HertzContact("20 mm", "210 GPa", 0.3)
    >>> f"{steel.pressure(500.0):.3g} Pa, {steel.stiffness(speed=0.3, mass=0.57):.3g} N/m"
    '1.48e+09 Pa, 8.6e+07 N/m'
    """

    radius: float = physical(
        "displacement",
        "radius of the loose mass where it touches (without it no pressure is computed)",
        above=0,
    )
    youngs_modulus: float = physical("pressure", "Young's modulus of the loose mass", above=0)
    poissons_ratio: float = physical("number", "Poisson's ratio of the loose mass", **POISSON_RANGE)
    yield_strength: float | None = optional(
        "pressure", "yield strength in tension (without it yielding is not judged)", above=0
    )
    wall_youngs_modulus: float | None = optional("pressure", f"Young's modulus {WALLS}", above=0)
    wall_poissons_ratio: float | None = optional(
        "number", f"Poisson's ratio {WALLS}", **POISSON_RANGE
    )
    wall_yield_strength: float | None = optional("pressure", f"yield strength {WALLS}", above=0)

    def __post_init__(self):
        convert(self)
        if self.wall_youngs_modulus is None:
            for name in ("youngs_modulus", "poissons_ratio", "yield_strength"):
                object.__setattr__(self, f"wall_{name}", getattr(self, name))
        elif self.wall_poissons_ratio is None:
            raise ValueError("wall_poissons_ratio: must be given with wall_youngs_modulus")

    @property
    def modulus(self) -> float:
        """Effective modulus E* (Pa): 1/E* is the sum of (1 - nu^2)/E over loose mass and wall."""
        loose = (1 - self.poissons_ratio**2) / self.youngs_modulus
        return 1 / (loose + (1 - self.wall_poissons_ratio**2) / self.wall_youngs_modulus)

    @property
    def coefficient(self) -> float:
        """Coefficient K (N/m^1.5) of the force K q^(3/2) at the compression q."""
        return 4 / 3 * self.radius**0.5 * self.modulus

    def pressure(self, force) -> float:
        """Return the pressure p0 (Pa) in the centre of the contact (Johnson, equation 4.24)."""
        return (6 * force * self.modulus**2 / (math.pi**3 * self.radius**2)) ** (1 / 3)

    def yields(self, pressure) -> str:
        """Return whether the loose mass or a wall yields at a pressure: "yes", "no", "unknown"."""
        strengths = [self.yield_strength, self.wall_yield_strength]
        if any(each is not None and pressure >= YIELD * each for each in strengths):
            return "yes"
        return "unknown" if None in strengths else "no"

    def compression(self, speed, mass) -> float:
        """Return the largest compression q (m) of an elastic impact: (2/5) K q^(5/2) = m v^2/2.

        K is `coefficient`, v (m/s) the relative speed, m (kg) the reduced mass m1 m2/(m1 + m2).
        """
        return (5 * mass * speed**2 / (4 * self.coefficient)) ** 0.4

    def impact(self, speed, mass) -> Impact:
        """Return the `Impact` at a relative speed (m/s). `mass` is the reduced mass (kg)."""
        q = self.compression(speed, mass)
        return Impact(q, self.coefficient * q**1.5, DURATION * q / speed)

    def stiffness(self, speed, mass) -> float:
        """Return the stiffness k (N/m) of a linear spring that could replace the contact.

        An impact of the reduced mass m at the relative speed v compresses spring and contact by the
        same q: k q^2 = m v^2. The spring's largest force is 4/5 of the contact's largest force.
        """
        return 0.8 * self.coefficient * self.compression(speed, mass) ** 0.5
