"""Where random starts end: on known orbits, on new ones, on no orbit, or outside."""

from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from impact_damper.absorbers.orbits import Orbits, find_orbits
from impact_damper.absorbers.problems import COARSE, FINE, active_size, springs, steps_for
from impact_damper.motions.smooth_runs import DAMPING, SIZE, run

# Random starts: size of the largest start over the largest known motion, and of the smallest start
# over the largest.
SPREAD, SMALLEST = 3.0, 0.01
# The runs are inspected every STRETCH forcing periods, a multiple of each of PERIODS. At the share
# SEARCHED of all inspections Newton's method looks for orbits of the periods PERIODS, from the
# states of the runs that are near no known orbit.
STRETCH = 12
PERIODS = (1, 2, 3)
SEARCHED = 0.75
# A run has reached an orbit when its distance, divided by the size of the orbit, is below this.
# This size is taken at least as SMALL times the largest known motion under the same force.
NEAR, SMALL = 0.02, 0.1
# A run that is still near no orbit after a linear vibration of the machine alone would have decayed
# by exp(-DECAY), or after LONGEST inspections, is watched for WATCHED further ones. If its mean
# distance from an orbit falls from each quarter of these to the next, in all below the share
# FALLEN, it approaches this orbit. Otherwise, if its largest displacement falls in this way, it is
# unsettled.
DECAY, LONGEST = 9.0, 40
WATCHED, FALLEN = 20, 0.95
# A run has escaped when it exceeds the largest known motion by this factor.
OUTSIDE = 100.0
# Ends of runs on no orbit, in place of the index of an orbit. WANDERING: a motion without a period.
WANDERING, ESCAPED, UNSETTLED = -1, -2, -3


class Settled(NamedTuple):
    """Ends of random starts.

    Attributes
    ----------
    orbits : Orbits
        The known orbits and those that starts led to. An orbit with a period of n forcing periods
        occurs n times, once for each of its states at the beginning of a forcing period.
    problem : numpy.ndarray of int, shape (n,)
        Problem of each start.
    orbit : numpy.ndarray of int, shape (n,)
        Index of the orbit on which it ends, or one of WANDERING, ESCAPED and UNSETTLED.
    displacement : numpy.ndarray, shape (n,)
        Largest |x| of a WANDERING run while it was watched; NaN for other runs.
    state : numpy.ndarray, shape (n, SIZE)
        Last state of the run at the beginning of a forcing period.
    """

    orbits: Orbits
    problem: np.ndarray
    orbit: np.ndarray
    displacement: np.ndarray
    state: np.ndarray

    def joined(self, later) -> "Settled":
        """Return these ends and the ends of later runs, which knew the orbits of these."""
        pairs = zip(self[1:], later[1:], strict=True)
        return Settled(later.orbits, *(np.concatenate(pair) for pair in pairs))


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


def settle(problems, orbits, problem, starts, sizes) -> Settled:
    """Run starts until they are near a stable orbit, have escaped, or are given up.

    Parameters
    ----------
    problems : numpy.ndarray, shape (n, COUNT)
    orbits : Orbits
        Stable orbits that are known.
    problem : numpy.ndarray of int, shape (m,)
        Problem of each start.
    starts : numpy.ndarray, shape (m, SIZE)
    sizes : numpy.ndarray, shape (n, SIZE)
        Components of the largest motions.
    """
    state, end = starts.copy(), np.full(len(starts), UNSETTLED)
    bound = OUTSIDE * sizes.max(axis=0)
    decay = np.pi * problems[:, DAMPING].min()
    needed = int(np.ceil(DECAY / decay / STRETCH))
    looks = min(needed, LONGEST)
    active = np.arange(len(starts))
    for look in range(1, looks + 1):
        state[active], _ = _run(problems[problem[active]], state[active], COARSE, STRETCH)
        gone = ~(np.abs(state[active]) < bound).all(axis=1)
        end[active[gone]] = ESCAPED
        active = active[~gone]
        if look == np.ceil(SEARCHED * looks):
            orbits = _with_new(problems, orbits, problem[active], state[active], sizes)
        end[active] = _nearest(orbits, problem[active], state[active], sizes)
        active = active[end[active] == UNSETTLED]
        if not len(active):
            break
    displacement = np.full(len(starts), np.nan)
    end[active], displacement[active], state[active] = _watch(
        problems, orbits, problem[active], state[active], sizes, bound
    )
    if active_size(problems) < SIZE and needed > looks:
        # beats of a free vibration that has not yet decayed look like a motion without a period
        end[end == WANDERING] = UNSETTLED
    return Settled(orbits, problem, end, displacement, state)


