"""Allowed ranges of parameters and arguments, and checks. Within the ranges every run ends.

A range is a dictionary of keyword arguments of `check_number` or `check_count`.
"""

import difflib
import inspect
import math
import numbers
import reprlib
import sys
import warnings
from dataclasses import fields
from functools import wraps

from impact_damper.model.text import plain, with_unit

FREQUENCY_RANGE = {"least": 0.01, "most": 1e3, "why": "beyond, cycles are too long or too short"}
DAMPING_RANGE = {"least": 1e-9, "most": 10.0, "why": "motions must settle"}
MASS_RATIO_RANGE = {"least": 1e-6, "most": 10.0}
CLEARANCE_RANGE = {"least": 1e-6, "most": 1e3}
RESTITUTION_RANGE = {"least": 0.05, "most": 1.0, "why": "below, the dashpot nears critical damping"}
AMPLITUDE_RANGE = {"least": 0.0, "most": 1e6}
STIFFNESS_RANGE = {"least": 1e-6, "most": 1e9}
# Largest allowed ratio between the natural frequency of the contact and the forcing frequency.
MOST_STIFF = 1e6
# Range of the dimensionless radius of the ball in which random starts lie.
RADIUS_RANGE = {"above": 0.0, "most": 1e3}
# Largest radius of the ball of random starts, divided by the clearance.
MOST_RADIUS = 1e3
TOLERANCE_RANGE = {"least": 1e-14, "most": 1e-3, "why": "rounding errors exceed smaller ones"}
PATIENCE_RANGE = {"least": 100, "most": 10**7, "why": "motions rarely settle in fewer cycles"}
LIMIT_RANGE = {"least": 100, "most": 10**8}
WATCHED_RANGE = {"least": 1, "most": 10**6}
FURTHER_RANGE = {"least": 0, "most": 10**7}
# Largest number of runs in one call of a function. Memory must hold the results of all runs.
MOST_RUNS = 10**6
RUNS_RANGE = {"least": 1, "most": MOST_RUNS}
PERIODS_RANGE = {"least": 1, "most": 10**6}
# Range of the number of cycles in a run that measures how long chaos lasts.
LIFETIME_RANGE = {"least": 100, "most": 10**7}
SEED_RANGE = {"least": 0, "most": 2**63 - 1}
# Largest |displacement| and |velocity| of a start. Beyond, it takes minutes to compute a cycle.
FARTHEST, FASTEST = 1e3, 1e6
# Range of the highest harmonic N of a harmonic balance. Memory grows as N^2, time as N^3.
HARMONIC_RANGE = {"least": 1, "most": 2**14}
PACKAGE = f"{__name__.partition('.')[0]}."
POINTS_RANGE = {"least": 2, "most": 10**5}
METHOD_TOLERANCE_RANGE = TOLERANCE_RANGE | {"most": 0.1}


def warn(text) -> None:
    """Issue a warning that points to the line at which the user's code called this package."""
    frame, level = sys._getframe(1), 2
    while frame and frame.f_globals.get("__name__", "").startswith(PACKAGE):
        frame, level = frame.f_back, level + 1
    warnings.warn(text, stacklevel=level)


def unlabelled(name, value):
    """Return `value` or, if it is an array of shape () without units, the number in the array."""
    if getattr(value, "ndim", None) != 0 or not hasattr(value, "item"):
        return value
    units = getattr(value, "attrs", {}).get("units", "1")
    if units not in ("1", "radian"):
        raise ValueError(f"{name} = {value.item()!r} {units}: must be dimensionless, without units")
    return value.item()


def shown(value) -> str:
    """Return a value as one short line of text, for error messages."""
    return " ".join(reprlib.repr(value).split())


def check_number(
    name, value, *, above=None, least=None, most=None, why="", unit="", given=""
) -> float:
    """Return `value` as a float, or raise an error if it is not allowed.

    Raise TypeError for a value that is no real number, such as True. Raise ValueError if the value
    is not finite, or is out of bounds. If `given` is not empty, it replaces the value in messages.
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
    allowed = [] if math.isfinite(value) else ["finite"]
    allowed += range_words(unit, above=above, least=least, most=most)
    given = given or (with_unit(value, unit) if unit else plain(value))
    reason = f" ({why})" if why else ""
    raise ValueError(f"{name} = {given}: must be {' and '.join(allowed)}{reason}")


def range_words(unit="", *, above=None, least=None, most=None, why="") -> list:
    """Return a list that has each bound of a range in words, such as "at least 2 kg"."""
    bounds = {"greater than": above, "at least": least, "at most": most}
    return [f"{word} {with_unit(end, unit)}" for word, end in bounds.items() if end is not None]


def check_count(name, value, *, least=1, most=10**9, why=""):
    """Return `value` as an int. It must be a whole number from `least` to `most`."""
    value = unlabelled(name, value)
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise TypeError(f"{name} = {shown(value)}: must be a whole number")
    if not least <= value <= most:
        reason = f" ({why})" if why else ""
        raise ValueError(f"{name} = {shown(int(value))}: must be from {least} to {most}{reason}")
    return int(value)


def check_frequency(value):
    """Return the forcing frequency W as a float, or raise an error if it is out of range."""
    return check_number("frequency", value, **FREQUENCY_RANGE)


def check_starts(starts, points, least=1):
    """Raise an error if `starts` is below `least`, or if there are more than MOST_RUNS runs.

    There are `starts` runs at each of `points` parameter values. `least` starts are always allowed.
    """
    most = max(least, MOST_RUNS // points)
    check_count("starts", starts, least=least, most=most, why=f"memory holds {MOST_RUNS} runs")


def nearest(name, known) -> str:
    """Return the text "; did you mean X?" if a name X in `known` resembles `name`, otherwise ""."""
    matches = difflib.get_close_matches(name, known, 1) if isinstance(name, str) else []
    return f"; did you mean {matches[0]}?" if matches else ""


def names_arguments(function):
    """Decorate a public function or dataclass. Errors about unknown arguments list the known ones.

    The docstring of a dataclass also gets a list of its fields, with the meaning of each.
    """
    call = function.__init__ if inspect.isclass(function) else function
    signature = inspect.signature(call)
    known = [name for name in signature.parameters if name not in ("self", "cls")]

    @wraps(call)
    def checked(*args, **kwargs):
        try:
            signature.bind(*args, **kwargs)
        except TypeError as error:
            unknown = [name for name in kwargs if name not in known]
            wrong = f"has no argument {unknown[0]!r}" if unknown else error
            words = f"{function.__name__}() {wrong}; known: {', '.join(known)}"
            words += "".join(nearest(name, known) for name in unknown[:1])
            raise TypeError(words) from None
        return call(*args, **kwargs)

    if call is function:
        return checked
    function.__init__ = checked
    described = [each for each in fields(function) if "meaning" in each.metadata]
    lines = ["", "    Attributes", "    ----------"] if described else []
    for each in described:
        unit = each.metadata.get("unit", "")
        lines += [f"    {each.name} : float", f"        {each.metadata['meaning']}{unit}."]
    function.__doc__ += "\n".join(lines)
    return function
