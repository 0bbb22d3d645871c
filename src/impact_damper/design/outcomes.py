"""Quiet motions and others from random starts, for many gaps and frequencies at once.

A start is an initial state. A motion is quiet if its largest displacement is at most the quiet
limit, whether it is periodic or not. A motion that has not settled to a periodic orbit is known
only for some cycles, and later peaks may be larger. It counts as quiet if LATER times its largest
displacement is at most the limit.
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

# LASTING: outcomes of motions that continue unchanged for good.
# CERTAIN: outcomes that a longer run would not change.
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
    """Return random starts for each case, shape (cases, count, 4).

    Their range grows with the motions of the machine without the damper in each case.

    Parameters
    ----------
    task : Task
    cases : sequence of Case
    count : int
        Number of starts in each case.
    stream : str
        One of STREAMS. The seed of the random numbers consists of the seed of the task, the index
        of the stream and the index of the case.
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
    """Run the motions from all starts of all cases until they settle.

    Parameters
    ----------
    task : Task
    cases : sequence of Case
    starts : array, shape (cases, count, 4)
    settling : Settling, optional
        Lengths and tolerances of the runs, in place of those of the task.
    workers, progress
        As in `ensemble.settle`.

    Returns
    -------
    numpy.ndarray of records.MOTION, shape (cases, count)
        Outcome, largest displacement and other numbers of each motion.
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
        Largest displacements, flags of `outcome`, and quiet limits in the unit of `sizes`. The
        three are broadcast together.
    """
    return np.where(np.isin(outcomes, LASTING), 1.0, LATER) * sizes <= limit


def quiet_motions(task, records, limit) -> np.ndarray:
    """Return which motions in an array of `records.MOTION` are quiet; the limit is in mm."""
    return are_quiet(task.millimetres(records["maximum_displacement"]), records["outcome"], limit)


def summarise(task, records, limit) -> dict:
    """Return statistics of the motions of each case, keyed by the name of a dataset variable.

    Parameters
    ----------
    task : Task
    records : array of records.MOTION, shape (cases, starts)
    limit : float
        Quiet limit, mm.

    Returns
    -------
    dict of numpy.ndarray, shape (cases,)
        `start_count`; `start_quiet_share` and its 95 % confidence interval `start_quiet_interval`,
        shape (cases, 2); largest displacement of all motions, `worst_displacement`, and its median,
        `median_displacement`, mm; cycles in which half of the quiet motions have settled,
        `quiet_time_median`, and in which 95 % have, `quiet_time_late` (NaN if none settles);
        `chaotic_share`; share of motions that are neither settled nor certainly chaotic,
        `uncertain_share`.
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
