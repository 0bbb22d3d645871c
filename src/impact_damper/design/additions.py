"""Additions to a design: datasets computed after the decision whether to build the damper."""

from dataclasses import replace

import numpy as np
import xarray as xr

from impact_damper.data.datasets import named
from impact_damper.data.shares import starts_needed
from impact_damper.design.absorbers import SHARES, absorber_responses
from impact_damper.design.cells import Cell, run
from impact_damper.design.chosen_motions import response_and_costs
from impact_damper.design.costs import measured_costs
from impact_damper.design.promise import Promise, factor_sets
from impact_damper.design.quiet_branch import follow_quiet_orbit
from impact_damper.design.search import search
from impact_damper.design.shocks import shocks
from impact_damper.design.task import NOMINAL, VARIED, labelled
from impact_damper.design.transients import transients
from impact_damper.motions.strobe_map import strobe_time

FREQUENCIES = 5  # evenly spaced frequencies of `force_map`, to which `Task.few` adds others
HEAVIER = 2.0  # loose mass of the heavier damper, divided by the loose mass of the damper
WATCHED = 100  # number of cycles in which the contact force is measured without a period


def force_map(task, decision, progress=None) -> xr.Dataset:
    """Return a map of the displacement bound over forcing frequency and size of the excitation."""
    critical = float(decision["promised_frequency"])
    frequencies, shares = task.few(FREQUENCIES, critical), np.array(SHARES)
    sets = np.tile(NOMINAL, (len(shares), 1))
    sets[:, VARIED.index("force")] = shares
    gap, count = 1e-3 * float(decision["design_gap"]), starts_needed(task.share)
    given = {"count": count, "frequencies": frequencies, "progress": progress}
    found = Promise(task, gap, sets, ("forces",), **given)
    table = found.bounds.reshape(len(shares), len(frequencies)).T
    values = {"force_map_displacement": table}
    return labelled(values, operating_frequency=frequencies, force_share=shares)


def other_masses(task, decision, progress=None) -> xr.Dataset:
    """Return a dataset that compares the damper of the task with a heavier damper.

    The dataset is empty if the damper of the task is worth building and keeps the displacement
    limit. It is also empty if the heavier loose mass exceeds the mass of the machine.
    """
    fails = named(decision, "decision") == "do_not_build"
    fails |= named(decision, "limit_status") == "missed"
    mass = HEAVIER * task.mass
    if not fails or mass > task.machine.mass:
        return labelled({})
    other = replace(task, mass=mass, contact=task.contact_stiffness, gap=None)
    gap = search(other, progress, rounds=1).choose().gap
    given = factor_sets(other, gap), ("masses", 1)
    promise = Promise(other, 1e-3 * gap, *given, progress=progress).refined()
    this = float(decision["design_gap"]), float(decision["promised_displacement"])
    rows = [
        (task.mass, *this, _force(task, this[0], float(decision["promised_frequency"]))),
        (mass, gap, promise.size, _force(other, gap, promise.worst[1])),
    ]
    masses, gaps, sizes, forces = np.array(rows).T
    values = {"other_gap": gaps, "other_displacement": sizes, "other_force": forces}
    return labelled(values, other_mass=masses)


def _force(task, gap, frequency):
    cell = Cell(1e-3 * gap, frequency)
    motions = run(task, [cell], task.effort.starts, ("masses",))
    k, p = int(np.argmax(motions.peaks[0])), task.packed(*cell)
    if np.isinf(motions.peaks[0, k]):
        return np.nan
    periods = int(motions.records["period"][0, k]) or WATCHED
    costs = measured_costs(p, motions.states[0, k].copy(), strobe_time(p), periods)
    return task.scales.to_si(costs["contact_force"], "force")


def competitors(task, decision, progress=None) -> xr.Dataset:
    """Return displacements with no absorber, with a tuned absorber, and with the given absorber."""
    band = task.absorber_band
    found = absorber_responses(task.machine, task.mass, task.grid, band=band, own=task.absorber)
    return found.assign_coords(labelled({}, frequency=task.grid).coords)


ADDITIONS = {
    "response": response_and_costs,
    "orbits": follow_quiet_orbit,
    "forces": force_map,
    "masses": other_masses,
    "transients": transients,
    "shocks": shocks,
    "competitors": competitors,
}
