"""One-parameter families of systems, for the continuation of branches of periodic orbits."""

from dataclasses import replace

import numpy as np

from impact_damper.model.bounds import shown
from impact_damper.model.checks import check_span
from impact_damper.model.names import nearest
from impact_damper.model.packed import DASHPOT, FORCE, SHAKER, UNBALANCE, pack
from impact_damper.model.parameters import Damper, Oscillator

# Parameters that can vary along a branch, each with the dataclass that holds it. No dataclass holds
# the frequency. A branch is continued in a coordinate: the parameter itself if it is in LINEAR,
# otherwise its logarithm.
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
# Index in the packed array (see `packed`) of each part of the forcing amplitude.
FORCING = {"force": FORCE, "unbalance": UNBALANCE, "shaker": SHAKER}


def family_of(oscillator, damper, frequency, parameter, span):
    """Return the packed parameters as a function of the coordinate of one parameter.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
        Forcing frequency W.
    parameter : str
        A key of PARAMETERS.
    span : sequence of float
        Least and greatest value of the parameter.

    Returns
    -------
    pack_at : callable
        Function from the coordinate to the packed parameters.
    coordinate : float
        Coordinate of the given system.
    ends : tuple of float
        Coordinates of the ends of the span.

    Raises
    ------
    ValueError
        If there is no such parameter, if its value lies outside the span, or if an end of the span
        is out of the bounds of the parameter.
    """
    pack(oscillator, damper, frequency)
    if not isinstance(parameter, str) or parameter not in PARAMETERS:
        allowed = ", ".join(PARAMETERS) + nearest(parameter, PARAMETERS)
        raise ValueError(f"parameter = {shown(parameter)}: must be one of {allowed}")
    owner = PARAMETERS[parameter]
    if owner is Damper and damper is None:
        raise ValueError(f"parameter = {parameter!r}: there is no damper to change")
    part = {None: None, Oscillator: oscillator, Damper: damper}[owner]
    value = frequency if owner is None else getattr(part, parameter)
    least, most = check_span("span", span)
    if not least <= value <= most:
        raise ValueError(f"span = {shown(span)}: must hold {parameter} = {value:g}")
    pack_at = _pack_by(oscillator, damper, frequency, parameter)
    try:
        for bound in (least, most):
            if owner is not None:
                replace(part, **{parameter: bound})
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
            # Central differences at 0 need negative values. `Oscillator` does not allow these, so
            # the value is written into the packed array.
            p = pack(oscillator, damper, frequency)
            p[FORCING[parameter]] = value
            return p
        if parameter in ("damping", "cubic"):
            return pack(replace(oscillator, **{parameter: value}), damper, frequency)
        if parameter == "restitution":
            # Central differences at e = 1 need values e > 1. For these the dashpot coefficient is
            # the negative of the coefficient for 2 - e.
            p = pack(oscillator, replace(damper, restitution=min(value, 2 - value)), frequency)
            p[DASHPOT] *= np.sign(1 - value)
            return p
        return pack(oscillator, replace(damper, **{parameter: value}), frequency)

    return pack_at
