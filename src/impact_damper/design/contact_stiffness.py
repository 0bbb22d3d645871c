"""Stiffness of the linear spring that replaces a contact by Hertz's theory."""

import json
from dataclasses import replace

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled, shown_variable
from impact_damper.model.bounds import shown
from impact_damper.model.dampers import MachineDamper
from impact_damper.model.machine import Machine, describe_si
from impact_damper.motions.simulate import COMPONENTS, simulate
from impact_damper.motions.steady import steady_motion

# Search for the stiffness.
# MOST_MOTIONS: largest number of motions that are computed.
# AGREED: the search has converged when the relative change of the stiffness is smaller.
MOST_MOTIONS = 30
AGREED = 1e-6


def hertz_stiffness(machine, damper, frequency, state=(0.0, 0.0, 0.0, 0.0), *, settling=None):
    """Find the linear contact stiffness that replaces Hertz's contact in a steady motion.

    The linear spring has the same largest compression as Hertz's contact in the fastest impact of
    the motion. Its stiffness grows with the speed of impact, and the speed of impact depends on the
    stiffness. Therefore stiffness and motion are computed alternately until they agree. The first
    stiffness is computed for the speed at which the loose mass crosses the gap in half a forcing
    cycle. Each motion starts from a state of the motion before.

    Parameters
    ----------
    machine : Machine
    damper : MachineDamper
        It must have a `contact`.
    frequency : float
        Forcing frequency, Hz.
    state : sequence of 4 floats
        State at time 0 that leads to the first motion, m and m/s.
    settling : Settling, optional

    Returns
    -------
    xarray.Dataset
        `hertz_stiffness` (N/m), for use in `dataclasses.replace(damper, contact=None,
        contact_stiffness=...)`; speed, compression, force and duration of the fastest impact of the
        motion; the largest displacement of the motion; the number of computed motions; and
        `hertz_status`, how the search ended. Unknown numbers are NaN.

    Raises
    ------
    TypeError, ValueError
        If an argument has the wrong type or is out of range; the message names it.

    Examples
    --------
    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.05, force=40)
    >>> nylon = idm.Material("3 GPa", 0.4)
    >>> ball = idm.HertzContact("20 mm", nylon)
    >>> damper = machine.damper(mass=0.6, gap="3 mm", restitution=0.8, contact=ball)
    >>> contact = idm.hertz_stiffness(machine, damper, 20, (0, 0, 0, "0.3 m/s"))
    >>> f"{contact.hertz_stiffness.item():.3g} N/m"
    '3.34e+06 N/m'
    """
    if not isinstance(machine, Machine):
        raise TypeError(f"machine = {shown(machine)}: must be a Machine")
    if not isinstance(damper, MachineDamper) or damper.contact is None:
        raise TypeError(f"damper = {shown(damper)}: must be a MachineDamper with a contact")
    frequency = machine.check_frequency("frequency", frequency)
    mass = machine.mass * damper.mass / (machine.mass + damper.mass)
    impact = damper.contact.impact(2 * damper.gap * frequency, mass)
    stiffness, status, count = impact.stiffness, "not_consistent", 0
    speed = size = np.nan
    while status == "not_consistent" and count < MOST_MOTIONS:
        count += 1
        linear = replace(damper, contact=None, contact_stiffness=stiffness)
        steady = steady_motion(machine, linear, frequency, state, settling=settling)
        if not is_settled(steady):
            rests = float(steady["contacts"]) == 0
            status = "no_contact" if rests else "not_settled"
            break
        speed, state = _fastest_impact(machine, linear, frequency, steady)
        size = float(steady["maximum_displacement"])
        if speed == 0:
            status = "no_contact"
            break
        impact = damper.contact.impact(speed, mass)
        if abs(impact.stiffness / stiffness - 1) < AGREED:
            status = "consistent"
        stiffness = impact.stiffness
    known = np.isfinite(speed) and speed > 0
    data = {
        "hertz_status": flag("hertz_status", status),
        "hertz_iterations": count,
        "hertz_stiffness": stiffness if known else np.nan,
        "hertz_displacement": size,
        "impact_speed": speed,
        "impact_compression": 1e3 * impact.compression if known else np.nan,
        "impact_force": impact.force if known else np.nan,
        "impact_duration": impact.duration if known else np.nan,
    }
    labelled = dataset({}, {}, {"frequency": frequency}, "Contact after Hertz")
    labelled = labelled.assign({name: shown_variable(name, value) for name, value in data.items()})
    return labelled.assign_attrs(machine=json.dumps(describe_si(machine, damper), sort_keys=True))


def _fastest_impact(machine, damper, frequency, steady):
    """Return the largest speed of impact (m/s) of a steady motion, and a state of the motion.

    The returned state (m, m/s) is at the beginning of a forcing cycle. `steady` is the dataset from
    `steady_motion`. Its state is a quarter of a forcing cycle after the beginning of a cycle.
    """
    run = simulate(
        machine,
        damper,
        frequency,
        steady["state"].values,
        periods=int(steady["period"]) + 0.75,
        start=0.25 / frequency,
    )
    speed = float(np.max(np.abs(run["approach_velocity"].values), initial=0.0))
    last = [run[name].values[-1] for name in COMPONENTS]
    return speed, [value * unit for value, unit in zip(last, (1e-3, 1, 1e-3, 1), strict=True)]
