"""Families of systems that differ in one parameter, in which branches of orbits are followed."""

from dataclasses import replace

import numpy as np

from impact_damper.system.packed import DASHPOT
from impact_damper.system.parameters import Damper, Oscillator, check_span, pack, shown

# Owner of each parameter that a branch can be followed in; all but the frequency and the
# restitution are followed by their logarithm.
PARAMETERS = {
    "frequency": None,
    "damping": Oscillator,
    "mass_ratio": Damper,
    "clearance": Damper,
    "restitution": Damper,
    "contact_stiffness": Damper,
}
LINEAR = ("frequency", "restitution")


def family_of(oscillator, damper, frequency, parameter, span):
    """Packed parameters by the parameter's coordinate along a branch, and that of the values.

    Raises
    ------
    ValueError
        If there is no such parameter, or its value lies outside the span.
    """
    pack(oscillator, damper, frequency)
    if not isinstance(parameter, str) or parameter not in PARAMETERS:
        allowed = ", ".join(PARAMETERS)
        raise ValueError(f"parameter = {shown(parameter)}: must be one of {allowed}")
    owner = PARAMETERS[parameter]
    if owner is Damper and damper is None:
        raise ValueError(f"parameter = {parameter!r}: there is no damper to change")
    given = {None: None, Oscillator: oscillator, Damper: damper}[owner]
    value = frequency if owner is None else getattr(given, parameter)
    least, most = check_span("span", span)
    if not least <= value <= most:
        raise ValueError(f"span = {shown(span)}: must hold {parameter} = {value:g}")
    pack_at = _pack_by(oscillator, damper, frequency, parameter)
    try:
        for bound in (least, most):
            pack_at(bound)
    except ValueError as error:
        raise ValueError(f"span = {shown(span)}: {error}") from None
    if parameter in LINEAR:
        return pack_at, value, (least, most)
    return (lambda x: pack_at(np.exp(x))), np.log(value), (np.log(least), np.log(most))


def _pack_by(oscillator, damper, frequency, parameter):
    """Packed parameters as a function of one of them."""

    def pack_at(value):
        if parameter == "frequency":
            return pack(oscillator, damper, value)
        if parameter == "damping":
            return pack(replace(oscillator, damping=value), damper, frequency)
        if parameter == "restitution":
            # Its derivative at 1 is taken from both sides.
            p = pack(oscillator, replace(damper, restitution=min(value, 2 - value)), frequency)
            p[DASHPOT] *= np.sign(1 - value)
            return p
        return pack(oscillator, replace(damper, **{parameter: value}), frequency)

    return pack_at
