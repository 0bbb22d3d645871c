"""Additions to a decision, each a function of the task and the dataset of the decision."""

from dataclasses import replace

import numpy as np
import xarray as xr

from impact_damper.data.datasets import named
from impact_damper.data.shares import starts_needed
from impact_damper.design.absorbers import SHARES, absorber_responses
from impact_damper.design.cells import Cell
from impact_damper.design.chosen_motions import response_and_costs
from impact_damper.design.confirm import find_gap
from impact_damper.design.costs import measured_costs
from impact_damper.design.promise import Promise
from impact_damper.design.quiet_branch import follow_quiet_orbit
from impact_damper.design.task import NOMINAL, VARIED, labelled
from impact_damper.design.transients import transients
from impact_damper.motions.strobe_map import strobe_time

# Largest number of frequencies of the map over the force.
FREQUENCIES = 9
# Other mass divided by the nominal one: lighter if the damper does its task, otherwise heavier. For
# the other mass so many gaps are compared closely.
LIGHTER, HEAVIER, GAPS = 0.5, 2.0, 8
# Cycles over which the contact force of a motion that is not periodic is measured.
WATCHED = 100


def force_map(task, decision, progress=None) -> xr.Dataset:
    """Return the promised displacement, at nominal values, over frequency and force."""
    frequencies, shares = task.few(FREQUENCIES), np.array(SHARES)
    sets = np.tile(NOMINAL, (len(shares), 1))
    sets[:, VARIED.index("force")] = shares
    gap, count = 1e-3 * float(decision["design_gap"]), starts_needed(task.share)
    given = {"count": count, "frequencies": frequencies, "progress": progress}
    found = Promise(task, gap, sets, ("forces",), **given)
    table = found.bounds.reshape(len(shares), len(frequencies)).T
    values = {"force_map_displacement": table}
    return labelled(values, operating_frequency=frequencies, force_share=shares)


def other_masses(task, decision, progress=None) -> xr.Dataset:
    """Return this damper, and one of another mass that is designed as this one."""
    rows = [_row(task, decision)]
    fails = named(decision, "decision") == "do_not_build"
    fails |= named(decision, "limit_status") == "missed"
    mass = (HEAVIER if fails else LIGHTER) * task.mass
    if mass <= task.machine.mass:
        candidates = min(GAPS, task.effort.candidates)
        effort = replace(task.effort, starts=starts_needed(task.share), candidates=candidates)
        made = {"contact": task.contact_stiffness, "effort": effort, "gap": None}
        other = replace(task, mass=mass, **made)
        rows.append(_row(other, find_gap(other, progress)))
    masses, gaps, sizes, forces = np.array(sorted(rows)).T
    values = {"other_gap": gaps, "other_displacement": sizes, "other_force": forces}
    return labelled(values, other_mass=masses)


def _row(task, decision):
    """Return mass, gap, promised displacement and contact force (N) of a damper."""
    gap, frequency = float(decision["design_gap"]), float(decision["branch_frequency"])
    found = Promise(task, 1e-3 * gap, [NOMINAL], ("masses",), frequencies=[frequency])
    k = int(np.argmax(found.motions.peaks[0]))
    p, record = task.packed(*Cell(1e-3 * gap, frequency)), found.motions.records[0, k]
    force = np.nan
    if np.isfinite(found.motions.peaks[0, k]):
        periods = int(record["period"]) or WATCHED
        state = found.motions.states[0, k].copy()
        costs = measured_costs(p, state, strobe_time(p), periods)
        force = task.scales.to_si(costs["contact_force"], "force")
    return task.mass, gap, float(decision["promised_displacement"]), force


def competitors(task, decision, progress=None) -> xr.Dataset:
    """Return the responses of the machine alone and with a tuned absorber of the same mass."""
    band = task.absorber_band
    found = absorber_responses(
        task.machine, task.mass, task.grid, SHARES, band=band, own=task.absorber
    )
    return found.assign_coords(labelled({}, frequency=task.grid).coords)


ADDITIONS = {
    "response": response_and_costs,
    "orbits": follow_quiet_orbit,
    "forces": force_map,
    "masses": other_masses,
    "transients": transients,
    "competitors": competitors,
}
