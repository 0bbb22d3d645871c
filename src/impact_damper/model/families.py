"""Systems with one parameter that varies, along which branches of orbits are followed."""

from dataclasses import replace

import numpy as np

from impact_damper.model.arguments import read_span
from impact_damper.model.bounds import FREQUENCY_RANGE, nearest, shown
from impact_damper.model.packed import FORCE, FREQUENCY, UNBALANCE, pack
from impact_damper.model.parameters import Damper, Oscillator

# Parameters that can vary along a branch, and their dataclasses. The frequency has no dataclass.
PARAMETERS = {"frequency": None}
PARAMETERS |= dict.fromkeys(("damping", "cubic", "force", "unbalance"), Oscillator)
PARAMETERS |= dict.fromkeys(("mass_ratio", "clearance", "restitution", "contact_stiffness"), Damper)
# For these parameters the coordinate along a branch is the value, for others the value's logarithm.
LINEAR = ("frequency", "cubic", "force", "unbalance", "restitution")
FORCING = {"force": FORCE, "unbalance": UNBALANCE}


def facts_of(parameter) -> tuple:
    """Return the parameter's name in a `Machine`, its physical quantity and its bounds."""
    owner = PARAMETERS[parameter]
    if owner is None:
        return parameter, "frequency", FREQUENCY_RANGE
    facts = owner.__dataclass_fields__[parameter].metadata
    return facts["machine"] or parameter, facts["kind"], facts["bounds"]


def read_followed(model, parameter, span) -> tuple:
    """Check `parameter` and `span`. Return the key in PARAMETERS and the dimensionless span.

    `parameter` is a key in PARAMETERS or, for a machine, the name that `facts_of` returns. For
    example, "clearance" is "gap" for a machine. The span must contain the value in `model`.
    """
    scales, damper = model.scales, model.damper
    names = {facts_of(name)[0] if scales.si else name: name for name in PARAMETERS}
    if not isinstance(parameter, str) or parameter not in names:
        allowed = ", ".join(names) + nearest(parameter, names)
        raise ValueError(f"parameter = {shown(parameter)}: must be one of {allowed}")
    name = names[parameter]
    owner, (_, kind, bounds) = PARAMETERS[name], facts_of(name)
    if owner is Damper and damper is None:
        raise ValueError(f"parameter = {parameter!r}: there is no damper to change")
    least, most = read_span(scales, "span", span, kind, **bounds)
    part = {None: model, Oscillator: model.oscillator, Damper: damper}[owner]
    if not least <= getattr(part, name) <= most:
        told = scales.told(parameter, getattr(part, name), kind)
        raise ValueError(f"span = {shown(span)}: must hold {told}")
    return name, (least, most)


def family_of(oscillator, damper, frequency, parameter, span):
    """Return (function, coordinate, ends) for a system whose `parameter` varies over a `span`.

    The coordinate is the parameter's value if the parameter is in LINEAR, otherwise the logarithm
    of the value. function(x) returns the packed parameters at the coordinate x. The second result
    is the coordinate of the given system. `ends` has the coordinates of both ends of the span.
    """
    part = {None: None, Oscillator: oscillator, Damper: damper}[PARAMETERS[parameter]]
    value = frequency if part is None else getattr(part, parameter)
    (least, most), given = span, pack(oscillator, damper, frequency)

    def pack_at(value):
        if part is None:
            if not least < value < most:
                return pack(oscillator, damper, value)
            p = given.copy()
            p[FREQUENCY] = value
            return p
        changed = replace(part, **{parameter: value})
        if part is oscillator:
            return pack(changed, damper, frequency)
        return pack(oscillator, changed, frequency)

    try:
        for bound in span:
            pack_at(bound)
    except ValueError as error:
        raise ValueError(f"span = {shown(span)}: {error}") from None
    if parameter in LINEAR:
        return pack_at, value, (least, most)
    return (lambda x: pack_at(np.exp(x))), np.log(value), (np.log(least), np.log(most))
