"""Bounds of the model's parameters, and checks of single arguments.

If all parameters are within these bounds, every run of the kernels (the compiled integrator) comes
to an end. A range is a dictionary of keyword arguments of `check_number`.
"""

import difflib
import inspect
import math
import numbers
import reprlib
from dataclasses import field, fields
from functools import wraps

from impact_damper.model.text import plain, with_unit

FREQUENCY_RANGE = {"least": 0.01, "most": 1e3, "why": "beyond, cycles are too long or too short"}
DAMPING_RANGE = {"least": 1e-9, "most": 10.0, "why": "motions must settle"}
MASS_RATIO_RANGE = {"least": 1e-6, "most": 10.0}
CLEARANCE_RANGE = {"least": 1e-6, "most": 1e3}
RESTITUTION_RANGE = {
    "least": 0.05,
    "most": 1.0,
    "why": "below, the dashpot nears critical damping",
}
AMPLITUDE_RANGE = {"least": 0.0, "most": 1e6}
STIFFNESS_RANGE = {"least": 1e-6, "most": 1e9}
# Largest ratio of the natural frequency of the contact to the forcing frequency. While the loose
# mass stays in contact, a run takes about this number of integration steps in a forcing cycle.
MOST_STIFF = 1e6
# Random initial states are drawn from a ball. RADIUS_RANGE bounds its radius, and MOST_RADIUS is
# the largest ratio of its radius to the clearance. In a larger ball hardly any state lies within
# the gap.
RADIUS_RANGE = {"above": 0.0, "most": 1e3}
MOST_RADIUS = 1e3
# Bounds of the fields of `settling.Settling`. All but the tolerance are in forcing cycles.
TOLERANCE_RANGE = {"least": 1e-14, "most": 1e-3, "why": "rounding errors exceed smaller ones"}
PATIENCE_RANGE = {"least": 100, "most": 10**7, "why": "motions rarely settle in fewer cycles"}
LIMIT_RANGE = {"least": 100, "most": 10**8}
WATCHED_RANGE = {"least": 1, "most": 10**6}
FURTHER_RANGE = {"least": 0, "most": 10**7}
# Largest number of runs that one call computes; the results of all are in memory at the same time.
MOST_RUNS = 10**6
RUNS_RANGE = {"least": 1, "most": MOST_RUNS}
# PERIODS_RANGE        forcing cycles of a run
# LIFETIME_RANGE       forcing cycles of a run that measures the lifetime of a chaotic transient
# LEAD                 first cycles of such a run, in which it reaches the transient; runs that end
#                      in these cycles are not counted
# SCAN_LIFETIME_RANGE  LIFETIME_RANGE for runs at many frequencies, which may be shorter
PERIODS_RANGE = {"least": 1, "most": 10**6}
LIFETIME_RANGE = {"least": 100, "most": 10**7}
LEAD = 20
SCAN_LIFETIME_RANGE = LIFETIME_RANGE | {"least": 2 * LEAD}
SEED_RANGE = {"least": 0, "most": 2**63 - 1}
# Largest displacement and velocity of an initial state. With larger ones the integration of one
# forcing cycle takes minutes.
FARTHEST, FASTEST = 1e3, 1e6
# Highest harmonic N of a harmonic balance, whose memory grows as N^2 and computing time as N^3.
HARMONIC_RANGE = {"least": 1, "most": 2**14}
# Number of points of a grid.
POINTS_RANGE = {"least": 2, "most": 10**5}
# Loads (constant accelerations during a contact) for which `contact.contact_law` is evaluated.
LOAD_RANGE = {"above": 0.0, "most": 1e3}
# Settings of the comparison of integrators:
# METHOD_TOLERANCE_RANGE  tolerance
# STEPS_RANGE             steps in a forcing cycle
# MOST_STEPS_RANGE        most steps in a forcing cycle that the search for a stable step size tries
METHOD_TOLERANCE_RANGE = {"least": 1e-14, "most": 0.1, "why": "rounding errors exceed smaller ones"}
STEPS_RANGE = {"least": 1, "most": 10**5}
MOST_STEPS_RANGE = {"least": 1, "most": 10**7}


