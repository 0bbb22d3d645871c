"""Choice of a restitution that the user left free within a range, by coarse comparisons of gaps.

A start is an initial state.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from impact_damper.design.choose import largest_within
from impact_damper.design.compare import coarse_comparison
from impact_damper.design.kept_steps import KeptSteps
from impact_damper.design.labelled import restitutions_dataset
from impact_damper.design.screen import gap_span
from impact_damper.design.task import Task
from impact_damper.model.bounds import shown
from impact_damper.model.machine import describe_si

# Number of restitutions that are tried, evenly spaced over the range.
COUNT = 5


class Trials(NamedTuple):
    """The best gap for each of n restitutions.

    Attributes
    ----------
    restitution : numpy.ndarray, shape (n,)
    gap : numpy.ndarray, shape (n,)
        mm.
    worst : numpy.ndarray, shape (n,)
        Largest displacement over the band, the starts and the tolerated deviation of the gap, mm.
    kind : list of str
        Kind of each choice, see `choose.Choice`.
    """

    restitution: np.ndarray
    gap: np.ndarray
    worst: np.ndarray
    kind: list


def best_of(worst, kinds) -> int:
    """Return the index of the best of n trials.

    Among the trials with the best kind of choice, this is the one with the smallest displacement.

    Parameters
    ----------
    worst : array, shape (n,)
        Largest displacement in each trial.
    kinds : array, shape (n,)
        Kind of choice in each trial, as flags of `tried_choice`. The best kind has the smallest
        number.
    """
    return int(np.lexsort((worst, kinds))[0])


def try_restitutions(task, ends, **running) -> Trials:
    """Return the best gap for COUNT restitutions, by coarse comparisons.

    Parameters
    ----------
    task : Task
        Its restitution is ignored.
    ends : tuple of float
        Least and greatest restitution.
    running
        `workers` and `progress` of `outcomes.run`.
    """
    tolerance = task.tolerances.get("gap", 0.0)
    limit = 1e3 * task.displacement_limit if task.displacement_limit else task.bare.max() / 2
    values = np.linspace(*ends, COUNT)
    gaps, worst, kinds = [], [], []
    for value in values:
        each = replace(task, restitution=float(value))
        found = coarse_comparison(each, gap_span(each), limit, **running)
        choice = found.choose(tolerance)
        low, high = (choice.gap * (1 + sign * tolerance) for sign in (-1, 1))
        gaps.append(choice.gap)
        worst.append(float(largest_within(found.gaps, found.worst, [low], [high])[0]))
        kinds.append(choice.kind)
    return Trials(values, np.array(gaps), np.array(worst), kinds)


def free_restitution(given, restitution, folder, running):
    """Return the restitution of a design and, if it is free, a dataset of the trials.

    Parameters
    ----------
    given : dict
        All other arguments of `Task`.
    restitution : float or sequence of 2 floats
        A value, which is returned with an empty dataset, or the ends of a range.
    folder : str, pathlib.Path or None
        Folder in which the dataset is kept.
    running : dict
        `workers` and `progress` of `outcomes.run`.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    if isinstance(restitution, str) or not isinstance(restitution, Sequence | np.ndarray):
        return restitution, xr.Dataset()
    tasks = [Task(**given, restitution=end) for end in restitution]
    ends = [task.restitution for task in tasks]
    if len(ends) != 2 or not ends[0] < ends[1]:
        raise ValueError(f"restitution = {shown(restitution)}: must be a number or two that ascend")
    made = tasks[0].describe() | {"machine": describe_si(given["machine"]), "restitution": ends}
    tried = KeptSteps(folder, made).step(
        "restitutions", lambda: restitutions_dataset(try_restitutions(tasks[0], ends, **running))
    )
    k = best_of(tried["tried_displacement"].values, tried["tried_choice"].values)
    return float(tried["tried_restitution"][k]), tried
