"""Parameters of the oscillator and of the damper, checked when they are made.

Everything is dimensionless, scaled as in section 2.1 of Chatterjee, Mallik and
Ghosh (1995): lengths by x0 = (F/k1)^(1/3), times by 1/w0 = sqrt(m1/(k1 x0^2)).
"""

import math
import numbers
from dataclasses import dataclass, fields

import numpy as np


def check_number(name, value, *, above=None, least=None, most=None, why=""):
    """Return `value` as a float, or raise an error that names what is allowed.

    Raises
    ------
    TypeError
        If the value is not a real number.
    ValueError
        If it is not finite or outside the bounds.
    """
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name} = {value!r}: must be a number")
    value = float(value)
    bounds = [
        (above, "greater than", lambda bound: value > bound),
        (least, "at least", lambda bound: value >= bound),
        (most, "at most", lambda bound: value <= bound),
    ]
    allowed = [f"{word} {bound:g}" for bound, word, _ in bounds if bound is not None]
    holds = all(test(bound) for bound, _, test in bounds if bound is not None)
    if not math.isfinite(value) or not holds:
        reason = f" ({why})" if why else ""
        raise ValueError(
            f"{name} = {value:g}: must be {' and '.join(['finite', *allowed])}{reason}"
        )
    return value


def check_count(name, value, *, least=1, most=10**9, why=""):
    """Return `value` as an int, or raise TypeError or ValueError naming what is allowed."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise TypeError(f"{name} = {value!r}: must be a whole number")
    if not least <= value <= most:
        reason = f" ({why})" if why else ""
        raise ValueError(f"{name} = {value}: must be from {least} to {most}{reason}")
    return int(value)


def check_frequency(value):
    """Return the forcing frequency W, or raise if it is not a positive number."""
    return check_number("frequency", value, above=0.0, most=1e3, why="the forcing is periodic")


def check_increasing(name, values, least="one"):
    """Return numbers as an array, or raise ValueError unless they increase; `least` one or two."""
    values = np.array(values, float)
    if len(values) < {"one": 1, "two": 2}[least] or np.any(np.diff(values) <= 0):
        raise ValueError(f"{name}: must be increasing, and at least {least}; {values} given")
    return values


def check_frequencies(values, least="one"):
    """Return increasing forcing frequencies as an array, or raise as `check_frequency` does."""
    return check_increasing(
        "frequencies", [check_frequency(w) for w in np.atleast_1d(values)], least
    )


def check_damper(damper):
    """Raise TypeError if `damper` is not a Damper, where None would have no meaning."""
    if not isinstance(damper, Damper):
        raise TypeError(f"damper = {damper!r}: must be a Damper")


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
        If a value is not a number or out of range; so does `Damper`.
    """

    damping: float
    linear_frequency: float = 0.0

    def __post_init__(self):
        check_number("damping", self.damping, above=0.0, most=10.0, why="motions must settle")
        check_number("linear_frequency", self.linear_frequency, least=0.0, most=100.0)


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
    """

    mass_ratio: float
    clearance: float
    restitution: float = 1.0
    contact_stiffness: float = 2000.0

    def __post_init__(self):
        check_number("mass_ratio", self.mass_ratio, above=0.0, most=10.0)
        check_number("clearance", self.clearance, above=0.0, most=1e3)
        check_number(
            "restitution",
            self.restitution,
            least=0.05,
            most=1.0,
            why="below, the dashpot nears critical damping",
        )
        check_number("contact_stiffness", self.contact_stiffness, above=0.0, most=1e9)

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
    """Parameters as the kernels read them; `damper=None` switches the damper off.

    Returns
    -------
    numpy.ndarray, shape (7,)
        W, h, omega_l^2, d0, r1, 1/rm, dashpot. Without a damper d0 is infinite.

    Raises
    ------
    TypeError
        If an argument is not of its type.
    ValueError
        If the frequency is out of range.
    """
    frequency = check_frequency(frequency)
    if not isinstance(oscillator, Oscillator):
        raise TypeError(f"oscillator = {oscillator!r}: must be an Oscillator")
    stiffness = oscillator.linear_frequency**2
    if damper is None:
        return np.array([frequency, oscillator.damping, stiffness, np.inf, 0.0, 0.0, 0.0])
    check_damper(damper)
    return np.array(
        [
            frequency,
            oscillator.damping,
            stiffness,
            damper.clearance,
            damper.contact_stiffness,
            1 / damper.mass_ratio,
            damper.dashpot,
        ]
    )


def describe(*parts) -> dict:
    """Parameters of an oscillator, a damper or None as one dictionary of plain numbers."""
    return {
        field.name: getattr(part, field.name)
        for part in parts
        if part is not None
        for field in fields(part)
    }
