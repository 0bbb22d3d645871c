"""Numbers that test claims 9 and 11, on the optimum: the clearance d0 with the least max |Z1|."""

import itertools

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits
from chatterjee1995.reading.bands import suppression_band
from chatterjee1995.reading.datasets import Missing

AWAY = 0.1  # the rise of max |Z1| is read at (1 - AWAY) and (1 + AWAY) times the optimum d0


def excess(datasets):
    """Return numbers that test claim 9: the optimum d0 is slightly more than (7) predicts."""
    groups = _sweeps(datasets, "damping", restitution=1)
    members = [sweep for group in groups.values() for sweep in group]
    over = [float(sweep.optimum_clearance / sweep.analytical_optimum) - 1 for sweep in members]
    spreads, displaced = [], []
    for group in groups.values():
        sizes = [float(sweep.optimum_displacement) for sweep in group]
        spreads.append(np.max(sizes) / np.min(sizes) - 1)
    for sweep in members:
        damping, frequency = reading.parameters(sweep, "damping", "frequency")
        displaced.append(_displaced(sweep) * damping * frequency)  # divided by resonance, 1/(h W)
    return {
        "dampings": len(groups),
        "least": np.min(over),
        "most": np.max(over),
        "spread": np.max(spreads),
        "rise": np.max([_rise(sweep) for sweep in members]),
        "displaced": np.max(displaced),
    }


def _sweeps(datasets, *keys, **fixed):
    """Return groups of clearance sweeps as a dict: values of the parameters `keys` -> sweeps.

    Only sweeps whose parameters have the values `fixed` count. Groups of one sweep are left out.
    """
    groups = {}
    for sweep in datasets.get("optimum", {}).values():
        if all(reading.parameter(sweep, key) == value for key, value in fixed.items()):
            groups.setdefault(reading.parameters(sweep, *keys), []).append(sweep)
    groups = {group: members for group, members in groups.items() if len(members) > 1}
    if not groups:
        raise Missing("There are no sweeps of the stage optimum to compare")
    return groups


def _displaced(sweep):
    ends = float(sweep.optimum_clearance) * np.array([1 - AWAY, 1 + AWAY])
    size = np.interp(ends, sweep.clearance, sweep.quiet_displacement, left=np.nan, right=np.nan)
    return float(np.max(size))


def _rise(sweep):
    return _displaced(sweep) / float(sweep.optimum_displacement) - 1


def restitution(datasets):
    """Return numbers for claim 11: lower restitution widens the band and lowers the optimum d0."""
    names = (reading.BY_MASS[1], reading.INELASTIC)
    hard, soft = (suppression_band(datasets, name) for name in names)
    design = reading.get(datasets, "harmonic_balance", reading.BY_MASS[1])
    frequency = reading.within(design, *reading.band_edges(design)).frequency
    sharp, flat = (
        orbits.smallest_quiet(*orbits.of_curve(datasets, name), frequency)["size"].to_numpy()
        for name in names
    )
    groups = _sweeps(datasets, "damping", "frequency", "mass_ratio").values()
    steps = pd.DataFrame(step for group in groups for step in _restitution_steps(group))
    return {
        "band": soft.least_width / hard.width,
        "amplitude": float((flat / sharp).min()),
        "most": float((flat / sharp).max()),
        "clearance_least": steps.overall.min(),
        "clearance": steps.overall.max(),
        "step": steps.clearance.max(),
        "flat": steps.rise.max(),
    }


def _restitution_steps(group):
    group = sorted(group, key=lambda sweep: -reading.parameter(sweep, "restitution"))
    return [
        {
            "clearance": float(soft.optimum_clearance / hard.optimum_clearance),
            "rise": _rise(soft) / _rise(hard),
            "overall": float(group[-1].optimum_clearance / group[0].optimum_clearance),
        }
        for hard, soft in itertools.pairwise(group)
    ]
