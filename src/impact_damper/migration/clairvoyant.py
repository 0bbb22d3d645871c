"""The clairvoyant bound: the best that releases can do if state and future are known exactly.

A trial has the random numbers that it has with a policy: in its n-th hold the damper is switched on
at the same phase, with the loose mass at the same place. The clairvoyant controller knows the
motion with the damper on and where the free motion settles after each release. In each hold it
examines all moments at even phases. A hold without a use is ended after one or two forcing periods,
at the moment after which the free motion settles soonest, and the damper is switched on again. Of
all these releases the one with the earliest arrival at the goal counts. Noise on the measured state
does not concern this controller, and a known delay it makes up for by an earlier order.
"""

import math

import numpy as np

from impact_damper.migration.policies import DRAWS, Draws, Outcome
from impact_damper.migration.recorded import label_moments, record

# Depth in cells of the release set above which a state may lie inside, and is labelled.
NEAR = -1.5
# Moments of a trial that are labelled at once, at first and later, and trials recorded at once.
FIRST, MOMENTS, TRIALS = 4, 32, 256
# Forcing periods that are recorded at first, as the goal is often reached within them.
HORIZON = 32
# Moments between those at which a short hold may end.
APART = 4


def clairvoyant(on, free, trials, limit, seed, examined=None):
    """Return the `Outcome` of trials with the best moments of release.

    Parameters as of `run_trials`. Where the goal cannot be reached the damper is never switched on.
    """
    draws, examined = Draws(seed, trials), examined or trials
    best = Outcome.failed(examined)
    spent, damper = np.zeros(examined), np.zeros(examined)
    impacts, place = np.zeros(examined, int), np.full(examined, free.resonance)
    holds = 0

    def look_ahead(rows, horizon):
        """Improve the best releases of trials by moments of a hold within a horizon."""
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
    """Return the earliest arrivals at the goal and their moments; infinite where there is none.

    Moments are examined by rising time until no later one can arrive earlier. `latest`, shape (n,),
    are the forcing periods after which an arrival is of no interest.
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
    """Return when another motion than the goal is reached soonest by a short hold.

    Released after one forcing period and before two.

    Returns
    -------
    settled : numpy.ndarray, shape (n,)
        Forcing periods; infinite if all these releases lead to the goal, or the hold is shorter.
    at, place : numpy.ndarray of int, shape (n,)
        The moment of the release and the motion.
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
