"""Scales of length, time and mass, in which the equations are dimensionless.

The equations of section 2.1 of Chatterjee, Mallik and Ghosh (1995) hold for any scales of length
and time. The scale of mass is the mass of the machine. This module imports no NumPy, because
Snakemake reads it at every dry run.
"""

import math
from typing import NamedTuple

from impact_damper.model.bounds import check_number
from impact_damper.model.text import number, with_unit
from impact_damper.model.units import QUANTITIES, check_si


class Scales(NamedTuple):
    """Scales of a machine, in SI units; all are 1 for an `Oscillator`.

    Attributes
    ----------
    length : float
        Length x0, m.
    time : float
        Time 1/w0, s.
    mass : float
        Mass m1 of the machine, kg.
    si : bool
        Whether users give values, and read errors and results, in SI units.
    """

    length: float = 1.0
    time: float = 1.0
    mass: float = 1.0
    si: bool = False

    def unit(self, kind) -> float:
        """Return the SI value of the dimensionless 1 of a key of `units.QUANTITIES`.

        The dimensionless frequency W is angular; its value in Hz is W w0/(2 pi).
        """
        if not self.si:
            return 1.0
        each = QUANTITIES[kind]
        value = self.length**each.length * self.time**each.time * self.mass**each.mass
        return value / (2 * math.pi) if kind in ("frequency", "sweep_rate") else value

    def to_si(self, value, kind):
        """Return the SI value of a dimensionless number or array."""
        return value * self.unit(kind)

    def from_si(self, value, kind):
        """Return the dimensionless value of an SI number or array."""
        return value / self.unit(kind)

    def range_to_si(self, bounds, kind) -> dict:
        """Return `above`, `least` and `most` of a dimensionless range in SI units."""
        return {
            end: value if end == "why" else self.to_si(value, kind) for end, value in bounds.items()
        }

    def read(self, name, value, kind, **bounds) -> float:
        """Return an argument of a public function as a dimensionless number.

        Parameters
        ----------
        name : str
            Name of the argument, for messages.
        value : float, str, pint.Quantity or xarray.DataArray
            In the unit of the user.
        kind : str
            A key of `units.QUANTITIES`.
        **bounds
            Dimensionless, as in `check_number`.

        Raises
        ------
        TypeError, ValueError
            In the unit of the user.
        """
        if not self.si:
            return check_number(name, value, **bounds)
        return self.from_si(check_si(name, value, kind, **self.range_to_si(bounds, kind)), kind)

    def told(self, name, value, kind) -> str:
        """Return "name = value" with a dimensionless value in the unit of the user."""
        if not self.si:
            return f"{name} = {number(value, 6)}"
        return f"{name} = {with_unit(self.to_si(value, kind), QUANTITIES[kind].unit, 5)}"


UNITLESS = Scales()


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
