"""Motions of a sweep, each over all values at which it was found."""

from typing import NamedTuple

import numpy as np

from impact_damper.data.variables.variable import OUTCOME

NAMES = {value: name for name, value in OUTCOME.items()}


class Family(NamedTuple):
    """A motion over a sweep.

    Attributes
    ----------
    outcome : str
        Name of its outcome.
    period : int
        In forcing periods; 0 if it has none.
    places : numpy.ndarray of bool, shape (value, motion)
        Where it stands in the tables of the sweep, once at each value at most.
    starts : int
        Random starts that lead to it, at all values together.
    """

    outcome: str
    period: int
    places: np.ndarray
    starts: int


def families(data) -> list:
    """Return the motions of a sweep, those first that most random starts lead to.

    Parameters
    ----------
    data : xarray.Dataset
        Of a sweep of frequency or clearance: its variable `branch` says which motions at different
        values are the same (`motions.sweep`).

    Returns
    -------
    list of Family
    """
    branch, starts = data["branch"].values, data["motion_starts"].values
    found = []
    for number in np.unique(branch[branch >= 0]):
        places = branch == number
        row, column = np.argwhere(places)[0]
        outcome = NAMES[int(data["outcome"][row, column])]
        period = int(data["period"][row, column])
        found.append(Family(outcome, period, places, int(starts[places].sum())))
    return sorted(found, key=lambda each: -each.starts)