def _watch(problems, orbits, problem, state, sizes, bound):
    """Watch runs that were long near no orbit.

    Return their ends, the largest |x| of the wandering ones, and their last states. A run of which
    a component is not below `bound` at the end has escaped.
    """
    distances, displacements = [], []
    for _ in range(WATCHED):
        state, largest = _run(problems[problem], state, COARSE, STRETCH)
        displacements.append(largest[:, 0])
        distances.append(_distances(orbits, problem, state, sizes))
    distances, displacements = np.array(distances), np.array(displacements)
    nearest, columns = distances[-1].argmin(axis=0), np.arange(len(state))
    end = _candidates(orbits, problem)[nearest, columns]
    approaches = _falls(distances[:, nearest, columns])
    end = np.where(approaches, end, np.where(_falls(displacements), UNSETTLED, WANDERING))
    end[~(np.abs(state) < bound).all(axis=1)] = ESCAPED
    return end, np.where(end == WANDERING, displacements.max(axis=0), np.nan), state


def _falls(values):
    """Return whether the mean of each quarter of rows is below that of the quarter before."""
    means = values.reshape(4, WATCHED // 4, values.shape[1]).mean(axis=1)
    return (means[1:] < means[:-1]).all(axis=0) & (means[-1] < FALLEN * means[0])


def _run(problems, state, longest, periods):
    """Return states after some periods, and the largest moduli of their components."""
    after, largest = state.copy(), np.empty_like(state)
    steps = steps_for(problems, state, longest)
    with np.errstate(all="ignore"):
        run(problems, after, steps, periods, np.empty((len(state), 0, SIZE)), largest)
    return after, largest


def _candidates(orbits, problem):
    """Return the indices of the orbits of each problem, shape (count, n), padded with -1."""
    counts = np.bincount(orbits.problem, minlength=problem.max(initial=-1) + 1)
    order = np.argsort(orbits.problem, kind="stable")
    table = np.full((max(counts.max(initial=0), 1), len(counts)), -1)
    within = np.arange(len(order)) - np.repeat(np.cumsum(counts) - counts, counts)
    table[within, orbits.problem[order]] = order
    return table[:, problem]


def _distances(orbits, problem, state, sizes):
    """Return the relative distances of states from the orbits of `_candidates`."""
    candidates = _candidates(orbits, problem)
    if not len(orbits.problem):
        return np.full(candidates.shape, np.inf)
    scale = np.maximum(orbits.largest[candidates], SMALL * sizes[problem])
    away = (np.abs(state - orbits.state[candidates]) / scale).max(axis=2)
    return np.where(candidates < 0, np.inf, away)


def _nearest(orbits, problem, state, sizes):
    """Return the index of the orbit that is near each state, or UNSETTLED."""
    away, columns = _distances(orbits, problem, state, sizes), np.arange(len(state))
    best = away.argmin(axis=0)
    found = _candidates(orbits, problem)[best, columns]
    return np.where(away[best, columns] < NEAR, found, UNSETTLED)


def _with_new(problems, orbits, problem, state, sizes):
    """Return orbits, extended by the stable ones that Newton's method finds from states of runs.

    If an orbit of a short period is found from a run, longer periods are not tried from it.
    """
    for period in PERIODS:
        far = np.flatnonzero(_nearest(orbits, problem, state, sizes) == UNSETTLED)
        if not len(far):
            break
        found = find_orbits(problems, problem[far], state[far], period)
        found = found.take(found.stable)
        if period > 1:
            found = _all_phases(problems, found)
        orbits = orbits.joined(found).distinct()
    return orbits


def _all_phases(problems, orbits):
    """Return each orbit once for each of its states at the beginning of a forcing period."""
    found, state = orbits, orbits.state
    for _ in range(1, orbits.period.max(initial=1)):
        state, _ = _run(problems[orbits.problem], state, FINE, 1)
        found = found.joined(find_orbits(problems, orbits.problem, state, orbits.period[0]))
    return found.take(found.stable)
