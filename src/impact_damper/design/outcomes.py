"""Motions from random starts for many gaps and frequencies at once, and which of them are quiet."""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import is_settled
from impact_damper.data.shares import wilson_intervals
from impact_damper.design.task import LATER, NOMINAL
from impact_damper.motions import ensemble
from impact_damper.motions.records import AT_REST, NON_COLLIDING, SETTLED
from impact_damper.motions.start_states import random_starts

# Outcomes of motions that continue unchanged for good.
LASTING = (SETTLED, NON_COLLIDING, AT_REST)
# Purposes for which starts are drawn. The index is part of the seed, so that no start is used both
# for a choice and for its check.
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


def draw_starts(task, cases, count, stream) -> np.ndarray:
    """Return random starts, shape (cases, count, 4), as large as the motions without the damper.

    `stream` is one of STREAMS.
    """
    states, stop = np.empty((len(cases), count, 4)), np.zeros(1, bool)

    def work(part):
        for place in range(part.start, part.stop):
            if not stop[0]:
                seed = [task.effort.seed, STREAMS.index(stream), place]
                system = task.system(*cases[place])
                states[place], _ = random_starts(*system, count, seed, task.effort.settling)

    ensemble.run_chunks(work, len(cases), task.effort.workers, None, stop, size=DRAWN)
    return states


def run_starts(task, cases, starts, *, settling=None, progress=None) -> np.ndarray:
    """Run the motions from starts, shape (cases, count, 4), until they settle.

    Return their `records.MOTION`, shape (cases, count). `settling` replaces the one of the task,
    and `progress` is the title of a progress bar.
    """
    count = starts.shape[1]
    rows = np.array([task.packed(*case) for case in cases])
    records = ensemble.settle(
        np.repeat(rows, count, axis=0),
        starts.reshape(-1, 4),
        settling or task.effort.settling,
        workers=task.effort.workers,
        progress=progress,
    )
    return records.reshape(len(cases), count)


def run(task, cases, count, stream, **running) -> np.ndarray:
    """Draw random starts and run them: `draw_starts`, then `run_starts`."""
    return run_starts(task, cases, draw_starts(task, cases, count, stream), **running)


def are_quiet(sizes, outcomes, limit) -> np.ndarray:
    """Return which motions stay below the quiet limit, in the unit of their sizes.

    A motion that has not settled is known only for some cycles, and later peaks may be LATER times
    as large.
    """
    return np.where(np.isin(outcomes, LASTING), 1.0, LATER) * sizes <= limit


def quiet_motions(task, records, limit) -> np.ndarray:
    """Return which motions in an array of `records.MOTION` are quiet; the limit is in mm."""
    return are_quiet(task.millimetres(records["maximum_displacement"]), records["outcome"], limit)


def summarise(task, records, limit) -> dict:
    """Return statistics of the motions of each case, keyed by the name of a dataset variable.

    `records` has the shape (cases, starts), and the quiet limit is in mm.
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
        "quiet_time_median": median,
        "quiet_time_late": late,
    }
