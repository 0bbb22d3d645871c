"""A machine with its damper in SI units: responses, orbits, the best gap, and Hertz's contact.

The gap is the full play of the loose mass, twice the clearance d0.
"""

import json
from dataclasses import replace

import numpy as np
import xarray as xr

from impact_damper.data.datasets import dataset, flag, is_settled, variable
from impact_damper.data.variables import VARIABLES
from impact_damper.machine.arguments import takes_machine
from impact_damper.machine.dampers import MachineDamper
from impact_damper.machine.machine import Machine, describe_si
from impact_damper.machine.units import QUANTITIES
from impact_damper.motions.simulate import COMPONENTS, simulate
from impact_damper.motions.steady import steady_motion
from impact_damper.stages.branches import complete_branches
from impact_damper.stages.optimum import clearance_sweep
from impact_damper.stages.response import frequency_response
from impact_damper.system.bounds import shown

_complete_branches, _sweep, _response, _simulate, _steady_motion = map(
    takes_machine,
    (complete_branches, clearance_sweep, frequency_response, simulate, steady_motion),
)
# Search for a stiffness after Hertz: largest number of motions computed, and relative change of the
# stiffness below which the search has converged.
MOST_MOTIONS = 30
AGREED = 1e-6
# Variables that `machine_study` keeps from `clearance_sweep`, as functions of the gap.
SWEPT = (
    "quiet_displacement",
    "quiet_status",
    "largest_displacement",
    "optimum_clearance",
    "optimum_displacement",
    "optimum_kind",
    "near_clearance",
    "near_status",
    "rule_clearance",
)
BARE = {
    "followed_value": "bare_frequency",
    "orbit_displacement": "bare_displacement",
    "orbit_stability": "bare_stability",
    "orbit_branch": "bare_branch",
}


def machine_study(
    machine,
    damper,
    frequencies,
    frequency,
    gaps,
    *,
    starts=48,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Return motions of a machine with a damper, by frequency and, at one frequency, by gap.

    Parameters
    ----------
    machine : Machine
    damper : MachineDamper
    frequencies : sequence of float
        Increasing forcing frequencies, Hz.
    frequency : float
        Forcing frequency at which the gap is varied, Hz.
    gaps : sequence of float
        Increasing gaps, the full play, m.
    starts, seed, settling, workers, progress
        As in `response.frequency_response`, at each frequency and at each gap. The search is as
        wide as the machine (`start_states`).

    Returns
    -------
    xarray.Dataset
        In SI units. The motions found with the damper and the branches of orbits on which they lie
        (`frequency_response`, `complete_branches`); for each `bare_point` an orbit without the
        damper; for each `clearance` the quiet and the largest motion, and the share of starts that
        lead to the quiet one; the gap at which the quiet motion is smallest (`clearance_sweep`).
        The attribute `optimum` gives this gap in words.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it, in SI units.
    """
    searched = {"starts": starts, "seed": seed, "settling": settling, "workers": workers}
    span = float(frequencies[0]), float(frequencies[-1])
    motions = _response(machine, damper, frequencies, **searched, progress=progress)
    # `branch` is a variable of the motions
    orbits = _complete_branches(machine, damper, span, [motions]).rename_dims(branch="curve")
    alone = _response(machine, None, frequencies, **searched)
    alone = _complete_branches(machine, None, span, [alone])
    bare = xr.Dataset({new: _labelled(new, alone[old].values) for old, new in BARE.items()})
    clearances = np.asarray(gaps, float) / 2
    sweep = _sweep(machine, damper, frequency, clearances, **searched, progress=progress)
    parts = [motions, orbits, bare, sweep[list(SWEPT)], _over_gap(sweep, frequency)]
    merged = xr.merge(parts, compat="override", join="outer", combine_attrs="override")
    return merged.assign_attrs(title="A machine with its damper", optimum=sweep.attrs["optimum"])


def _labelled(name, values):
    """Return a variable, its attribute `units` being the unit in which datasets show it."""
    found = variable(name, values)
    found.attrs["units"] = QUANTITIES[VARIABLES[name].quantity].label
    return found


def _over_gap(sweep, frequency):
    """Return gaps (full play), the frequency, and shares of starts that reach the quiet motion."""
    quiet = sweep["maximum_displacement"] == sweep["quiet_displacement"]
    counts = sweep["share"].where(quiet & is_settled(sweep), 0).max("motion")
    found = {
        "swept_frequency": frequency,
        "gap": 2 * sweep["clearance"].values,
        "optimum_gap": 2 * sweep["optimum_clearance"].values,
        "quiet_share": counts.values / sweep.sizes["start"],
    }
    return xr.Dataset({name: _labelled(name, values) for name, values in found.items()})


def hertz_stiffness(machine, damper, frequency, state=(0.0, 0.0, 0.0, 0.0), *, settling=None):
    """Find the linear contact stiffness that replaces Hertz's contact in a steady motion.

    The linear spring has the same largest compression as Hertz's contact. Its stiffness grows with
    the speed of impact, and this speed depends on the stiffness: stiffness and motion are computed
    in turn until they agree. The first speed is that at which the loose mass crosses the gap in
    half a forcing period; each motion starts from the state of the one before.

    Parameters
    ----------
    machine : Machine
    damper : MachineDamper
        With a `contact`.
    frequency : float
        Forcing frequency, Hz.
    state : sequence of 4 floats
        State at time 0 from which the first motion settles, m and m/s.
    settling : Settling, optional

    Returns
    -------
    xarray.Dataset
        `hertz_stiffness` (N/m), for `dataclasses.replace(damper, contact=None,
        contact_stiffness=...)`; speed, compression, force and duration of the fastest impact of the
        motion; its largest displacement; `hertz_status` says how the search ended. Numbers that
        are not known are NaN.

    Raises
    ------
    TypeError, ValueError
        If an argument is not of its kind or out of range; the message names it.
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
        steady = _steady_motion(machine, linear, frequency, state, settling=settling)
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
    found = dataset({}, {}, {"frequency": frequency}, "Contact after Hertz")
    found = found.assign({name: _labelled(name, value) for name, value in data.items()})
    return found.assign_attrs(machine=json.dumps(describe_si(machine, damper), sort_keys=True))


def _fastest_impact(machine, damper, frequency, steady):
    """Return the largest speed of impact of a steady motion, m/s, and its state at time 0.

    The state in `steady` is that at a quarter of a forcing period.
    """
    run = _simulate(
        machine,
        damper,
        frequency,
        steady["state"].values,
        periods=int(steady["period"]) + 0.75,
        start=0.25 / frequency,
    )
    speed = float(np.max(np.abs(run["approach_velocity"].values), initial=0.0))
    last = [run[name].values[-1] for name in COMPONENTS]
    return speed, [value * share for value, share in zip(last, (1e-3, 1, 1e-3, 1), strict=True)]
