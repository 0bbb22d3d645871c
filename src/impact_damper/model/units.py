"""Physical quantities in SI units, and the scales that make the equations dimensionless."""

import math
import numbers
import re
from dataclasses import field, fields
from functools import cache, partial
from typing import NamedTuple

from impact_damper.model.bounds import check_number, shown
from impact_damper.model.text import number, with_unit


class Quantity(NamedTuple):
    """A physical quantity: its SI unit, and the exponents of length, time and mass in this unit.

    If `shown` is not empty, it is the unit in datasets. Datasets have the SI value times `factor`.
    """

    unit: str
    length: int = 0
    time: int = 0
    mass: int = 0
    shown: str = ""
    factor: float = 1.0

    @property
    def label(self) -> str:
        """Unit of the quantity in datasets of machines; "1" for a plain number."""
        return self.shown or self.unit or "1"


# Physical quantities by name. Arguments named `kind` or `quantity` are keys of this dictionary.
QUANTITIES = {
    "number": Quantity(""),
    "angle": Quantity("radian"),
    "mass": Quantity("kg", mass=1),
    "displacement": Quantity("m", length=1, shown="mm", factor=1e3),
    "clearance": Quantity("m", length=1, shown="mm", factor=1e3),
    "gap": Quantity("m", length=1, shown="mm", factor=1e3),
    "time": Quantity("s", time=1),
    "frequency": Quantity("Hz", time=-1),
    "rate": Quantity("1/s", time=-1),
    "velocity": Quantity("m/s", length=1, time=-1),
    "acceleration": Quantity("m/s^2", length=1, time=-2),
    "force": Quantity("N", length=1, time=-2, mass=1),
    "stiffness": Quantity("N/m", time=-2, mass=1),
    "cubic_stiffness": Quantity("N/m^3", length=-2, time=-2, mass=1),
    "damping": Quantity("N s/m", time=-1, mass=1),
    "unbalance": Quantity("kg m", length=1, mass=1),
    "pressure": Quantity("Pa", length=-1, time=-2, mass=1),
    "impulse": Quantity("N s", length=1, time=-1, mass=1),
    "power": Quantity("W", length=2, time=-3, mass=1),
}
# TEXT matches a number with units. pint gets no other text, because it evaluates expressions.
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
UNIT = r"(?:[^\W\d]\w*|[%°]\w*)(?:[²³]|(?:\^|\*\*)-?\d)?"
TEXT = re.compile(rf"\s*({NUMBER})\s*((?:1/)?{UNIT}(?:[ */·]\s*{UNIT})*)?\s*")
LONGEST_TEXT = 80
CALCULATION = re.compile(r"\s*[\d.][^*/·+]*[*/·+]\s*[\d.].*")


def si_value(name, value, quantity) -> float:
    """Return a value as a number in the SI unit of its `quantity`, a key of QUANTITIES.

    The value is a number in the SI unit, text with units, a quantity of pint, or a single value of
    a dataset. Angular frequencies ("188 rad/s", "1800 rpm") become Hz, with the factor 1/(2 pi).
    Raise TypeError for other types. Raise ValueError for infinity, NaN or a wrong unit.
    """
    value = _from_dataset(value)
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return check_number(name, value)
    unit = QUANTITIES[quantity].unit
    allowed = f"must be a number in {unit}, or text with a unit such as {unit}"
    if not unit:
        allowed = 'must be a number, or text such as "0.5 %"'
    if isinstance(value, str):
        parts = TEXT.fullmatch(value) if len(value) <= LONGEST_TEXT else None
        magnitude, text = (float(parts[1]), parts[2] or "") if parts else (None, None)
    elif isinstance(getattr(value, "magnitude", None), numbers.Real) and hasattr(value, "units"):
        magnitude, text = value.magnitude, str(value.units)
    else:
        raise TypeError(f"{name} = {shown(value)}: {allowed}")
    factor = None if text is None else _factor(text, unit)
    if factor is None:
        remark = _wrong_unit(value, text, unit) if unit else ""
        raise ValueError(f"{name} = {shown(str(value))}: {allowed}{remark}")
    return check_number(name, float(magnitude) * factor)


def _wrong_unit(value, text, unit):
    if text is None:
        product = len(value) <= LONGEST_TEXT and CALCULATION.fullmatch(value)
        return " (write the result of the calculation, as one number with a unit)" * bool(product)
    if not text:
        return " (this text has no unit)"
    known = _factor(text, text) is not None
    return f" ({text} cannot be converted to {unit})" if known else f" ({text} is no known unit)"


