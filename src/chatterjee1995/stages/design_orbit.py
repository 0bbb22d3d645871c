"""The exact quiet orbit at the peak frequency Wp, followed from heavy damping."""

from dataclasses import replace

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.data.variables import register
from impact_damper.model.families import family_of
from impact_damper.model.packed import pack
from impact_damper.model.parameters import describe
from impact_damper.motions import ensemble
from impact_damper.motions.start_states import search_starts
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.orbit_branches import branches_dataset
from impact_damper.orbits.shooting import find_orbit
from impact_damper.theory.design_rule import peak_frequency

register(
    """
design_orbit_status | | | | whether the quiet orbit was followed from heavy damping
  : no_start 0, found 1, not_followed 2
design_run_outcome | design_start | | | outcome of a random start at the design point
  : outcome
design_run_displacement | design_start | displacement | max |Z1| | largest displacement from a start
    """
)

# Heavy damping is min(10, max(HEAVY, HEAVY_SHARE Wp, 2 h)), with the damping h of the oscillator.
HEAVY, HEAVY_SHARE = 2.0, 0.5


def design_orbit(oscillator, damper, *, starts=24, radius=None, seed=1995, settling):
    """Return a dataset: the quiet orbit at Wp as damping varies, and motions from many starts."""
    peak = peak_frequency(oscillator)
    damping = max(HEAVY, 2 * oscillator.damping, HEAVY_SHARE * peak)
    heavy = replace(oscillator, damping=min(damping, 10.0))
    search = search_starts(oscillator, [(damper, peak)], starts, radius, seed, settling)
    states = np.concatenate([search.random[0], search.placed[0]])
    branches, status = [], "no_start"
    p = pack(heavy, damper, peak)
    records = ensemble.settle(np.tile(p, (len(states), 1)), states, settling)
    quiet = records[is_settled(records) & (records["period"] == 1) & (records["contacts"] == 2)]
    if len(quiet):
        orbit = find_orbit(p, quiet[np.argmin(quiet["maximum_displacement"])]["state"])
        span = oscillator.damping, heavy.damping
        family, value, span = family_of(heavy, damper, peak, "damping", span)
        branches = [follow_branch(family, orbit, value, span)] if orbit.converged else []
        reached = branches and np.isclose(branches[0].points[0].value, span[0], rtol=1e-9)
        status = "found" if reached else "not_followed"
    p = pack(oscillator, damper, peak)
    runs = ensemble.settle(np.tile(p, (len(states), 1)), states, settling)
    made = describe(oscillator, damper) | {"parameter": "damping", "frequency": peak}
    title = "Quiet orbit at the design point over damping"
    others = {
        "peak_frequency": peak,
        "design_orbit_status": flag("design_orbit_status", status),
        "design_run_outcome": runs["outcome"],
        "design_run_displacement": runs["maximum_displacement"],
    } | search.variables()
    data = branches_dataset(branches, np.exp, made, title)
    return data.assign(dataset(others, {}, made, title).variables)
