"""Scales of length, time and mass between SI units and the dimensionless equations.

The equations of section 2.1 of Chatterjee, Mallik and Ghosh (1995) hold for any scales of length
and time. The scale of mass is the mass of the machine.
"""

import math
from typing import NamedTuple

from impact_damper.model.units import QUANTITIES


class Scales(NamedTuple):
    """Scales of a machine, in SI units.

    Attributes
    ----------
    length : float
        Length x0, m.
    time : float
        Time 1/w0, s.
    mass : float
        Mass m1 of the machine, kg.
    """

    length: float
    time: float
    mass: float

    def unit(self, quantity) -> float:
        """Return the SI value of the dimensionless 1 of a quantity.

        The dimensionless frequency W is angular; its value in Hz is W w0/(2 pi).

        Parameters
        ----------
        quantity : str
            A key of `units.QUANTITIES`.
        """
        each = QUANTITIES[quantity]
        value = self.length**each.length * self.time**each.time * self.mass**each.mass
        return value / (2 * math.pi) if quantity in ("frequency", "sweep_rate") else value

    def to_si(self, value, quantity):
        """Return the SI value of a dimensionless number or array."""
        return value * self.unit(quantity)

    def range_to_si(self, bounds, quantity) -> dict:
        """Return `least` and `most` of a dimensionless range in SI units."""
        return {end: self.to_si(bounds[end], quantity) for end in ("least", "most")}

    def from_si(self, value, quantity):
        """Return the dimensionless value of an SI number or array."""
        return value / self.unit(quantity)


def static_deflection(force, linear, cubic) -> float:
    """Return the deflection x > 0 at which linear x + |cubic| x^3 equals a force, all in SI units.

    The cubic equation has one real root, computed here in hyperbolic form.
    """
    cubic = abs(cubic)
    if cubic == 0:
        return force / linear
    if linear == 0:
        return (force / cubic) ** (1 / 3)
    length = math.sqrt(linear) / math.sqrt(3 * cubic)
    return 2 * length * math.sinh(math.asinh(1.5 * force / (linear * length)) / 3)
