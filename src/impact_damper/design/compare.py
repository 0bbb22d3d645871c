"""Comparisons of gaps by the share of random starts that lead to quiet motions, over the band.

A start is an initial state. A start, or its motion, is quiet if the largest displacement is at most
the quiet limit. A gap is quiet if at each frequency of the band the share of quiet starts is at
least `Task.share`. Gaps are first compared coarsely, with few starts at some of the frequencies.
Candidates around the best of these gaps are then run from all starts at all frequencies. A
candidate that fails with the first starts is not run from the others. Runs of a comparison are
short: a motion that is not quiet at their end is run for the full time of the task before its start
counts as not quiet.
"""

from itertools import pairwise

import numpy as np

from impact_damper.data.shares import failures_allowed
from impact_damper.design.choose import Comparison
from impact_damper.design.outcomes import (
    Case,
    draw_starts,
    quiet_motions,
    run,
    run_starts,
    summarise,
)
from impact_damper.motions.records import MOTION

# Coarse comparison: largest number of gaps (fewer with few candidates), of frequencies, of starts.
COARSE_GAPS, COARSE_FREQUENCIES, COARSE_STARTS = 28, 9, 12
# After TRIAL starts a gap is first tested, and given up if it can no longer be quiet.
TRIAL = 24
# The share of quiet starts is tested with some starts and, at frequencies at which this does not
# decide, a second time with SECOND times as many starts in all.
SECOND = 3
# The candidates cover the tolerated deviation from the best gap of the coarse comparison, times
# this factor, so that the cliff (`cliff`) is seen if it is just outside this deviation.
BEYOND = 1.15
# If the task has no displacement limit, the quiet limit is ABOVE times the worst displacement at
# the best gap of the coarse comparison. The factor leaves room for gaps within the tolerance, at
# which the quiet motion is larger.
ABOVE = 2.5
# If no candidate is quiet, further candidates are compared next to a candidate whose share of
# quiet starts is at least PROMISING at all frequencies.
PROMISING = 0.5


def compare(task, gaps, frequencies, limit, starts, stream, *, workers=1, progress=None):
    """Return the comparison of the motions at all gaps (mm) and frequencies (Hz).

    The share of quiet starts is tested in at most two looks: with `starts` starts and, at
    frequencies at which too many of these are not quiet, with SECOND times as many. The probability
    that one of the looks wrongly confirms the share is below 5 %. A gap is given up as soon as more
    starts at one of the frequencies are not quiet than the second look allows. The numbers for
    gaps that are not quiet therefore come from fewer starts.

    Parameters
    ----------
    task : Task
    gaps, frequencies : array
    limit : float
        Quiet limit, mm.
    starts : int
        Random starts of the first look at each gap and frequency. If they are too few to prove the
        share even when all are quiet, there is no second look, and one start that is not quiet
        suffices to give a gap up.
    stream, workers, progress
        As in `outcomes.run`.

    Returns
    -------
    Comparison
    """
    gaps, frequencies = np.asarray(gaps), np.asarray(frequencies)
    cases = [Case(1e-3 * gap, f) for gap in gaps for f in frequencies]
    owners = np.repeat(np.arange(len(gaps)), len(frequencies))
    first_allowed = failures_allowed(task.share, starts)
    total = SECOND * starts if first_allowed >= 0 else starts
    allowed = max(failures_allowed(task.share, total), 0)
    drawn = draw_starts(task, cases, total, stream, workers=workers)
    records = np.zeros(drawn.shape[:2], MOTION)
    counts, failures = np.zeros((2, len(cases)), int)
    places = np.arange(len(cases))
    running = {"workers": workers, "progress": progress}
    for begin, end in pairwise(np.unique([0, min(TRIAL, starts), starts, total])):
        if not len(places):
            break
        records[places, begin:end] = run_until_sure(
            task,
            [cases[k] for k in places],
            drawn[places, begin:end],
            limit,
            owners[places],
            allowed - failures[places],
            **running,
        )
        counts[places] = end
        failures[places] += np.sum(~quiet_motions(task, records[places, begin:end], limit), axis=1)
        hopeful = ~np.isin(owners, owners[failures > allowed])
        is_open = failures > first_allowed if end >= starts else hopeful
        places = np.flatnonzero(hopeful & is_open)
    return _comparison(task, gaps, frequencies, _numbers(task, records, counts, limit), limit)


def run_until_sure(task, cases, starts, limit, owners, allowed, **running):
    """Return motions; those that are not quiet after a short run are run for the full time.

    All motions are run with the settling `Task.hurried`. Motions that are not quiet at the end are
    run again with the settling of the task, some for each gap at a time. Once more motions than
    allowed remain not quiet at one frequency, the gap is lost, and its other motions are not run
    again.

    Parameters
    ----------
    task : Task
    cases : sequence of Case
        A case is a gap with a frequency.
    starts : array, shape (cases, count, 4)
    limit : float
        Quiet limit, mm.
    owners : array of int, shape (cases,)
        Number of the gap to which a case belongs.
    allowed : array of int, shape (cases,)
        Largest number of motions that may be not quiet; with more, the gap of the case is lost.
    running
        `workers` and `progress` of `outcomes.run`.

    Returns
    -------
    numpy.ndarray of records.MOTION, shape (cases, count)
    """
    records = run_starts(task, cases, starts, settling=task.hurried, **running)
    loud = ~quiet_motions(task, records, limit)
    turn = (np.cumsum(loud, axis=1) - 1) // (1 + allowed.max())
    remain = np.zeros(len(cases), int)
    for number in range(turn.max() + 1):
        lost = np.isin(owners, owners[remain > allowed])
        rows, columns = np.nonzero(loud & (turn == number) & ~lost[:, None])
        if len(rows):
            begun = starts[rows, columns][:, None]
            again = run_starts(task, [cases[k] for k in rows], begun, **running)[:, 0]
            records[rows, columns] = again
            remain += np.bincount(rows[~quiet_motions(task, again, limit)], minlength=len(cases))
    return records


