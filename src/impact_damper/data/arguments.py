"""Let functions that take an `Oscillator` also take a `Machine`, with all arguments in SI units."""

import inspect
import re
import warnings
from functools import wraps

import numpy as np
import xarray as xr

from impact_damper.data.results import FOLLOWED, STATE, STATE_UNITS, from_si, in_si
from impact_damper.model.bounds import CLEARANCE_RANGE, FARTHEST, FASTEST, RADIUS_RANGE, shown
from impact_damper.model.dampers import MachineDamper
from impact_damper.model.machine import Machine
from impact_damper.model.names import nearest
from impact_damper.model.units import NUMBER, QUANTITIES, check_si, si_value

NOTE = """

With a `Machine` in place of the oscillator, and a `MachineDamper` in place of the damper, all
arguments and the result are in SI units: see `Machine`.
"""
# Numbers that are converted to SI units in errors and warnings of the dimensionless functions.
# Keyed by the name in the message; the values are the name for a machine and the quantity. Mass
# ratios are not converted.
TOLD = {inner: (name, kind) for name, (inner, kind) in FOLLOWED.items() if inner != "mass_ratio"}
TOLD |= {
    "frequencies": ("frequencies", "frequency"),
    "clearances": ("clearances", "clearance"),
    "radius": ("radius", "displacement"),
    "displacement": ("displacement", "displacement"),
    "speed": ("speed", "velocity"),
    "start": ("start", "time"),
    "linear_frequency": ("natural_frequency", "frequency"),
}
TOLD_NUMBER = re.compile(rf"\b({'|'.join(TOLD)})((?:\[\d+\])?) = (\[[^\]]*\]|{NUMBER})")


def takes_machine(function):
    """Return a function that also takes a `Machine`, with the other arguments in SI units.

    An argument is converted by its name, which has the same meaning in all functions: `frequency`
    and `frequencies` (Hz), `state` and `loose` (m, m/s), `displacement` (m), `velocity` (m/s),
    `clearances` (m, on each side), `radius` (m; the random starts fill a ball, in which the largest
    speed is radius * w0, with 1/w0 the scale of time), `start` (s), `damper`, `parameter` with
    `span`, `motions`. Each number may be text with units or a quantity of pint. `mass_ratio` stays
    a ratio. A dataset that the function returns is converted by `in_si`. A single number that it
    returns is a clearance on each side, in m. Numbers in errors and warnings are in SI units. With
    an `Oscillator` nothing is converted.

    Parameters
    ----------
    function : callable
        Its first argument is `oscillator`. It returns a dataset or a clearance.
    """
    signature = inspect.signature(function)

    @wraps(function)
    def either(*args, **kwargs):
        given = kwargs.get("oscillator", args[0] if args else None)
        if not isinstance(given, Machine):
            return function(*args, **kwargs)
        bound = signature.bind(*args, **kwargs).arguments
        return _called(function, given, bound)

    either.__doc__ = inspect.cleandoc(function.__doc__) + NOTE
    return either


def _called(function, machine, given):
    """Call a function with arguments given in SI units, and return its dataset in SI units."""
    arguments = dict(given)
    damper = arguments.get("damper")
    parameter = arguments.get("parameter", "frequency")
    # The force of a moving base is exact for one given frequency. Over a range of frequencies one
    # formula approximates it.
    fixed = "frequency" in arguments and not ("span" in arguments and parameter == "frequency")
    single = machine.check_frequency("frequency", arguments["frequency"]) if fixed else None
    arguments["oscillator"] = machine.oscillator(single)
    for name, value in given.items():
        if name in CONVERTED and value is not None:
            arguments[name] = CONVERTED[name](machine, name, value)
    if "damper" in arguments:
        arguments["damper"] = _damper(machine, damper, swept="clearances" in arguments)
    if "span" in arguments:
        arguments |= _span(machine, parameter, arguments["span"])
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found = function(**arguments)
    except (ArithmeticError, ValueError) as error:
        raise type(error)(_told_in_si(str(error), machine.scales)) from None
    for each in caught:
        warnings.warn(_told_in_si(str(each.message), machine.scales), each.category, stacklevel=4)
    if isinstance(found, float):
        return machine.scales.to_si(found, "clearance")
    return in_si(found, machine, damper)


def _told_in_si(message, scales):
    """Return a message in which each `name = number` is converted to SI units."""

    def told(match):
        name, quantity = TOLD[match[1]]
        unit = QUANTITIES[quantity].unit
        values = re.sub(
            NUMBER, lambda number: f"{scales.to_si(float(number[0]), quantity):.5g}", match[3]
        )
        return f"{name}{match[2]} = {values} {unit}".rstrip()

    return TOLD_NUMBER.sub(told, message)


def _damper(machine, damper, swept):
    """Return a damper in the scales of a machine.

    For a sweep of the gap (`swept`), return its arguments without the clearance.
    """
    if damper is None:
        return None
    if not isinstance(damper, MachineDamper):
        raise TypeError(f"damper = {shown(damper)}: must be a MachineDamper, by machine.damper")
    damper.check_for(machine)
    scaled = damper.scaled(machine.scales)
    kept = ("mass_ratio", "restitution", "contact_stiffness")
    return {name: getattr(scaled, name) for name in kept} if swept else scaled


