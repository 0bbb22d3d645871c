"""Run starts until they settle to a known or new orbit, escape, or prove to be not periodic.

A start is a state from which a motion is computed. A problem is a row of parameters that
`motions.smooth_runs.run` reads: a machine with an absorber at one forcing frequency and force. x is
the displacement of the machine.
"""

from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from impact_damper.design.absorber_orbits import Orbits, find_orbits
from impact_damper.design.absorber_problems import COARSE, FINE, active_size, springs, steps_for
from impact_damper.design.smooth_runs import DAMPING, SIZE, run

# Random starts:
# SPREAD    size of the largest start divided by the size of the largest known motion
# SMALLEST  size of the smallest start divided by the size of the largest start
SPREAD, SMALLEST = 3.0, 0.01
# The runs are inspected every STRETCH forcing cycles. STRETCH is a multiple of each of PERIODS.
# After the fraction SEARCHED of all inspections, Newton's method searches for orbits of the periods
# PERIODS from the states of those runs that are near no known orbit.
STRETCH = 12
PERIODS = (1, 2, 3)
SEARCHED = 0.75
# A run has reached an orbit when its distance from the orbit, divided by the size of the orbit, is
# below NEAR. In this test the size of an orbit is at least SMALL times the largest known motion
# under the same force.
NEAR, SMALL = 0.02, 0.1
# Runs end after the time in which a linear vibration of the machine alone decays by exp(-DECAY),
# but after LONGEST inspections at the latest. A run that is then near no orbit is watched for
# WATCHED further inspections, which are divided into quarters. A quantity falls if its mean
# decreases from each quarter to the next, and in total below FALLEN times the first mean. If the
# distance from an orbit falls, the run approaches this orbit. Otherwise, if the largest
# displacement falls, the run is unsettled.
DECAY, LONGEST = 9.0, 40
WATCHED, FALLEN = 20, 0.95
# A run has escaped when it exceeds OUTSIDE times the largest known motion.
OUTSIDE = 100.0
# Results of runs that lead to no orbit, in place of the index of an orbit. WANDERING: the motion is
# not periodic.
WANDERING, ESCAPED, UNSETTLED = -1, -2, -3


class Settled(NamedTuple):
    """Results of runs from n starts.

    Attributes
    ----------
    orbits : Orbits
        The known orbits and the orbits that starts led to. An orbit with a period of k forcing
        cycles occurs k times, once for each of its states at the beginning of a cycle.
    problem : numpy.ndarray of int, shape (n,)
        Problem of each start.
    orbit : numpy.ndarray of int, shape (n,)
        Index of the orbit that the start leads to, or one of WANDERING, ESCAPED and UNSETTLED.
    displacement : numpy.ndarray, shape (n,)
        Largest |x| of a WANDERING run while it was watched; NaN for other runs.
    state : numpy.ndarray, shape (n, SIZE)
        Last state of the run at the beginning of a forcing cycle.
    """

    orbits: Orbits
    problem: np.ndarray
    orbit: np.ndarray
    displacement: np.ndarray
    state: np.ndarray

    def joined(self, later) -> "Settled":
        """Return these results followed by the results of later runs, which know more orbits."""
        pairs = zip(self[1:], later[1:], strict=True)
        return Settled(later.orbits, *(np.concatenate(pair) for pair in pairs))


def random_starts(problems, sizes, count, seed):
    """Return random states at T = 0, shape (n count, SIZE), with `count` rows for each problem.

    The directions of the states are random, and their sizes are distributed evenly on a logarithmic
    scale. With a softening spring the states stay within the barriers of the spring.

    Parameters
    ----------
    problems : numpy.ndarray, shape (n, COUNT)
    sizes : numpy.ndarray, shape (n, SIZE)
        Largest components of the states of known motions.
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
    """Run starts until they are near a stable orbit or have escaped, or until a limit.

    Parameters
    ----------
    problems : numpy.ndarray, shape (n, COUNT)
    orbits : Orbits
        Stable orbits that are known.
    problem : numpy.ndarray of int, shape (m,)
        Problem of each start.
    starts : numpy.ndarray, shape (m, SIZE)
        States at T = 0.
    sizes : numpy.ndarray, shape (n, SIZE)
        Largest components of the states of known motions.
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
        # The beats of an unforced vibration that has not yet decayed look like a motion that is not
        # periodic.
        end[end == WANDERING] = UNSETTLED
    return Settled(orbits, problem, end, displacement, state)


def _watch(problems, orbits, problem, state, sizes, bound):
    """Watch runs that are near no orbit at the end of `settle` (see WATCHED).

    Return their results (`Settled.orbit`), the largest |x| of WANDERING runs, and the last states.
    A run has escaped if a component of its last state is not below `bound`.
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
    """Return for each column whether the values fall from quarter to quarter (see WATCHED)."""
    means = values.reshape(4, WATCHED // 4, values.shape[1]).mean(axis=1)
    return (means[1:] < means[:-1]).all(axis=0) & (means[-1] < FALLEN * means[0])


def _run(problems, state, longest, periods):
    """Return the states after a number of cycles, and the largest moduli of their components."""
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
    """Return relative distances of states from the orbits of `_candidates`, shape (count, n)."""
    candidates = _candidates(orbits, problem)
    if not len(orbits.problem):
        return np.full(candidates.shape, np.inf)
    scale = np.maximum(orbits.largest[candidates], SMALL * sizes[problem])
    away = (np.abs(state - orbits.state[candidates]) / scale).max(axis=2)
    return np.where(candidates < 0, np.inf, away)


def _nearest(orbits, problem, state, sizes):
    """Return the index of the orbit that is near each state (NEAR), or UNSETTLED."""
    away, columns = _distances(orbits, problem, state, sizes), np.arange(len(state))
    best = away.argmin(axis=0)
    nearest = _candidates(orbits, problem)[best, columns]
    return np.where(away[best, columns] < NEAR, nearest, UNSETTLED)


def _with_new(problems, orbits, problem, state, sizes):
    """Return `orbits` with the stable orbits added that Newton's method finds from states of runs.

    If an orbit of a short period is found from a run, longer periods are not tried from this run.
    """
    for period in PERIODS:
        far = np.flatnonzero(_nearest(orbits, problem, state, sizes) == UNSETTLED)
        if not len(far):
            break
        new = find_orbits(problems, problem[far], state[far], period)
        new = new.take(new.stable)
        if period > 1:
            new = _all_phases(problems, new)
        orbits = orbits.joined(new).distinct()
    return orbits


def _all_phases(problems, orbits):
    """Return each orbit once for each of its states at the beginning of a forcing cycle."""
    phases, state = orbits, orbits.state
    for _ in range(1, orbits.period.max(initial=1)):
        state, _ = _run(problems[orbits.problem], state, FINE, 1)
        phases = phases.joined(find_orbits(problems, orbits.problem, state, orbits.period[0]))
    return phases.take(phases.stable)
