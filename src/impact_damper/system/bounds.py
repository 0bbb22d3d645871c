"""Bounds of the model's parameters, and checks of single numbers.

With parameters within these bounds every run of the kernels (the compiled integrator) ends.
`Oscillator` and `Damper`, the functions that take a frequency, and the models of the configuration
all take their bounds from here. This module imports no NumPy, since Snakemake reads it at every dry
run. A range is a dictionary of keyword arguments of `check_number`; "why" is the reason of a bound.
"""

import math
import numbers
import reprlib
from dataclasses import field, fields

FREQUENCY_RANGE = {"least": 0.01, "most": 1e3, "why": "runs are counted in forcing periods"}
DAMPING_RANGE = {"least": 1e-9, "most": 10.0, "why": "motions must settle"}
LINEAR_FREQUENCY_RANGE = {"least": 0.0, "most": 100.0}
CUBIC_RANGE = {"least": -1e6, "most": 1e6}
FORCE_RANGE = {"least": 0.0, "most": 1e6}
UNBALANCE_RANGE = {"least": 0.0, "most": 1e6}
SHAKER_RANGE = {"least": 0.0, "most": 1e6}
MASS_RATIO_RANGE = {"least": 1e-6, "most": 10.0}
CLEARANCE_RANGE = {"least": 1e-6, "most": 1e3}
RESTITUTION_RANGE = {
    "least": 0.05,
    "most": 1.0,
    "why": "below, the dashpot nears critical damping",
}
STIFFNESS_RANGE = {"least": 1e-6, "most": 1e9}
# Largest ratio of the natural frequency of the contact to the forcing frequency. A loose mass that
# stays in contact takes about this number of steps in a forcing period.
MOST_STIFF = 1e6
# Ball from which random initial states are drawn: RADIUS_RANGE of its radius, and MOST_RADIUS, the
# largest ratio of its radius to the clearance. In a larger ball hardly any state is within the gap.
RADIUS_RANGE = {"above": 0.0, "most": 1e3}
MOST_RADIUS = 1e3
# How accurately and how long motions are run (`settling.Settling`); lengths in forcing periods.
TOLERANCE_RANGE = {"least": 1e-14, "most": 1e-3, "why": "below, rounding prevails"}
PATIENCE_RANGE = {"least": 100, "most": 10**7, "why": "fewer periods decide nothing"}
LIMIT_RANGE = {"least": 100, "most": 10**8}
WATCHED_RANGE = {"least": 1, "most": 10**6}
FURTHER_RANGE = {"least": 0, "most": 10**7}
# Number of runs whose records are in memory at the same time.
MOST_RUNS = 10**6
RUNS_RANGE = {"least": 1, "most": MOST_RUNS}
# Forcing periods of a run, and forcing periods for which the lifetimes of transients are watched.
# Their ends count from period LEAD on: a run first has to reach the transient.
PERIODS_RANGE = {"least": 1, "most": 10**6}
LIFETIME_RANGE = {"least": 100, "most": 10**7}
LEAD = 20
SCAN_LIFETIME_RANGE = LIFETIME_RANGE | {"least": 2 * LEAD}
SEED_RANGE = {"least": 0, "most": 2**63 - 1}
# Largest displacement and velocity of an initial state; beyond them a forcing period takes minutes.
FARTHEST, FASTEST = 1e3, 1e6
# Highest harmonic N of a harmonic balance: its memory grows as N^2, its time as N^3.
HARMONIC_RANGE = {"least": 1, "most": 2**14}
# Number of points of a grid.
POINTS_RANGE = {"least": 2, "most": 10**5}
# Largest load (dimensionless external acceleration in a contact, `contact.contact_law`) in a map.
LOAD_RANGE = {"above": 0.0, "most": 1e3}
# Settings with which integrators are compared: tolerances; steps in a forcing period; and largest
# number of steps in a forcing period with which a stable step is searched for.
METHOD_TOLERANCE_RANGE = {"least": 1e-14, "most": 0.1, "why": "below, rounding prevails"}
STEPS_RANGE = {"least": 1, "most": 10**5}
MOST_STEPS_RANGE = {"least": 1, "most": 10**7}


def parameter(bounds, symbol, meaning, **default):
    """Return a dataclass field for a number within `bounds`.

    The field's metadata keep all that is said about a parameter in one place: `check_parameters`
    reads the bounds, tables and captions read the symbol, and the configuration reads the bounds
    and the meaning (with the symbol before it).
    """
    metadata = {"bounds": bounds, "symbol": symbol, "meaning": f"{symbol}, {meaning}"}
    return field(metadata=metadata, **default)


def check_parameters(part):
    """Raise the error of `check_number` if a field of the frozen dataclass `part` is out of range.

    A number given as an array without dimensions is replaced by a float.
    """
    for each in fields(part):
        value = getattr(part, each.name)
        number = check_number(each.name, value, **each.metadata["bounds"])
        if hasattr(value, "ndim"):  # a number of NumPy or xarray
            object.__setattr__(part, each.name, number)


def unlabelled(name, value):
    """Return the number in an array without dimensions, as xarray gives it; else the value itself.

    Raises
    ------
    ValueError
        If its attributes name a unit: the number is not dimensionless.
    """
    if getattr(value, "ndim", None) != 0 or not hasattr(value, "item"):
        return value
    units = getattr(value, "attrs", {}).get("units", "1")
    if units not in ("1", "radian"):
        raise ValueError(f"{name} = {value.item()!r} {units}: must be dimensionless, without units")
    return value.item()


def shown(value) -> str:
    """Return a value as text in one short line, for error messages."""
    return " ".join(reprlib.repr(value).split())


def plain(value) -> str:
    """Return a number as text: with six digits if they are exact, otherwise with all digits."""
    short = f"{value:g}"
    return short if float(short) == value else repr(float(value))


def check_number(name, value, *, above=None, least=None, most=None, why=""):
    """Return `value` as a float, or raise an error that names what is allowed.

    An array without dimensions counts as a number, if it is not labelled with a unit.

    Raises
    ------
    TypeError
        If the value is not a real number.
    ValueError
        If it is not finite or outside the bounds.
    """
    value = unlabelled(name, value)
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name} = {shown(value)}: must be a number")
    try:
        value = float(value)
    except OverflowError:
        value = math.inf if value > 0 else -math.inf
    if (
        math.isfinite(value)
        and (above is None or value > above)
        and (least is None or value >= least)
        and (most is None or value <= most)
    ):
        return value
    bounds = {"greater than": above, "at least": least, "at most": most}
    allowed = [f"{word} {bound:g}" for word, bound in bounds.items() if bound is not None]
    reason = f" ({why})" if why else ""
    raise ValueError(
        f"{name} = {plain(value)}: must be {' and '.join(['finite', *allowed])}{reason}"
    )


def check_count(name, value, *, least=1, most=10**9, why=""):
    """Return `value` as an int, or raise TypeError or ValueError naming what is allowed."""
    value = unlabelled(name, value)
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise TypeError(f"{name} = {shown(value)}: must be a whole number")
    if not least <= value <= most:
        reason = f" ({why})" if why else ""
        raise ValueError(f"{name} = {shown(int(value))}: must be from {least} to {most}{reason}")
    return int(value)
