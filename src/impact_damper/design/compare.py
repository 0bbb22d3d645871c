"""Comparisons of gaps by the share of random starts that lead to quiet motions, over the band.

Gaps are first compared coarsely, with few starts at some of the frequencies. Candidates around the
best of these gaps are then run from all starts at all frequencies, until they can no longer be
quiet.
"""

from itertools import pairwise

import numpy as np
import xarray as xr

from impact_damper.data.shares import failures_allowed
from impact_damper.design.choose import choose, least_shares, quiet_gaps, worst_sizes
from impact_damper.design.outcomes import (
    Case,
    draw_starts,
    quiet_motions,
    run,
    run_starts,
    summarise,
)
from impact_damper.design.task import SIDES, labelled
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


def compare_gaps(task, first, progress=None) -> xr.Dataset:
    """Return the coarse comparison of gaps, and the comparison of candidates with all starts.

    `first` is the dataset of the screening (`screen.screen`).
    """
    span, limit = first["screened_gap"].values[[0, -1]], float(first["orbit_limit"])
    coarse = coarse_comparison(task, span, limit, progress=progress)
    found = candidate_comparison(task, coarse, progress)
    values = {
        "coarse_displacement": worst_sizes(coarse),
        "coarse_share": least_shares(coarse),
        "compared_motions": sum(int(each["start_count"].sum()) for each in (coarse, found)),
    }
    return found.merge(labelled(values, coarse_gap=coarse["candidate_gap"].values))


def compare(task, gaps, frequencies, limit, starts, stream, progress=None) -> xr.Dataset:
    """Return the comparison of the motions at all gaps (mm) and frequencies (Hz).

    The share of quiet starts is tested in at most two looks: with `starts` starts and, at
    frequencies at which too many of these are not quiet, with SECOND times as many. The probability
    that one of the looks wrongly confirms the share is below 5 %. A gap is given up as soon as more
    starts at one of the frequencies are not quiet than the second look allows, so its numbers come
    from fewer starts. If `starts` are too few to prove the share even when all are quiet, there is
    no second look, and one start that is not quiet suffices to give a gap up.
    """
    gaps, frequencies = np.asarray(gaps), np.asarray(frequencies)
    cases = [Case(1e-3 * gap, f) for gap in gaps for f in frequencies]
    owners = np.repeat(np.arange(len(gaps)), len(frequencies))
    first_allowed = failures_allowed(task.share, starts)
    total = SECOND * starts if first_allowed >= 0 else starts
    allowed = max(failures_allowed(task.share, total), 0)
    drawn = draw_starts(task, cases, total, stream)
    records = np.zeros(drawn.shape[:2], MOTION)
    counts, failures = np.zeros((2, len(cases)), int)
    places = np.arange(len(cases))
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
            progress,
        )
        counts[places] = end
        failures[places] += np.sum(~quiet_motions(task, records[places, begin:end], limit), axis=1)
        hopeful = ~np.isin(owners, owners[failures > allowed])
        is_open = failures > first_allowed if end >= starts else hopeful
        places = np.flatnonzero(hopeful & is_open)
    return _comparison(gaps, frequencies, _numbers(task, records, counts, limit), limit)


def run_until_sure(task, cases, starts, limit, owners, allowed, progress=None):
    """Return motions; those that are not quiet after a short run are run for the full time.

    The motions that are not quiet are run again some for each gap at a time. Once more motions than
    allowed remain not quiet at one frequency, the gap is lost, and its other motions are not run
    again.

    Parameters
    ----------
    task : Task
    cases : sequence of Case
    starts : array, shape (cases, count, 4)
    limit : float
        Quiet limit, mm.
    owners : array of int, shape (cases,)
        Number of the gap to which a case belongs.
    allowed : array of int, shape (cases,)
        Largest number of motions that may be not quiet; with more, the gap of the case is lost.
    progress : str, optional

    Returns
    -------
    numpy.ndarray of records.MOTION, shape (cases, count)
    """
    records = run_starts(task, cases, starts, settling=task.hurried, progress=progress)
    loud = ~quiet_motions(task, records, limit)
    turn = (np.cumsum(loud, axis=1) - 1) // (1 + allowed.max())
    remain = np.zeros(len(cases), int)
    for number in range(turn.max() + 1):
        lost = np.isin(owners, owners[remain > allowed])
        rows, columns = np.nonzero(loud & (turn == number) & ~lost[:, None])
        if len(rows):
            begun = starts[rows, columns][:, None]
            again = run_starts(task, [cases[k] for k in rows], begun, progress=progress)[:, 0]
            records[rows, columns] = again
            remain += np.bincount(rows[~quiet_motions(task, again, limit)], minlength=len(cases))
    return records


