"""Quiet motions and others from random starts, for many gaps and frequencies at once.

A motion is quiet if its largest displacement is at most the quiet limit, whether it is periodic or
not. A motion that has not settled is known only for some cycles, and later peaks may be larger. It
is quiet if LATER times its largest displacement is at most the limit.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import is_settled
from impact_damper.data.shares import wilson_intervals
from impact_damper.design.task import LATER
from impact_damper.design.tolerances import NOMINAL
from impact_damper.motions import ensemble
from impact_damper.motions.records import AT_REST, CHAOTIC, NON_COLLIDING, SETTLED
from impact_damper.motions.start_states import random_starts

# Outcomes of motions that continue unchanged for good, and outcomes that a longer run would not
# change.
LASTING = (SETTLED, NON_COLLIDING, AT_REST)
CERTAIN = (*LASTING, CHAOTIC)
# Purposes for which starts are drawn. Each purpose has its own random stream, so that no start is
# used both for a choice and for its check.
STREAMS = (
    "screening",
    "coarse",
    "candidates",
    "further_candidates",
    "edges",
    "middle",
    "lives",
    "orbit",
    "samples",
    "unseen",
    "force_map",
    "damper_map",
    "masses",
    "deviations",
    "candidates_beyond",
)
# Number of cases for which a thread draws starts at once.
DRAWN = 4


class Case(NamedTuple):
    """A gap (m) and a forcing frequency (Hz), with factors of the values that may deviate."""

    gap: float
    frequency: float
    factors: tuple = NOMINAL


def draw_starts(task, cases, count, stream, *, workers=1):
    """Return random starts, as wide as the machine of each case, shape (cases, count, 4).

    Parameters
    ----------
    task : Task
    cases : sequence of Case
    count : int
        Random starts in each case.
    stream : str
        One of STREAMS. The starts of a case are drawn with the seed of the task, the stream and the
        index of the case.
    workers : int
        Threads. They find the free motions that determine the range of the starts.
    """
    states, stop = np.empty((len(cases), count, 4)), np.zeros(1, bool)

    def work(part):
        for place in range(part.start, part.stop):
            if not stop[0]:
                seed = [task.seed, STREAMS.index(stream), place]
                system = task.system(*cases[place])
                states[place], _ = random_starts(*system, count, seed, task.settling)

    ensemble.run_chunks(work, len(cases), workers, None, stop, size=DRAWN)
    return states


def run_starts(task, cases, starts, *, settling=None, workers=1, progress=None):
    """Run motions from starts of all cases until they settle, in one ensemble.

    Parameters
    ----------
    task : Task
    cases : sequence of Case
    starts : array, shape (cases, count, 4)
    settling : Settling, optional
        In place of the settling of the task.
    workers, progress
        As in `ensemble.settle`.

    Returns
    -------
    numpy.ndarray of records.MOTION, shape (cases, count)
    """
    count = starts.shape[1]
    rows = np.array([task.packed(*case) for case in cases])
    records = ensemble.settle(
        np.repeat(rows, count, axis=0),
        starts.reshape(-1, 4),
        settling or task.settling,
        workers=workers,
        progress=progress,
    )
    return records.reshape(len(cases), count)


def run(task, cases, count, stream, *, workers=1, **running):
    """Draw random starts and run them: `draw_starts`, then `run_starts`."""
    starts = draw_starts(task, cases, count, stream, workers=workers)
    return run_starts(task, cases, starts, workers=workers, **running)


def are_quiet(sizes, outcomes, limit) -> np.ndarray:
    """Return which motions are quiet.

    Parameters
    ----------
    sizes, outcomes, limit : array
        Largest displacements, flags of `outcome`, and displacement limits in the unit of `sizes`;
        broadcast together.
    """
    return np.where(np.isin(outcomes, LASTING), 1.0, LATER) * sizes <= limit


def quiet_motions(task, records, limit) -> np.ndarray:
    """Return which of several motions are quiet, from their records; the limit is in mm."""
    return are_quiet(task.millimetres(records["maximum_displacement"]), records["outcome"], limit)


def summarise(task, records, limit) -> dict:
    """Return numbers on the motions of each case, keyed by registered name.

    Parameters
    ----------
    task : Task
    records : array of records.MOTION, shape (cases, starts)
    limit : float
        Quiet limit, mm.

    Returns
    -------
    dict of numpy.ndarray, shape (cases,)
        `start_count`, `start_quiet_share` and `start_quiet_interval`, shape (cases, 2);
        `worst_displacement` and `median_displacement` of the motions, mm; `quiet_time_median` and
        `quiet_time_late`, the cycles in which quiet motions settle (NaN if none settles);
        `chaotic_share`; `uncertain_share` of the motions that are neither settled nor certainly
        chaotic.
    """
    size = task.millimetres(records["maximum_displacement"])
    count = size.shape[1]
    quiet = quiet_motions(task, records, limit)
    times = np.where(quiet & is_settled(records), records["periods_run"], np.nan)
    known = np.isfinite(times).any(axis=1)
    median, late = np.full((2, len(times)), np.nan)
    if known.any():
        median[known] = np.nanmedian(times[known], axis=1)
        late[known] = np.nanquantile(times[known], 0.95, axis=1)
    return {
        "start_count": np.full(len(size), count),
        "start_quiet_share": quiet.mean(axis=1),
        "start_quiet_interval": wilson_intervals(quiet.sum(axis=1), count),
        "worst_displacement": size.max(axis=1),
        "median_displacement": np.median(size, axis=1),
        "quiet_time_median": median,
        "quiet_time_late": late,
        "chaotic_share": np.mean(records["outcome"] == CHAOTIC, axis=1),
        "uncertain_share": np.mean(~np.isin(records["outcome"], CERTAIN), axis=1),
    }