def _from_dataset(value):
    if getattr(value, "ndim", None) != 0 or hasattr(value, "magnitude"):
        return value
    units = getattr(value, "attrs", {}).get("units")
    if units is None:
        return value.item()
    return f"{value.item()!r} {units}".removesuffix(" 1")


@cache
def _factor(text, unit):
    import pint  # takes a third of a second; plain numbers do without pint

    registry = pint.get_application_registry()
    try:
        one = registry.Quantity(1.0, registry.Unit(text)).to_root_units()
        target = registry.Quantity(1.0, registry.Unit(unit)).to_root_units()
        factor = (one / target).to_root_units()
    except (pint.PintError, AttributeError, ValueError, TypeError):
        return None
    turns = 2 * math.pi if unit == "Hz" and "radian" in str(one.units) else 1.0
    return factor.magnitude / turns if factor.dimensionless else None


def check_si(name, value, quantity, **bounds) -> float:
    """Return a value in the SI unit of `quantity`. Raise an error if it is outside `bounds`."""
    given = shown(value) if isinstance(value, str) else ""
    unit = QUANTITIES[quantity].unit
    return check_number(name, si_value(name, value, quantity), unit=unit, given=given, **bounds)


def absolute_value(value, quantity) -> float | None:
    """Return a tolerance such as "0.2 mm" in SI units, or None for a relative one ("5 %")."""
    if quantity is None or not (isinstance(value, str) or hasattr(value, "units")):
        return None
    try:
        return si_value("", value, quantity)
    except (TypeError, ValueError):
        return None


def physical(quantity, meaning="", **others):
    """Return a dataclass field. `others` has the field's bounds in SI units, and its default."""
    default = {key: others.pop(key) for key in ("default",) if key in others}
    unit = QUANTITIES[quantity].unit
    facts = {"quantity": quantity, "bounds": others, "meaning": meaning}
    return field(metadata=facts | {"unit": f", {unit}" * bool(unit)}, **default)


optional = partial(physical, default=None)


def convert(part) -> None:
    """Convert fields that are physical quantities to SI units. Optional fields may be None."""
    for each in fields(part):
        value = getattr(part, each.name)
        if "quantity" in each.metadata and not (value is None and each.default is None):
            found = check_si(each.name, value, each.metadata["quantity"], **each.metadata["bounds"])
            object.__setattr__(part, each.name, found)


class Scales(NamedTuple):
    """Scales of a machine in SI units: length x0, time 1/w0 and mass m1.

    If `si` is true, arguments, messages and results have units. Otherwise they are dimensionless.
    """

    length: float = 1.0
    time: float = 1.0
    mass: float = 1.0
    si: bool = False

    def unit(self, kind) -> float:
        """Return the SI value of a quantity of this kind whose dimensionless value is 1.

        For a frequency this is w0/(2 pi) in Hz, for a gap 2 x0 in m. If `si` is false, return 1.
        """
        if not self.si:
            return 1.0
        each = QUANTITIES[kind]
        value = self.length**each.length * self.time**each.time * self.mass**each.mass
        if kind == "gap":
            return 2 * value
        return value / (2 * math.pi) if kind == "frequency" else value

    def to_si(self, value, kind):
        """Return the SI value of a dimensionless number or array."""
        return value * self.unit(kind)

    def from_si(self, value, kind):
        """Return the dimensionless value of an SI number or array."""
        return value / self.unit(kind)

    def range_to_si(self, bounds, kind) -> dict:
        """Convert a dictionary of bounds from dimensionless numbers to SI units."""
        return {
            end: value if end == "why" else self.to_si(value, kind) for end, value in bounds.items()
        }

    def read(self, name, value, kind, **bounds) -> float:
        """Check an argument, which may have a unit, and return it as a dimensionless number."""
        if not self.si:
            return check_number(name, value, **bounds)
        return self.from_si(check_si(name, value, kind, **self.range_to_si(bounds, kind)), kind)

    def told(self, name, value, kind) -> str:
        """Return the text "name = value", with the SI value and its unit if `si` is true."""
        if not self.si:
            return f"{name} = {number(value, 6)}"
        return f"{name} = {with_unit(self.to_si(value, kind), QUANTITIES[kind].unit, 5)}"


UNITLESS = Scales()