def _numbers(task, records, counts, limit):
    """Return the numbers of `summarise` for each case, from its first `counts` motions."""
    numbers = {}
    for count in np.unique(counts):
        places = np.flatnonzero(counts == count)
        for name, values in summarise(task, records[places, :count], limit).items():
            whole = numbers.setdefault(
                name, np.empty((len(counts), *values.shape[1:]), values.dtype)
            )
            whole[places] = values
    return numbers


def _comparison(task, gaps, frequencies, numbers, limit):
    """Return a comparison from the numbers of cases that are sorted by gap, then by frequency."""
    shape = len(gaps), len(frequencies)
    folded = {name: values.reshape(*shape, *values.shape[1:]) for name, values in numbers.items()}
    return Comparison(gaps, frequencies, folded, limit, task.share)


def coarse_comparison(task, span, limit, *, most=COARSE_GAPS, starts=COARSE_STARTS, **running):
    """Return a comparison of gaps over a whole range, with few starts.

    If the task has no displacement limit, the quiet limit of the comparison is `limit` or, if
    smaller, ABOVE times the largest displacement of all motions at the best gap.

    Parameters
    ----------
    task : Task
    span : tuple of float
        Least and greatest gap, mm.
    limit : float
        Provisional quiet limit, mm.
    most, starts : int
        Largest number of gaps, and random starts at each gap and frequency.
    running
        `workers` and `progress` of `outcomes.run`.

    Returns
    -------
    Comparison
    """
    frequencies = task.few(COARSE_FREQUENCIES)
    gaps = np.geomspace(*span, min(most, 2 * task.candidates + 4))
    cases = [Case(1e-3 * gap, f) for gap in gaps for f in frequencies]
    records = run(task, cases, starts, "coarse", settling=task.hurried, **running)
    found = _comparison(task, gaps, frequencies, summarise(task, records, limit), limit)
    if task.displacement_limit is not None:
        return found
    limit = min(limit, ABOVE * float(found.worst.min()))
    return _comparison(task, gaps, frequencies, summarise(task, records, limit), limit)


def candidate_comparison(task, coarse, **running) -> Comparison:
    """Return a comparison of the candidates from all starts, with the limit of the coarse one.

    The candidates lie around the best gap of the coarse comparison. The few starts of the coarse
    comparison may miss violent (not quiet) motions. If no choice from the candidates is "robust"
    (`choose.Choice`), further candidates are added in one of two places:

    - around a gap that is robust in the coarse comparison and lies beyond all violent candidates;
    - if there is none and no candidate is quiet: on both sides of the candidate with the most quiet
      starts, if their share is at least PROMISING. A narrow range of quiet gaps may lie there.
    """
    tolerance = task.tolerances.get("gap", 0.0)
    gaps = _around(coarse.choose(tolerance).gap, task)
    found = compare(task, gaps, task.grid, coarse.limit, task.starts, "candidates", **running)
    if found.choose(tolerance).kind == "robust":
        return found
    beyond = _best_beyond(coarse, found, tolerance)
    if beyond is not None:
        stream, gaps = "candidates_beyond", _around(beyond, task)
    elif not found.quiet.any() and found.least_share.max() >= PROMISING:
        stream, gaps = "further_candidates", _beside_best(found, task.candidates)
    else:
        return found
    further = np.setdiff1d(gaps, found.gaps)
    return found.joined(
        compare(task, further, task.grid, coarse.limit, task.starts, stream, **running)
    )


def _around(gap, task):
    """Return the gaps of candidates around a gap (mm); they cover more than its tolerance."""
    reach = BEYOND / (1 - task.tolerances.get("gap", 0.0))
    return gap * np.geomspace(1 / reach, reach, task.candidates)


def _best_beyond(coarse, found, tolerance):
    """Return the best robust gap of the coarse comparison beyond the violent candidates, or None.

    Beyond means below the first or above the last candidate that is not quiet. Of a robust gap
    below and one above, the one with the smaller worst displacement is returned.
    """
    loud = found.gaps[~found.quiet]
    if not len(loud):
        return None
    sides = coarse.gaps < loud.min(), coarse.gaps > loud.max()
    parts = [coarse.only(side) for side in sides if side.any()]
    choices = [(part, part.choose(tolerance)) for part in parts]
    robust = [(part, choice.gap) for part, choice in choices if choice.kind == "robust"]
    sizes = [np.interp(gap, part.gaps, part.worst) for part, gap in robust]
    return robust[int(np.argmin(sizes))][1] if robust else None


def _beside_best(found, count):
    """Return gaps between the neighbours of the candidate with the most quiet starts."""
    k = int(np.argmax(found.least_share))
    near = found.gaps[max(k - 1, 0)], found.gaps[min(k + 1, len(found.gaps) - 1)]
    return np.geomspace(*near, count)[1:-1]  # the ends have been compared already
