"""The motions found in a sweep of a parameter."""

from typing import NamedTuple

import numpy as np

from impact_damper.data.motion_variables import OUTCOME

NAMES = {value: name for name, value in OUTCOME.items()}


class Family(NamedTuple):
    """A motion in a sweep of a parameter. `starts` is the number of random starts that lead to it.

    places[i, j] is True if motion number j at the i-th parameter value of the sweep is this motion.
    """

    outcome: str
    period: int
    places: np.ndarray
    starts: int


def families(data) -> list[Family]:
    """Return a `Family` for each motion of a sweep, by falling number of starts that lead to it."""
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
    """Return a row for each run of True in `mask`: its first index, and its last index plus 1."""
    return np.flatnonzero(np.diff(np.asarray(mask, int), prepend=0, append=0)).reshape(-1, 2)