def parameter(bounds, kind, symbol, meaning, *, machine=None, **default):
    """Return a dataclass field for a dimensionless number within `bounds`.

    The field's metadata keep the facts about a parameter in one place. `check_parameters` reads the
    bounds, errors read the kind (a key of `units.QUANTITIES`) and the name for a machine, tables
    and captions read the symbol, and the configuration reads the bounds and the meaning.
    """
    metadata = {"bounds": bounds, "kind": kind, "symbol": symbol, "machine": machine}
    metadata["meaning"] = f"{symbol}, {meaning}"
    return field(metadata=metadata, **default)


def check_parameters(part):
    """Check the fields of a frozen dataclass against the bounds in their metadata.

    A field that holds an array without dimensions is replaced by a float.
    """
    for each in fields(part):
        if "bounds" not in each.metadata:
            continue
        value = getattr(part, each.name)
        number = check_number(each.name, value, **each.metadata["bounds"])
        if hasattr(value, "ndim"):  # a number of NumPy or xarray
            object.__setattr__(part, each.name, number)


def unlabelled(name, value):
    """Return the number in an array without dimensions, such as an element of a dataset.

    Any other value is returned unchanged. A unit in the attributes of the array is an error.
    """
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
    """Return `value` as a float, or raise an error that names the allowed range.

    An array without dimensions counts as a number unless it is labelled with a unit.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    value : float
    above, least, most : float, optional
        Bounds: the value must be greater than `above`, at least `least` and at most `most`.
    why : str
        Reason for the bounds, for the message.
    unit, given : str
        For the message: unit of value and bounds, and text in place of the value.

    Raises
    ------
    TypeError
        If the value is not a real number.
    ValueError
        If the value is not finite or outside the bounds.
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
    allowed = ["finite"] if not math.isfinite(value) else []
    allowed += [
        f"{word} {with_unit(bound, unit)}" for word, bound in bounds.items() if bound is not None
    ]
    given = given or (with_unit(value, unit) if unit else plain(value))
    reason = f" ({why})" if why else ""
    raise ValueError(f"{name} = {given}: must be {' and '.join(allowed)}{reason}")


def check_count(name, value, *, least=1, most=10**9, why=""):
    """Return `value` as an int, or raise an error unless it is a whole number in the range."""
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
    """Raise an error unless `starts`, for each of `points` grid points, are allowed.

    All points together may have MOST_RUNS starts.
    """
    most = max(least, MOST_RUNS // points)
    check_count("starts", starts, least=least, most=most, why=f"memory holds {MOST_RUNS} runs")


def nearest(name, known) -> str:
    """Return "; did you mean ...?" with the known name nearest to `name`, or "" if none is near."""
    matches = difflib.get_close_matches(name, known, 1) if isinstance(name, str) else []
    return f"; did you mean {matches[0]}?" if matches else ""


def names_arguments(function):
    """Decorate a public function or class: a TypeError for a wrong argument lists the known ones.

    For an unknown keyword it proposes the nearest.
    """
    if inspect.isclass(function):
        function.__init__ = _checked(function.__init__, function.__name__)
        return function
    return _checked(function, function.__name__)


def _checked(function, title):
    parameters = inspect.signature(function).parameters
    known = [name for name in parameters if name != "self"]
    positional = [each for each in parameters.values() if each.kind is each.POSITIONAL_OR_KEYWORD]

    @wraps(function)
    def checked(*args, **kwargs):
        for name in kwargs:
            if name not in parameters:
                raise TypeError(
                    f"{title}() has no argument {name!r}; known: {', '.join(known)}"
                    f"{nearest(name, known)}"
                )
        if len(args) > len(positional):
            raise TypeError(
                f"{title}() has too many arguments without a name; known: {', '.join(known)}"
            )
        return function(*args, **kwargs)

    return checked
