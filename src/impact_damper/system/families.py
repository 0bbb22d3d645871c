"""Families of systems along one parameter, for the continuation of branches of orbits."""

from dataclasses import replace

import numpy as np

from impact_damper.system.bounds import shown
from impact_damper.system.checks import check_span
from impact_damper.system.names import nearest
from impact_damper.system.packed import DASHPOT, FORCE, SHAKER, UNBALANCE, pack
from impact_damper.system.parameters import Damper, Oscillator

# Parameters that can vary along a branch, and the dataclass of each; the frequency is in none. The
# coordinate of a parameter, in which branches are continued, is its logarithm, or for the
# parameters in LINEAR the parameter itself.
PARAMETERS = {
    "frequency": None,
    "damping": Oscillator,
    "cubic": Oscillator,
    "force": Oscillator,
    "unbalance": Oscillator,
    "mass_ratio": Damper,
    "clearance": Damper,
    "restitution": Damper,
    "contact_stiffness": Damper,
}
LINEAR = ("frequency", "cubic", "force", "unbalance", "restitution")
# Index, in the packed array, of each part of the forcing amplitude.
FORCING = {"force": FORCE, "unbalance": UNBALANCE, "shaker": SHAKER}


def family_of(oscillator, damper, frequency, parameter, span):
    """Return the packed parameters as a function of the coordinate of one parameter.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
        W.
    parameter : str
        A key of PARAMETERS.
    span : sequence of float
        Least and greatest value of the parameter.

    Returns
    -------
    pack_at : callable
        Function from the coordinate to the packed parameters.
    here : float
        Coordinate of the system that is given.
    ends : tuple of float
        Coordinates of the ends of the span.

    Raises
    ------
    ValueError
        If there is no such parameter, or its value lies outside the span.
    """
    pack(oscillator, damper, frequency)
    if not isinstance(parameter, str) or parameter not in PARAMETERS:
        allowed = ", ".join(PARAMETERS) + nearest(parameter, PARAMETERS)
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
            if owner is not None:
                replace(given, **{parameter: bound})
            pack_at(bound)
    except ValueError as error:
        raise ValueError(f"span = {shown(span)}: {error}") from None
    if parameter in LINEAR:
        return pack_at, value, (least, most)
    return (lambda x: pack_at(np.exp(x))), np.log(value), (np.log(least), np.log(most))


def _pack_by(oscillator, damper, frequency, parameter):
    """Return the packed parameters as a function of the value of one parameter."""

    def pack_at(value):
        if parameter == "frequency":
            return pack(oscillator, damper, value)
        if parameter in FORCING:
            # The value may be negative, which `Oscillator` does not allow, so that finite
            # differences at 0 can be central.
            p = pack(oscillator, damper, frequency)
            p[FORCING[parameter]] = value
            return p
        if parameter in ("damping", "cubic"):
            return pack(replace(oscillator, **{parameter: value}), damper, frequency)
        if parameter == "restitution":
            # Beyond e = 1 the dashpot of 2 - e is taken with the opposite sign, so that finite
            # differences at 1 can be central.
            p = pack(oscillator, replace(damper, restitution=min(value, 2 - value)), frequency)
            p[DASHPOT] *= np.sign(1 - value)
            return p
        return pack(oscillator, replace(damper, **{parameter: value}), frequency)

    return pack_at
