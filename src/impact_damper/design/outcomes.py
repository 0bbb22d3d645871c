"""Where start states lead: quiet motions and others, for many gaps and frequencies at once.

A motion is quiet if its largest displacement is at most the displacement limit of the task, whether
it is periodic or not. Random starts count in shares; placed starts (`motions.start_states`), which
also reach motions that hardly any random start reaches, count in the worst displacement only.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import is_settled
from impact_damper.data.shares import wilson
from impact_damper.design.task import NOMINAL
from impact_damper.motions import ensemble
from impact_damper.motions.records import AT_REST, CHAOTIC, NON_COLLIDING, SETTLED
from impact_damper.motions.start_states import random_starts, wide_starts

# Outcomes that say for certain what a motion is.
CERTAIN = (SETTLED, NON_COLLIDING, AT_REST, CHAOTIC)


class Case(NamedTuple):
    """A gap (m) and a forcing frequency (Hz), with factors of the values that may deviate."""

    gap: float
    frequency: float
    factors: tuple = NOMINAL


class Outcomes(NamedTuple):
    """Motions that random and placed starts reach in each case.

    Attributes
    ----------
    random : numpy.ndarray of records.MOTION, shape (cases, starts)
    placed : list of numpy.ndarray of records.MOTION
        One array for each case, of varying length.
    """

    random: np.ndarray
    placed: list


def run(task, cases, count, seed, *, settling=None, placed=False, workers=1, progress=None):
    """Run the motions of all cases until they settle, in one ensemble.

    Parameters
    ----------
    task : Task
    cases : sequence of Case
    count : int
        Random starts in each case.
    seed : int
        Each case has random starts of its own, drawn with the seed and its place.
    settling : Settling, optional
        In place of that of the task.
    placed : bool
        Whether placed starts are run too; their ramps cost some 20 ms a case.
    workers, progress
        As in `ensemble.settle`.

    Returns
    -------
    Outcomes
    """
    settling = settling or task.settling
    rows, randoms, others = [], [], []
    for place, case in enumerate(cases):
        nominal = task.system(case.gap, case.frequency)
        # free motions are found once for each frequency, at nominal values
        if placed:
            states, extra, *_ = wide_starts(*nominal, count, [seed, place], task.settling)
        else:
            states, _ = random_starts(*nominal, count, [seed, place], task.settling)
            extra = np.empty((0, 4))
        rows.append(task.packed(*case))
        states[:, 2] *= case.factors[0]
        randoms.append(states)
        others.append(extra)
    rows = np.array(rows)
    counts = [len(extra) for extra in others]
    records = ensemble.settle(
        np.concatenate([np.repeat(rows, count, axis=0), np.repeat(rows, counts, axis=0)]),
        np.concatenate([*randoms, *others]),
        settling,
        workers=workers,
        progress=progress,
    )
    first = len(cases) * count
    parts = np.split(records[first:], np.cumsum(counts)[:-1])
    return Outcomes(records[:first].reshape(len(cases), count), parts)


def interval(quiet, total):
    """Return Wilson's 95 % intervals of shares, shape (..., 2)."""
    ends = [wilson(count, total)[1:] for count in np.ravel(quiet)]
    return np.reshape(ends, (*np.shape(quiet), 2))


def summarise(task, outcomes, limit) -> dict:
    """Return numbers on the motions of each case, keyed by registered name.

    Parameters
    ----------
    task : Task
    outcomes : Outcomes
    limit : float
        Largest displacement of a quiet motion, mm.

    Returns
    -------
    dict of numpy.ndarray, shape (cases,)
        `start_quiet_share` and, with (cases, 2), its interval; `worst_displacement` of all motions
        reached and `median_displacement` of those that random starts reach (mm);
        `quiet_time_median` and `quiet_time_late`, the forcing periods until quiet motions that
        settle have settled (NaN if none does); `chaotic_share`; `uncertain_share`, that of the
        motions that are neither settled nor certainly chaotic.
    """
    records = outcomes.random
    size = task.millimetres(records["maximum_displacement"])
    quiet = size <= limit
    worst = [
        max(np.max(row), np.max(task.millimetres(extra["maximum_displacement"]), initial=0.0))
        for row, extra in zip(size, outcomes.placed, strict=True)
    ]
    times = np.where(quiet & is_settled(records), records["periods_run"], np.nan)
    known = np.isfinite(times).any(axis=1)
    median, late = np.full((2, len(times)), np.nan)
    if known.any():
        median[known] = np.nanmedian(times[known], axis=1)
        late[known] = np.nanquantile(times[known], 0.95, axis=1)
    return {
        "start_quiet_share": quiet.mean(axis=1),
        "start_quiet_interval": interval(quiet.sum(axis=1), quiet.shape[1]),
        "worst_displacement": np.array(worst),
        "median_displacement": np.median(size, axis=1),
        "quiet_time_median": median,
        "quiet_time_late": late,
        "chaotic_share": np.mean(records["outcome"] == CHAOTIC, axis=1),
        "uncertain_share": np.mean(~np.isin(records["outcome"], CERTAIN), axis=1),
    }
