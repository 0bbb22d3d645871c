"""The exact quiet orbit at a design point, stable or not.

Harmonic balance designs a damper for the peak frequency. The orbit that its solution approximates
may be unstable, so that no simulation finds it. With heavy damping every motion settles on the
orbit, which is then followed down to the damping h of the oscillator.
"""

from dataclasses import replace

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.motions import ensemble
from impact_damper.motions.simulate import random_states
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit
from impact_damper.stages.branches import branches_dataset
from impact_damper.system.families import family_of
from impact_damper.system.packed import pack
from impact_damper.system.parameters import check_damper, describe
from impact_damper.system.settling import check_settling
from impact_damper.theory.design_rule import peak_frequency

# Heavy damping h; twice that of the oscillator if this is more.
HEAVY = 2.0


def design_orbit(oscillator, damper, *, starts=24, radius=2.0, seed=1995, settling=None):
    """Find the quiet orbit at the peak frequency Wp of rule (19), and follow it in the damping h.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    starts : int
        Number of random starts with heavy damping.
    radius : float
        Radius of the ball from which starts are drawn, within the gap.
    seed : int
    settling : Settling, optional

    Returns
    -------
    xarray.Dataset
        As from `branches.orbit_branch` in the damping, from that of the oscillator up to the heavy
        one; `design_orbit_status`, whether the orbit was found and followed to the oscillator; over
        `design_start` the outcomes of the same starts with the damping of the oscillator; and
        `peak_frequency`.

    Raises
    ------
    TypeError, ValueError
        If there is no damper, or an argument is out of range.
    """
    check_damper(damper)
    settling = check_settling(settling)
    peak = peak_frequency(oscillator)
    heavy = replace(oscillator, damping=min(max(HEAVY, 2 * oscillator.damping), 10.0))
    states = random_states(starts, radius, damper, seed)
    branches, status = [], "no_start"
    p = pack(heavy, damper, peak)
    records = ensemble.settle(np.tile(p, (starts, 1)), states, settling)
    quiet = records[is_settled(records) & (records["period"] == 1) & (records["contacts"] == 2)]
    if len(quiet):
        orbit = find_orbit(p, quiet[np.argmin(quiet["maximum_displacement"])]["state"])
        span = oscillator.damping, heavy.damping
        family, value, span = family_of(heavy, damper, peak, "damping", span)
        branches = [follow_branch(family, orbit, value, span)] if orbit.converged else []
        reached = branches and np.isclose(branches[0].points[0].value, span[0], rtol=1e-9)
        status = "found" if reached else "not_followed"
    runs = ensemble.settle(np.tile(pack(oscillator, damper, peak), (starts, 1)), states, settling)
    made = describe(oscillator, damper) | {"parameter": "damping", "frequency": peak}
    title = "Quiet orbit at the design point over damping"
    others = {
        "peak_frequency": peak,
        "design_orbit_status": flag("design_orbit_status", status),
        "design_run_outcome": runs["outcome"],
        "design_run_displacement": runs["maximum_displacement"],
    }
    data = branches_dataset(branches, np.exp, made, title)
    return data.assign(dataset(others, {}, made, title).variables)