def _span(machine, parameter, span):
    """Return the arguments `parameter` and `span` of a branch."""
    if not isinstance(parameter, str) or parameter not in FOLLOWED:
        allowed = ", ".join(FOLLOWED) + nearest(parameter, FOLLOWED)
        raise ValueError(f"parameter = {shown(parameter)}: must be one of {allowed}")
    name, quantity = FOLLOWED[parameter]
    if np.ndim(span) != 1:
        raise TypeError(f"span = {shown(span)}: must be two numbers, least and greatest")
    ends = _each("span", span, lambda place, end: si_value(place, end, quantity))
    return {"parameter": name, "span": tuple(machine.scales.from_si(end, quantity) for end in ends)}


def _each(name, values, convert):
    """Return a number or a sequence, converted; errors name the place in the sequence."""
    if np.ndim(getattr(values, "magnitude", values)) == 0:
        return convert(name, values)
    return [convert(f"{name}[{place}]", value) for place, value in enumerate(values)]


def _frequencies(machine, name, values):
    def convert(place, value):
        return machine.scales.from_si(machine.check_frequency(place, value), "frequency")

    return _each(name, values, convert)


def _clearances(machine, name, values):
    scales = machine.scales
    bounds = scales.range_to_si(CLEARANCE_RANGE, "clearance")

    def convert(place, value):
        return scales.from_si(check_si(place, value, "clearance", **bounds), "clearance")

    return _each(name, values, convert)


def _state(machine, name, values):
    """Return a state in the scales of a machine.

    A state from a dataset stays a DataArray, with its forcing phase as coordinate.
    """
    labelled, values = values, getattr(values, "values", values)
    if isinstance(labelled, xr.DataArray):
        units = labelled.attrs.get("units")
        if units != STATE_UNITS:
            raise ValueError(f"{name} = {shown(values)}: must be in {STATE_UNITS}, not in {units}")
        values = values.squeeze()
    if np.ndim(values) != 1 or len(values) not in (2, 4):
        raise ValueError(
            f"{name} = {shown(values)}: must be four numbers, displacement (m) and velocity (m/s) "
            "of the machine and of the machine relative to the loose mass, or the first two "
            "without a damper"
        )
    scaled = [
        _part_of_state(machine.scales, f"{name}[{place}]", value, quantity)
        for place, (value, quantity) in enumerate(zip(values, STATE, strict=False))
    ]
    if not isinstance(labelled, xr.DataArray):
        return scaled
    found = labelled.copy(data=np.reshape(scaled, labelled.shape))
    return found.assign_attrs(units="1")


def _part_of_state(scales, name, value, quantity):
    """Return a displacement or velocity in the scales of a machine."""
    most = FARTHEST if quantity == "displacement" else FASTEST
    bounds = scales.range_to_si({"least": -most, "most": most}, quantity)
    return scales.from_si(check_si(name, value, quantity, **bounds), quantity)


def _radius(machine, name, value):
    most = machine.scales.to_si(RADIUS_RANGE["most"], "displacement")
    radius = check_si(name, value, "displacement", above=0, most=most)
    return machine.scales.from_si(radius, "displacement")


def _half_width(quantity, dimensionless_most):
    """Return a function that scales half the width of a plane of states."""

    def convert(machine, name, value):
        most = machine.scales.to_si(dimensionless_most, quantity)
        return machine.scales.from_si(check_si(name, value, quantity, above=0, most=most), quantity)

    return convert


def _loose(machine, name, values):
    """Return displacement and velocity of the machine relative to the loose mass, scaled."""
    values = getattr(values, "values", values)
    if np.shape(values) != (2,):
        raise ValueError(
            f"{name} = {shown(values)}: must be two numbers, displacement (m) and velocity (m/s) "
            "of the machine relative to the loose mass"
        )
    found = []
    for place, quantity, most in ((0, "displacement", FARTHEST), (1, "velocity", FASTEST)):
        most = machine.scales.to_si(most, quantity)
        value = check_si(f"{name}[{place}]", values[place], quantity, least=-most, most=most)
        found.append(machine.scales.from_si(value, quantity))
    return found


def _start(machine, name, value):
    return machine.scales.from_si(si_value(name, value, "time"), "time")


def _mass_ratio(machine, name, value):
    return si_value(name, value, "number")


def _motions(machine, name, values):
    if not isinstance(values, list) or not all(isinstance(each, xr.Dataset) for each in values):
        raise TypeError(f"{name} = {shown(values)}: must be a list of datasets of motions")
    return [from_si(each, machine) for each in values]


CONVERTED = {
    "frequency": _frequencies,
    "frequencies": _frequencies,
    "clearances": _clearances,
    "state": _state,
    "radius": _radius,
    "displacement": _half_width("displacement", FARTHEST),
    "velocity": _half_width("velocity", FASTEST),
    "loose": _loose,
    "start": _start,
    "mass_ratio": _mass_ratio,
    "motions": _motions,
}
