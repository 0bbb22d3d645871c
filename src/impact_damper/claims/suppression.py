"""The suppression band by the motions that exist: exact orbits, and chaotic motions simulated."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from impact_damper.claims import exact, extract


class Band(NamedTuple):
    """A suppression band by the motions that exist: edges, and how far up the lower may lie."""

    lower: float
    upper: float
    resolution: float

    @property
    def width(self):
        """Largest width that the data allow."""
        return self.upper - self.lower

    @property
    def least_width(self):
        """Least width that the data allow."""
        return self.width - self.resolution


def high_motions(response, free):
    """Damped motions that exceed half of the free resonance branch."""
    frequency = response.frequency
    limit = exact.HALF * xr.DataArray(exact.resonance(free, frequency), {"frequency": frequency})
    return extract.touching(response) & (response.maximum_displacement > limit)


def chaotic_high(response, free):
    """Frequencies at which a high damped motion is chaotic."""
    return (high_motions(response, free) & extract.is_outcome(response, "chaotic")).any("motion")


def suppression_band(datasets, name):
    """Range below the fold of the free resonance branch without any high motion, or raise Missing.

    The lower edge is the upper end of the last branch of stable high orbits, or the last frequency
    of the response with a high motion that has not settled, of which all that is known is that
    it is gone at the next one.
    """
    branches, free = exact.of_curve(datasets, name)
    response = extract.get(datasets, "response", name)
    upper, _ = exact.resonance_fold(free)
    ends = [top for _, top in exact.ranges(exact.high(branches, free))]
    unsettled = high_motions(response, free) & extract.is_outcome(response, "chaotic", "unresolved")
    there = response.frequency.values[unsettled.any("motion").values]
    if not ends and not len(there):
        return Band(np.nan, upper, np.nan)
    lower = min(max([*ends, *there]), upper)
    gone = response.frequency.values[response.frequency.values > max(there, default=np.inf)]
    return Band(lower, upper, max(min([*gone[:1], upper]) - lower, 0.0) if len(there) else 0.0)
