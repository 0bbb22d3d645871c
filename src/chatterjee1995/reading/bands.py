"""The suppression band, determined from exact orbits and simulated motions."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits


class Band(NamedTuple):
    """A suppression band. It begins between `lower` and `lower + resolution`, ends at `upper`."""

    lower: float
    upper: float
    resolution: float

    @property
    def width(self):
        """Largest possible width of the band, from `lower` to `upper`."""
        return self.upper - self.lower

    @property
    def least_width(self):
        """Smallest possible width of the band, from `lower + resolution` to `upper`."""
        return self.width - self.resolution


def high_motions(response, free):
    """Return a mask of violent motions. It is False at W above the end of the free resonance."""
    frequency = response.frequency
    size = xr.DataArray(orbits.resonance(free, frequency), {"frequency": frequency})
    return reading.touching(response) & (response.maximum_displacement > orbits.HALF * size)


def quiet_motions(response, free):
    """Return a mask of quiet motions: settled, of period 1, with contacts, and not violent."""
    settled = reading.touching(response) & reading.is_outcome(response, "settled")
    return settled & (response.period == 1) & ~high_motions(response, free)


def suppression_band(datasets, name):
    """Return the suppression band of a curve as a `Band`.

    `lower`: the highest W at which a violent motion is found; NaN without violent motions.
    `upper`: the W at which the free resonance ends.
    `resolution`: the band begins at most this far above `lower`. It is NaN without violent motions,
    0 if all violent motions are periodic, otherwise at most the step in W between simulations.
    """
    branches, free = orbits.of_curve(datasets, name)
    response = reading.get(datasets, "response", name)
    upper, _ = orbits.resonance_fold(free)
    ends = [top for _, top in orbits.ranges(orbits.high(branches, free))]
    unsettled = high_motions(response, free) & reading.is_outcome(
        response, "quasi_periodic", "chaotic", "unresolved"
    )
    last = response.frequency.values[unsettled.any("motion").values]
    if not ends and not len(last):
        return Band(np.nan, upper, np.nan)
    lower = min(max([*ends, *last]), upper)
    following = response.frequency.values[response.frequency.values > max(last, default=np.inf)]
    resolution = max(min([*following[:1], upper]) - lower, 0.0) if len(last) else 0.0
    return Band(lower, upper, resolution)
