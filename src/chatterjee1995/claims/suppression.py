"""The suppression band according to exact orbits and simulated chaotic motions.

The free resonance branch consists of the large motions of period 1 without the damper. A motion is
violent, called high in the names of functions, if its max |Z1| exceeds half of that on this branch.
The band is the range of the forcing frequency W in which no motion with the damper is violent.

Z1 is the displacement of the primary mass.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr

from chatterjee1995.claims import exact_orbits, extract


class Band(NamedTuple):
    """A suppression band according to exact and simulated motions.

    Attributes
    ----------
    lower, upper : float
        Edges in W, dimensionless.
    resolution : float
        Uncertainty of the lower edge, which lies between `lower` and `lower + resolution`. It is
        a step in W of the simulations if a motion that did not settle ends the band, otherwise 0.
    """

    lower: float
    upper: float
    resolution: float

    @property
    def width(self):
        """Largest width compatible with the data."""
        return self.upper - self.lower

    @property
    def least_width(self):
        """Smallest width compatible with the data."""
        return self.width - self.resolution


def high_motions(response, free):
    """Return the mask of the violent motions in a response.

    `response` is a dataset of the stage `response` with a damper: the motions found by simulation
    at each W. `free` holds the branches without damper.
    """
    frequency = response.frequency
    limit = exact_orbits.HALF * xr.DataArray(
        exact_orbits.resonance(free, frequency), {"frequency": frequency}
    )
    return extract.touching(response) & (response.maximum_displacement > limit)


def chaotic_high(response, free):
    """Return the mask of the frequencies at which a violent motion is chaotic."""
    return (high_motions(response, free) & extract.is_outcome(response, "chaotic")).any("motion")


def suppression_band(datasets, name):
    """Return the range of W without a violent motion, below the end of the free resonance branch.

    The lower edge is the larger of two frequencies: the upper end of the branches of stable violent
    orbits, and the last frequency of the response with a violent motion that did not settle. The
    latter is known only to within one step of the response's frequencies.

    Raises
    ------
    Missing
        If a dataset or the fold of the free resonance branch is missing.
    """
    branches, free = exact_orbits.of_curve(datasets, name)
    response = extract.get(datasets, "response", name)
    upper, _ = exact_orbits.resonance_fold(free)
    ends = [top for _, top in exact_orbits.ranges(exact_orbits.high(branches, free))]
    unsettled = high_motions(response, free) & extract.is_outcome(
        response, "quasi_periodic", "chaotic", "unresolved"
    )
    last = response.frequency.values[unsettled.any("motion").values]
    if not ends and not len(last):
        return Band(np.nan, upper, np.nan)
    lower = min(max([*ends, *last]), upper)
    following = response.frequency.values[response.frequency.values > max(last, default=np.inf)]
    resolution = max(min([*following[:1], upper]) - lower, 0.0) if len(last) else 0.0
    return Band(lower, upper, resolution)
