"""Parameters of the oscillator and of the damper, checked when they are made.

Everything is dimensionless, scaled as in section 2.1 of Chatterjee, Mallik and
Ghosh (1995): lengths by x0 = (F/k1)^(1/3), times by 1/w0 = sqrt(m1/(k1 x0^2)).
"""

import math
from dataclasses import dataclass, fields

import numpy as np

from impact_damper.system.bounds import (
    CLEARANCE_RANGE,
    DAMPING_RANGE,
    FREQUENCY_RANGE,
    LINEAR_FREQUENCY_RANGE,
    MASS_RATIO_RANGE,
    MOST_RUNS,
    MOST_STIFF,
    RESTITUTION_RANGE,
    STIFFNESS_RANGE,
    check_count,
    check_number,
    check_parameters,
    parameter,
    shown,
)


def check_numbers(name, values, **bounds):
    """Return a number or a sequence of them as an array, or raise as `check_number` does.

    Raises
    ------
    TypeError, ValueError
        Naming the place of the number that is wrong.
    """
    return np.array([check_number(f"{name}[{i}]", x, **bounds) for i, x in _numbered(values)])


def check_counts(name, values, **bounds):
    """As `check_numbers`, for whole numbers."""
    return np.array([check_count(f"{name}[{i}]", x, **bounds) for i, x in _numbered(values)], int)


def _numbered(values):
    return enumerate(values if isinstance(values, (list, tuple)) else np.atleast_1d(values))


def check_frequency(value):
    """Return the forcing frequency W, or raise if it is out of range."""
    return check_number("frequency", value, **FREQUENCY_RANGE)


def check_increasing(name, values, least="one"):
    """Return numbers as an array, or raise ValueError unless they increase; `least` one or two."""
    numbers = check_numbers(name, values)
    if len(numbers) < {"one": 1, "two": 2}[least] or np.any(np.diff(numbers) <= 0):
        given = shown(numbers.tolist())
        raise ValueError(f"{name} = {given}: must be increasing, and at least {least}")
    return numbers


def check_frequencies(values, least="one"):
    """Return increasing forcing frequencies as an array, or raise as `check_frequency` does."""
    return check_increasing(
        "frequencies", check_numbers("frequencies", values, **FREQUENCY_RANGE), least
    )


def check_starts(starts, points, least=1):
    """Raise unless `starts` is a number of runs that can be kept in memory at so many points."""
    most = max(least, MOST_RUNS // points)
    check_count("starts", starts, least=least, most=most, why=f"at {points} points: memory")


def check_span(name, span, **bounds) -> tuple:
    """Return least and greatest value of a range above 0, or raise TypeError or ValueError."""
    ends = check_numbers(name, span, **bounds)
    if ends.shape != (2,) or not 0 < ends[0] < ends[1]:
        raise ValueError(f"{name} = {shown(span)}: must be least and greatest value, above 0")
    return float(ends[0]), float(ends[1])


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
        If a value is not a number or out of range; so does `Damper`.
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
    """Parameters as the kernels read them; `damper=None` switches the damper off.

    Returns
    -------
    numpy.ndarray, shape (packed.COUNT,)
        In the places that `packed` names. Without a damper the clearance is infinite.

    Raises
    ------
    TypeError
        If an argument is not of its type.
    ValueError
        If the frequency is out of range, or the contact too fast for it.
    """
    frequency = check_frequency(frequency)
    check_oscillator(oscillator)
    stiffness = oscillator.linear_frequency**2
    if damper is None:
        return np.array([frequency, oscillator.damping, stiffness, np.inf, 0.0, 0.0, 0.0])
    check_damper(damper)
    natural = math.sqrt(damper.contact_stiffness * (1 + 1 / damper.mass_ratio))
    if natural > MOST_STIFF * frequency:
        raise ValueError(
            f"contact_stiffness = {damper.contact_stiffness:g}: with mass_ratio = "
            f"{damper.mass_ratio:g} and frequency = {frequency:g}: must be so small that the "
            f"contact is at most {MOST_STIFF:g} times as fast as the forcing (steps of a contact)"
        )
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
