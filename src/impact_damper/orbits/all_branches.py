"""All branches of periodic orbits of a response, as one labelled dataset.

A branch is the curve of the periodic orbits over the forcing frequency W. Orbits may be stable or
not, of any period, and touch the walls in any sequence. Z1 is the displacement of the primary mass.
"""

import sys
from collections import Counter

import numpy as np
import xarray as xr
from tqdm import tqdm

from impact_damper.data.datasets import flag, from_si
from impact_damper.model.arguments import read_span, read_system
from impact_damper.model.bounds import FREQUENCY_RANGE, shown
from impact_damper.model.checks import check_frequency
from impact_damper.model.names import names_arguments
from impact_damper.model.packed import FREQUENCY
from impact_damper.orbits.branch_datasets import branches_dataset
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit
from impact_damper.orbits.switching import follow_others

# A branch of period 1 is followed to its ends. Any other branch is left once its unstable orbits in
# a row last BEYOND forcing cycles together: farther on, branches wind through chaos for up to 20000
# orbits, and the stable parts there are narrower than 0.01 in frequency.
BEYOND = 300


@names_arguments
def complete_branches(system, damper, frequencies, motions, *, progress=None):
    """Follow every branch of orbits over frequency on which a settled motion lies.

    A branch that leaves next to stable orbits, where an orbit loses its symmetry or doubles its
    period, is followed too if its orbits are stable where it begins, or if the first branch has the
    period 1 or 3. A branch of period 1 is followed to its ends, any other until 300 forcing cycles
    of unstable orbits lie behind each other.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
    frequencies : tuple of float
        Least and greatest frequency W, or Hz for a machine.
    motions : list of xarray.Dataset
        Results of `frequency_response` or `subharmonic_suppression` for this system and
        damper.
    progress : str, optional
        Title of a progress bar and of a summary on stderr; without it neither is shown.

    Returns
    -------
    xarray.Dataset
        The variables of `orbit_branch` for all branches; `seeds`, the number of settled motions,
        and `seeds_lost`, the number of those from which Newton's method found no orbit.

        A branch and its mirror image count as one. With a damper, motions without contacts are left
        out, because they are motions of the oscillator without the damper.

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
    model = read_system(system, damper)
    damper = model.damper
    frequencies = read_span(
        model.scales, "frequencies", frequencies, "frequency", **FREQUENCY_RANGE
    )
    if not isinstance(motions, list) or not all(isinstance(each, xr.Dataset) for each in motions):
        raise TypeError(f"motions = {shown(motions)}: must be a list of datasets of motions")

    motions = [from_si(each, model.scales) for each in motions]
    packed = model.pack(frequencies[0])

    def family(value):
        p = packed.copy()
        p[FREQUENCY] = check_frequency(value)
        return p

    def follow(orbit, value):
        beyond = np.inf if orbit.periods == 1 else BEYOND / orbit.periods
        return follow_branch(family, orbit, value, frequencies, beyond)

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
    follow_others(branches, follow)
    if progress is not None:
        tqdm.write(f"{progress}: {_summary(branches, len(seeds), lost)}", file=sys.stderr)
    parameters = model.describe() | {"parameter": "frequency"}
    title, counts = "Branches of periodic orbits", {"seeds": len(seeds), "seeds_lost": lost}
    return branches_dataset(branches, float, parameters, title, model, counts)


def _summary(branches, seeds, lost):
    """Return a line with the numbers of motions, branches, orbits, events and ends of branches.

    `seeds` is the number of motions, and `lost` the number of those from which no orbit was found.
    """

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
