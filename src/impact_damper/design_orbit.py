"""The true quiet orbit at a design point, stable or not.

Harmonic balance designs a damper for the peak frequency. The orbit it stands for may be unstable
there, where no simulation finds it: with heavy damping every motion settles on it, and from there
it is followed in the damping h down to that of the oscillator.
"""

from dataclasses import replace

import numpy as np

from impact_damper import ensemble
from impact_damper.branches import follow_branch
from impact_damper.datasets import dataset, is_settled
from impact_damper.harmonic_balance import peak_frequency
from impact_damper.motions import random_states
from impact_damper.parameters import check_damper, describe, pack
from impact_damper.periodic import branches_dataset, family_of
from impact_damper.shooting import find_orbit

HEAVY = 2.0


def design_orbit(oscillator, damper, *, starts=24, radius=2.0, seed=1995, settling=None):
    """The quiet orbit at the peak frequency Wp of rule (19), followed in the damping h.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    starts : int
        Random starts with heavy damping, h = 2 or twice that of the oscillator.
    radius : float
        Radius of the ball from which they are drawn, within the gap.
    seed : int
    settling : Settling, optional

    Returns
    -------
    xarray.Dataset
        As of `periodic.orbit_branch` in the damping, from that of the oscillator up to the heavy
        one, and `peak_frequency`. Without branches if no start became an orbit of period 1 with
        two contacts.

    Raises
    ------
    TypeError, ValueError
        If there is no damper, or an argument is out of range.
    """
    check_damper(damper)
    peak = peak_frequency(oscillator)
    heavy = replace(oscillator, damping=min(max(HEAVY, 2 * oscillator.damping), 10.0))
    p = pack(heavy, damper, peak)
    states = random_states(starts, radius, damper, seed)
    records = ensemble.settle(np.tile(p, (starts, 1)), states, settling or ensemble.Settling())
    quiet = records[is_settled(records) & (records["period"] == 1) & (records["contacts"] == 2)]
    branches = []
    if len(quiet):
        state = quiet[np.argmin(quiet["maximum_displacement"])]["state"]
        span = oscillator.damping, heavy.damping
        family, value, span = family_of(heavy, damper, peak, "damping", span)
        branches = [follow_branch(family, find_orbit(p, state), value, span)]
    made = describe(oscillator, damper) | {"parameter": "damping", "frequency": peak}
    data = branches_dataset(branches, np.exp, made, "Quiet orbit at the design point over damping")
    return data.assign(dataset({"peak_frequency": peak}, {}, made, "").variables)
