"""The clairvoyant bound: the earliest arrival at the goal if state and future are known exactly.

A controller switches the damper on and off. A hold is a time with the damper on, which ends with a
release (switching the damper off). The goal is that the motion without the damper settles to the
non-resonance motion, the smaller of its two motions of period 1. A real policy of release
(`policies`) cannot be faster than a controller that knows the future, the clairvoyant controller.

A trial of the clairvoyant controller uses the same random numbers as a trial of a policy: in its
n-th hold the damper is switched on at the same phase, with the loose mass at the same place. In
each hold the controller examines the moments at evenly spaced phases, and knows to which motion a
release at each moment leads and when. The release with the earliest arrival at the goal counts.

An earlier arrival may be possible in a further hold. To begin one soon, the controller ends the
present hold after one to two forcing cycles, at the moment after which the free motion settles
soonest to another motion than the goal. Then it switches the damper on again.

Noise on the measured state does not affect this controller. A known delay between the order to
release and the release does not affect it either, because the controller gives the order earlier.
"""

import math

import numpy as np

from impact_damper.motions.policies import DRAWS, Draws, Outcome
from impact_damper.motions.recorded import label_moments, record

# The release set (`release_set`) contains the states from which the free motion settles to the
# goal. It is known on a grid of cells, and the depth of a state is its distance from the boundary,
# negative outside. A state is labelled (the motion to which it leads is computed) only if its depth
# exceeds NEAR cells. States further outside certainly do not lead to the goal.
NEAR = -1.5
# The moments of a hold are labelled in the order of time, in several passes.
# FIRST, MOMENTS: number of moments of each hold in the first pass and in each later pass.
# TRIALS: number of trials that are recorded together, which limits the memory.
FIRST, MOMENTS, TRIALS = 4, 32, 256
# A hold is first recorded for HORIZON forcing cycles, because the goal is often reached in this
# time. Only if an earlier arrival is still possible is the hold recorded to the limit.
HORIZON = 32
# To end a hold early, only every APART-th moment of its second cycle is examined.
APART = 4


def clairvoyant(on, free, trials, limit, seed, examined=None):
    """Return the `policies.Outcome` of trials with the best moments of release.

    The parameters are those of `policies.run_trials`. A trial that cannot reach the goal within the
    limit counts as one in which the damper is never switched on.
    """
    draws, examined = Draws(seed, trials), examined or trials
    best = Outcome.failed(examined)
    spent, damper = np.zeros(examined), np.zeros(examined)
    impacts, place = np.zeros(examined, int), np.full(examined, free.resonance)
    holds = 0

    def look_ahead(rows, horizon):
        """Record the next hold of some trials; store releases that arrive earlier than the best."""
        left = np.minimum(best.cycles[rows], limit) - spent[rows]
        starts = free.strobe_states(place[rows], drawn[rows, DRAWS])
        limits = np.minimum(left, horizon)
        recording = record(on, free, starts, drawn[rows, :DRAWS].copy(), limits)
        arrival, at = earliest(free, recording, left)
        taken = np.flatnonzero(spent[rows] + arrival < best.cycles[rows])
        chosen, at = rows[taken], at[taken]
        best.reached[chosen] = True
        best.cycles[chosen] = spent[chosen] + arrival[taken]
        best.damper[chosen] = damper[chosen] + recording.cycles(taken, at)
        best.impacts[chosen] = impacts[chosen] + recording.impacts[taken, at]
        best.releases[chosen] = holds
        return recording

    open_ = np.arange(examined)
    while len(open_):
        holds += 1
        drawn = draws.following()
        for rows in np.array_split(open_, math.ceil(len(open_) / TRIALS)):
            recording = look_ahead(rows, HORIZON)
            longer = rows[np.minimum(best.cycles[rows], limit) - spent[rows] > HORIZON]
            if len(longer):
                look_ahead(longer, limit)
            settled, at, place[rows] = soonest(free, recording)
            every = np.arange(len(rows))
            spent[rows] += settled
            damper[rows] += recording.cycles(every, at)
            impacts[rows] += recording.impacts[every, at]
        open_ = open_[spent[open_] < np.minimum(best.cycles[open_], limit)]
    return best


def earliest(free, recording, latest):
    """Return the earliest arrival at the goal in each of n holds, and the moment of its release.

    Moments are examined in the order of time until no later moment can lead to an earlier arrival.

    Parameters
    ----------
    free : FreeCase
    recording : Recording
    latest : array, shape (n,)
        Latest arrival that counts, in forcing cycles from the time at which the hold begins.

    Returns
    -------
    arrival : numpy.ndarray, shape (n,)
        Forcing cycles from the beginning of the hold; infinite without an arrival.
    at : numpy.ndarray of int, shape (n,)
        Index of the moment of the release, or -1 without an arrival.
    """
    arrival, at = latest.copy(), np.full(len(latest), -1)
    rows, moments = np.nonzero(recording.depth > NEAR * free.releases.cell)
    rank = np.arange(len(rows)) - np.searchsorted(rows, rows)
    first, last = 0, FIRST
    while first <= np.max(rank, initial=-1):
        part = (rank >= first) & (rank < last)
        part &= recording.cycles(rows, moments) < arrival[rows]
        labels, times = label_moments(
            free, recording, rows[part], moments[part], arrival[rows[part]]
        )
        hit = np.flatnonzero(part)[labels == free.goal]
        times = times[labels == free.goal]
        np.minimum.at(arrival, rows[hit], times)
        best = hit[times == arrival[rows[hit]]]
        at[rows[best]] = moments[best]
        first, last = last, last + MOMENTS
    return np.where(at >= 0, arrival, np.inf), at


def soonest(free, recording):
    """Return the earliest arrival at a motion other than the goal after each of n short holds.

    A short hold ends between one and two forcing cycles after the damper is switched on.

    Returns
    -------
    settled : numpy.ndarray, shape (n,)
        Forcing cycles from the beginning of the hold. Infinite if all these releases lead to the
        goal, or if the recorded hold is shorter than a cycle.
    at : numpy.ndarray of int, shape (n,)
        Index of the moment of the release.
    place : numpy.ndarray of int, shape (n,)
        Index of the motion among `FreeCase.attractors`.
    """
    depth, phases = recording.depth, recording.phases
    short = np.zeros(depth.shape, bool)
    short[:, phases : 2 * phases : APART] = True
    rows, moments = np.nonzero(short & ~np.isnan(depth))
    labels, times = label_moments(free, recording, rows, moments, np.full(len(rows), np.inf))
    settled, at = np.full(len(depth), np.inf), np.zeros(len(depth), int)
    place = np.zeros(len(depth), int)
    for k in np.flatnonzero((labels >= 0) & (labels != free.goal)):
        if times[k] < settled[rows[k]]:
            settled[rows[k]], at[rows[k]], place[rows[k]] = times[k], moments[k], labels[k]
    return settled, at, place
