"""Where random starts end: on known orbits, on new ones, on no orbit, or outside."""

from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from impact_damper.absorbers.orbits import Orbits, find_orbits
from impact_damper.absorbers.problems import COARSE, FINE, active_size, springs, steps_for
from impact_damper.motions.smooth_runs import DAMPING, SIZE, run

# Random starts: ratio of the largest to the largest known motion, and of the smallest to the
# largest.
SPREAD, SMALLEST = 3.0, 0.01
# Forcing periods between two looks at where the runs are: a multiple of PERIODS, the periods in
# which Newton's method looks for orbits. It does so after these shares of all looks, from the runs
# that are near no known orbit.
STRETCH = 12
PERIODS = (1, 2, 3)
SEARCHED = (0.5, 0.75)
# Forcing periods for which a run that is given up is watched.
WATCHED = 240
# A run has reached an orbit when it is nearer, relative to the largest state on the orbit.
NEAR = 0.02
# A run is given up when a linear vibration of the machine alone would have decayed by
# exp(-DECAY), and at most after LONGEST looks.
DECAY, LONGEST = 12.0, 200
# Beyond this number of times the largest start a run has escaped.
OUTSIDE = 100.0
# Ends of runs that are no indices of orbits.
UNSETTLED, ESCAPED = -1, -2


class Settled(NamedTuple):
    """Ends of random starts.

    Attributes
    ----------
    orbits : Orbits
        The known orbits and those that starts led to; one with a period of n forcing periods occurs
        n times, with each of its n states at T = 0.
    problem : numpy.ndarray of int, shape (n,)
        Problem of each start.
    orbit : numpy.ndarray of int, shape (n,)
        Index of the orbit on which it ends; UNSETTLED or ESCAPED.
    displacement : numpy.ndarray, shape (n,)
        Largest |x| of a run that is unsettled, in the last WATCHED periods; else NaN.
    """

    orbits: Orbits
    problem: np.ndarray
    orbit: np.ndarray
    displacement: np.ndarray


def random_starts(problems, sizes, count, seed):
    """Return random states at T = 0, shape (n count, SIZE), `count` for each problem in turn.

    Their components have all proportions, and their sizes are spread evenly over the logarithm, so
    that small and large motions are tried alike. With a softening spring they stay within its
    barriers.

    Parameters
    ----------
    problems : numpy.ndarray, shape (n, COUNT)
    sizes : numpy.ndarray, shape (n, SIZE)
        Components of the largest motions.
    count, seed : int
    """
    most = SPREAD * sizes
    for (stiffness, cubic), place in zip(springs(problems), (0, 2), strict=True):
        with np.errstate(divide="ignore", invalid="ignore"):
            softening = np.maximum(-cubic, 0.0)
            barrier = np.sqrt(stiffness / softening)
            speed = stiffness / np.sqrt(2 * softening)
        most[:, place] = np.fmin(most[:, place], barrier)
        most[:, place + 1] = np.fmin(most[:, place + 1], speed)
    draws = qmc.Halton(SIZE + 1, seed=seed).random(len(problems) * count)
    states = SMALLEST ** draws[:, -1:] * (2 * draws[:, :-1] - 1) * np.repeat(most, count, axis=0)
    if active_size(problems) < SIZE:
        states[:, 2:] = states[:, :2]
    return states


def settle(problems, orbits, starts) -> Settled:
    """Run starts until they are near a stable orbit, have escaped, or are given up.

    Parameters
    ----------
    problems : numpy.ndarray, shape (n, COUNT)
    orbits : Orbits
        Stable orbits that are known.
    starts : numpy.ndarray, shape (n count, SIZE)
        The same number for each problem in turn.
    """
    problem = np.repeat(np.arange(len(problems)), len(starts) // len(problems))
    state, end = starts.copy(), np.full(len(starts), UNSETTLED)
    bound = OUTSIDE * np.abs(starts).max(axis=0)
    decay = np.pi * problems[:, DAMPING].min()
    looks = int(np.ceil(min(DECAY / decay / STRETCH, LONGEST)))
    searched = {int(np.ceil(share * looks)) for share in SEARCHED}
    active = np.arange(len(starts))
    for look in range(1, looks + 1):
        state[active], _ = _run(problems[problem[active]], state[active], COARSE, STRETCH)
        gone = ~(np.abs(state[active]) < bound).all(axis=1)
        end[active[gone]] = ESCAPED
        active = active[~gone]
        if look in searched:
            orbits = _with_new(problems, orbits, problem[active], state[active])
        end[active] = _nearest(orbits, problem[active], state[active])
        active = active[end[active] == UNSETTLED]
        if not len(active):
            break
    sizes = np.full(len(starts), np.nan)
    sizes[active] = _run(problems[problem[active]], state[active], FINE, WATCHED)[1][:, 0]
    return Settled(orbits, problem, end, sizes)


def _run(problems, state, longest, periods):
    """Return states after some periods, and the largest moduli of their components."""
    after, largest = state.copy(), np.empty_like(state)
    steps = steps_for(problems, state, longest)
    with np.errstate(all="ignore"):
        run(problems, after, steps, periods, np.empty((len(state), 0, SIZE)), largest)
    return after, largest


def _nearest(orbits, problem, state):
    """Return the index of the orbit that is near each state, or UNSETTLED."""
    order = np.argsort(orbits.problem, kind="stable")
    counts = np.bincount(orbits.problem, minlength=problem.max(initial=-1) + 1)
    first = np.cumsum(counts) - counts
    best, end = np.full(len(state), NEAR), np.full(len(state), UNSETTLED)
    for place in range(counts.max(initial=0)):
        some = np.flatnonzero(counts[problem] > place)
        candidate = order[first[problem[some]] + place]
        away = np.abs(state[some] - orbits.state[candidate]) / orbits.largest[candidate]
        away = away.max(axis=1)
        nearer = away < best[some]
        best[some[nearer]], end[some[nearer]] = away[nearer], candidate[nearer]
    return end


def _with_new(problems, orbits, problem, state):
    """Return orbits with the stable ones to which Newton's method leads from states of runs.

    A run from which an orbit of a short period is found is not asked for longer ones.
    """
    for period in PERIODS:
        far = np.flatnonzero(_nearest(orbits, problem, state) == UNSETTLED)
        if not len(far):
            break
        found = find_orbits(problems, problem[far], state[far], period)
        found = found.take(found.stable)
        if period > 1:
            found = _all_phases(problems, found)
        orbits = orbits.joined(found).distinct()
    return orbits


def _all_phases(problems, orbits):
    """Return orbits together with those from their states a forcing period later, and so on."""
    found, state = orbits, orbits.state
    for _ in range(1, orbits.period.max(initial=1)):
        state, _ = _run(problems[orbits.problem], state, FINE, 1)
        found = found.joined(find_orbits(problems, orbits.problem, state, orbits.period[0]))
    return found.take(found.stable)
