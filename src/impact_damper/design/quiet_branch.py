"""The quiet orbit of a design (symmetric, one contact at each wall in a cycle) over the gap."""

import numpy as np
import xarray as xr

from impact_damper.data.datasets import decode, flag
from impact_damper.design.cells import Cell, run
from impact_damper.design.task import labelled
from impact_damper.model.families import family_of
from impact_damper.motions.records import is_symmetric_pair
from impact_damper.motions.strobe_map import STROBE
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.orbit import Orbit
from impact_damper.orbits.shooting import find_orbit

GAP_SPAN = (0.4, 2.0)  # least and greatest gap of the branch, divided by the gap of the design


def follow_quiet_orbit(task, choice, progress=None) -> xr.Dataset:
    """Return a dataset of the quiet orbit over the gap, at choice["branch_frequency"] (Hz)."""
    gap, frequency = float(choice["design_gap"]), float(choice["branch_frequency"])
    orbit = quiet_orbit(task, gap, frequency)
    cliff = float(choice["lost_gap"][1]) if decode(choice["lost_kind"])[1] == "jump" else np.inf
    return over_gap(task, gap, frequency, orbit, cliff)


def quiet_orbit(task, gap, frequency) -> Orbit | None:
    """Return the smallest quiet orbit at a gap (mm) and a frequency (Hz), or None if not found."""
    cell = Cell(1e-3 * gap, frequency)
    records = run(task, [cell], task.effort.starts, ("orbit",)).records[0]
    pairs = records[is_symmetric_pair(records)]
    if len(pairs) == 0:
        return None
    state = pairs["state"][np.argmin(pairs["maximum_displacement"])]
    orbit = find_orbit(task.packed(*cell), state, 1, STROBE)
    return orbit if orbit.converged else None


def over_gap(task, gap, frequency, orbit, cliff) -> xr.Dataset:
    """Return the branch of `orbit` over the gap. `cliff`: gap (mm) of the basin cliff, or inf."""
    gaps = sizes = moduli = np.empty(0)
    if orbit is not None:
        oscillator, damper, turning = task.system(1e-3 * gap, frequency)
        span = tuple(damper.clearance * end for end in GAP_SPAN)
        family, value, span = family_of(oscillator, damper, turning, "clearance", span)
        branch = follow_branch(family, orbit, value, span)
        gaps = 2e3 * task.scales.to_si(np.exp(branch.values), "clearance")
        sizes = task.millimetres(branch.displacements)
        moduli = np.array([abs(point.orbit.multipliers[0]) for point in branch.points])
    best, least, beyond = np.nan, np.nan, "no_orbit"
    if (moduli < 1).any():
        k = int(np.argmin(np.where(moduli < 1, sizes, np.inf)))
        best, least = gaps[k], sizes[k]
        beyond = "yes" if best >= cliff else "no"
    values = {
        "gap_of_orbit": gaps,
        "displacement_by_gap": sizes,
        "modulus_by_gap": moduli,
        "best_orbit_gap": best,
        "best_orbit_displacement": least,
        "best_orbit_beyond": flag("best_orbit_beyond", beyond),
    }
    return labelled(values)