def coarse_comparison(
    task, span, limit, *, most=COARSE_GAPS, starts=COARSE_STARTS, progress=None
) -> xr.Dataset:
    """Return a comparison of at most `most` gaps over a whole range (mm), with few starts.

    If the task has no displacement limit, the quiet limit of the comparison is `limit` or, if
    smaller, ABOVE times the largest displacement of all motions at the best gap, mm.
    """
    frequencies = task.few(COARSE_FREQUENCIES)
    gaps = np.geomspace(*span, min(most, 2 * task.effort.candidates + 4))
    cases = [Case(1e-3 * gap, f) for gap in gaps for f in frequencies]
    records = run(task, cases, starts, "coarse", settling=task.hurried, progress=progress)
    found = _comparison(gaps, frequencies, summarise(task, records, limit), limit)
    if task.displacement_limit is not None:
        return found
    limit = min(limit, ABOVE * float(worst_sizes(found).min()))
    return _comparison(gaps, frequencies, summarise(task, records, limit), limit)


def candidate_comparison(task, coarse, progress=None) -> xr.Dataset:
    """Return a comparison of the candidates from all starts, with the limit of the coarse one.

    The candidates lie around the best gap of the coarse comparison. Its few starts may miss motions
    that are not quiet. If no choice from the candidates is "robust", further candidates are added:

    - around a gap that is robust in the coarse comparison and lies beyond all candidates that are
      not quiet;
    - if there is none and no candidate is quiet: on both sides of the candidate with the most quiet
      starts, if their share is at least PROMISING. A narrow range of quiet gaps may lie there.
    """
    share, limit = task.share, float(coarse["displacement_limit"])
    given = (task.grid, limit, task.effort.starts)
    gaps = _around(choose(coarse, share, task.gap_tolerance).gap, task)
    found = compare(task, gaps, *given, "candidates", progress)
    if choose(found, share, task.gap_tolerance).kind == "robust":
        return found
    beyond = _best_beyond(task, coarse, found)
    if beyond is not None:
        stream, gaps = "candidates_beyond", _around(beyond, task)
    elif not quiet_gaps(found, share).any() and least_shares(found).max() >= PROMISING:
        stream, gaps = "further_candidates", _beside_best(found, task.effort.candidates)
    else:
        return found
    further = np.setdiff1d(gaps, found["candidate_gap"].values)
    more = compare(task, further, *given, stream, progress)
    parts = xr.concat([found, more], "candidate", data_vars="minimal", coords="minimal")
    return parts.isel(candidate=np.argsort(parts["candidate_gap"].values))


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


def _comparison(gaps, frequencies, numbers, limit):
    """Return a comparison from the numbers of cases that are sorted by gap, then by frequency."""
    shape = len(gaps), len(frequencies)
    folded = {name: values.reshape(*shape, *values.shape[1:]) for name, values in numbers.items()}
    return labelled(
        folded | {"displacement_limit": limit},
        candidate_gap=gaps,
        frequency=frequencies,
        side=SIDES,
    )


def _around(gap, task):
    """Return the gaps of candidates around a gap (mm); they cover more than its tolerance."""
    reach = BEYOND / (1 - task.gap_tolerance)
    return gap * np.geomspace(1 / reach, reach, task.effort.candidates)


def _best_beyond(task, coarse, found):
    """Return the best robust gap of the coarse comparison beyond the candidates not quiet, or None.

    Of a robust gap below and one above them, the one with less motion is returned.
    """
    loud = found["candidate_gap"].values[~quiet_gaps(found, task.share)]
    if not len(loud):
        return None
    gaps, robust = coarse["candidate_gap"].values, []
    for side in (gaps < loud.min(), gaps > loud.max()):
        if side.any():
            part = coarse.isel(candidate=side)
            choice = choose(part, task.share, task.gap_tolerance)
            if choice.kind == "robust":
                size = np.interp(choice.gap, gaps[side], worst_sizes(part))
                robust.append((size, choice.gap))
    return min(robust)[1] if robust else None


def _beside_best(found, count):
    """Return gaps between the neighbours of the candidate with the most quiet starts."""
    k, gaps = int(np.argmax(least_shares(found))), found["candidate_gap"].values
    near = gaps[max(k - 1, 0)], gaps[min(k + 1, len(gaps) - 1)]
    return np.geomspace(*near, count)[1:-1]  # the ends have been compared already
