"""All branches of periodic orbits of a response, as one labelled dataset.

A branch is a curve of orbits along which the forcing frequency varies. Orbits may be stable or not,
of any period, and touch the walls in any sequence.
"""

import sys
from collections import Counter

import numpy as np
import xarray as xr
from tqdm import tqdm

from impact_damper.data.datasets import dataset, flag
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.other_branches import follow_others
from impact_damper.orbits.random_search import COUNT, stable_orbits
from impact_damper.orbits.shooting import find_orbit
from impact_damper.stages.branch_datasets import (
    branches_dataset,
    leaving_variables,
    torus_variables,
)
from impact_damper.system.bounds import FREQUENCY_RANGE, shown
from impact_damper.system.checks import check_frequency, check_span
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.system.parameters import describe

# `complete_branches` follows a branch for at most MOST_POINTS orbits in one direction, for periods
# beyond LONG for at most MOST_LONG. Branches of periods beyond LONGEST are followed only as far as
# they are stable. All these branches wind through chaos.
MOST_POINTS, MOST_LONG, LONG, LONGEST = 4000, 2000, 7, 9


def complete_branches(oscillator, damper, frequencies, motions, *, progress=None):
    """Follow every branch of orbits over frequency on which a settled motion lies.

    Stable orbits that lie on none of these branches are searched for from random states. Wherever
    an orbit loses its symmetry or doubles its period, an orbit of the branch that leaves there is
    searched for. This branch is followed if its period is at most 3, or at most 4 beside a stable
    orbit; or, only as far as it is stable, if its orbits are stable there and its period is at most
    9. So is the branch at which one of these branches ends, up to period 4.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequencies : tuple of float
        Least and greatest frequency W, dimensionless.
    motions : list of xarray.Dataset
        Results of `frequency_response` or `subharmonic_suppression` for this oscillator and
        damper.
    progress : str, optional
        Title of a progress bar and of a summary on stderr; without it neither is shown.

    Returns
    -------
    xarray.Dataset
        As from `orbit_branch`, for all branches; `seeds`, the number of settled motions, and
        `seeds_lost`, the number of those motions from which Newton's method found no orbit;
        `searches` from random states, those that found a stable orbit, and new branches. For each
        loss of symmetry and period doubling what became of the branch that leaves there,
        `leaving_outcome`, and its orbit closest to the event. With a damper for each Neimark-Sacker
        point what splits off there, `torus_kind`, and the rotation number of a stable torus. Mirror
        images count as one branch. Motions without contacts are left out if there is a damper,
        because they are motions of the free oscillator.

    Raises
    ------
    TypeError, ValueError
        If an argument is of another type or out of range.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> response = idm.frequency_response(oscillator, damper, [1.95, 2.0], starts=8)
    >>> found = idm.complete_branches(oscillator, damper, (1.9, 2.1), [response])
    >>> found.sizes["branch"]
    1
    """
    frequencies = check_span("frequencies", frequencies, **FREQUENCY_RANGE)
    if not isinstance(motions, list) or not all(isinstance(each, xr.Dataset) for each in motions):
        raise TypeError(f"motions = {shown(motions)}: must be a list of datasets of motions")

    packed = pack(oscillator, damper, frequencies[0])

    def family(value):
        p = packed.copy()
        p[FREQUENCY] = check_frequency(value)
        return p

    def follow(orbit, value, stable=False):
        most = MOST_POINTS if orbit.periods <= LONG else MOST_LONG
        stable = stable or orbit.periods > LONGEST
        return follow_branch(family, orbit, value, frequencies, most, stable=stable)

    branches, lost = [], 0
    seeds = sorted(_seeds(motions, damper), key=lambda seed: seed[:3])
    with tqdm(seeds, desc=progress, disable=progress is None, mininterval=1.0) as bar:
        for period, frequency, _, state in bar:
            orbit = find_orbit(family(frequency), state, period)
            if not orbit.converged or orbit.repeats_sooner():
                lost += 1
            elif not any(branch.holds(orbit, frequency) for branch in branches):
                branches.append(follow(orbit, frequency))
                bar.set_postfix(branches=len(branches))
    settled = len(branches)
    stable = list(stable_orbits(family, damper, frequencies))
    for value, orbit in stable:
        if not any(branch.holds(orbit, value) for branch in branches):
            branches.append(follow(orbit, value))
    searches = {"searches": COUNT, "searches_stable": len(stable)}
    searches["searches_new"] = len(branches) - settled
    others = follow_others(branches, follow)
    if progress is not None:
        tqdm.write(f"{progress}: {_summary(branches, len(seeds), lost)}", file=sys.stderr)
    parameters = describe(oscillator, damper) | {"parameter": "frequency"}
    data = branches_dataset(branches, float, parameters, "Branches of periodic orbits")
    counts = {"seeds": len(seeds), "seeds_lost": lost}
    counts |= searches | leaving_variables(others)
    counts |= torus_variables(branches) if damper is not None else {}
    return data.assign(dataset(counts, {}, parameters, data.attrs["title"]).variables)


def _summary(branches, seeds, lost):
    """Return a line with the numbers of motions, branches, orbits, events and ends of branches."""

    def listed(names):
        counts = Counter(names)
        return ", ".join(f"{name} {counts[name]}" for name in sorted(counts)) or "none"

    events = listed(event.kind for branch in branches for _, event in branch.events)
    ends = listed(end for branch in branches for end in branch.ends)
    orbits = sum(len(branch.points) for branch in branches)
    unlocated = sum(branch.lost for branch in branches)
    return (
        f"{seeds} motions, {lost} of them without an orbit; {len(branches)} branches with "
        f"{orbits} orbits; events: {events}; not located: {unlocated}; ends: {ends}"
    )


def _seeds(motions, damper):
    """Yield period, frequency, max |Z1| and state of each settled motion in the datasets."""
    for data in motions:
        chosen = data["outcome"].values == flag("outcome", "settled")
        if damper is not None:
            chosen &= data["contacts"].values > 0
        for row, column in zip(*np.nonzero(chosen), strict=True):
            motion = data.isel(frequency=row, motion=column)
            yield (
                int(motion["period"]),
                float(motion["frequency"]),
                float(motion["maximum_displacement"]),
                motion["state"].values,
            )
