"""Sweeps: the motions found along the swept parameter, runs of True in a mask, and ranges."""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.data.variables import OUTCOME
from impact_damper.model.text import number

NAMES = {value: name for name, value in OUTCOME.items()}


class Family(NamedTuple):
    """A motion over a sweep.

    Attributes
    ----------
    outcome : str
        Name of its outcome.
    period : int
        In cycles; 0 for a motion without a period.
    places : numpy.ndarray of bool, shape (value, motion)
        Entries of the sweep's arrays that belong to the motion, at most one for each value of the
        swept parameter.
    starts : int
        Number of random starts, at all values together, that lead to the motion.
    """

    outcome: str
    period: int
    places: np.ndarray
    starts: int


def families(data) -> list:
    """Return the motions of a sweep, by descending number of random starts that lead to them.

    Parameters
    ----------
    data : xarray.Dataset
        Of a sweep of frequency or clearance. Motions at different values with the same `branch` are
        one motion (`motions.sweep`).

    Returns
    -------
    list of Family
    """
    branch, starts = data["branch"].values, data["motion_starts"].values
    found = []
    for branch_number in np.unique(branch[branch >= 0]):
        places = branch == branch_number
        row, column = np.argwhere(places)[0]
        outcome = NAMES[int(data["outcome"][row, column])]
        period = int(data["period"][row, column])
        found.append(Family(outcome, period, places, int(starts[places].sum())))
    return sorted(found, key=lambda each: -each.starts)


def runs_of_true(mask) -> np.ndarray:
    """Return for each run of True its first index and the index after its last, shape (n, 2)."""
    return np.flatnonzero(np.diff(np.asarray(mask, int), prepend=0, append=0)).reshape(-1, 2)


def quiet_gaps(data) -> str:
    """Return the range of quiet gaps (mm) around the chosen gap, as text of `known_range`."""
    return known_range(
        data["cliff_gap"].values, data["cliff_status"].values == flag("cliff_status", "range_ends")
    )


def known_range(ends, is_open) -> str:
    """Return the text of a range; an end is open where the search stopped before the range did."""
    low, high = (number(float(end), 4) for end in ends)
    return f"{low}{' or less' * bool(is_open[0])} to {high}{' or more' * bool(is_open[1])}"
