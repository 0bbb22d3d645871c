"""Find stable motions over a grid of frequencies and forces, and the motions that starts lead to.

Orbits are found from single-term harmonic balance (`seeds`), and from random starts that lead to
none of these orbits (`settling`). An orbit that was found by a random start is followed to the
neighbouring frequencies and forces. Motions that are not periodic are found by runs from three
kinds of starts: random starts, states near unstable orbits (`_without_period`), and states of such
motions at neighbouring frequencies and forces. x is the displacement of the machine.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.design.absorber_orbits import Orbits, find_orbits
from impact_damper.design.absorber_seeds import harmonic_seeds
from impact_damper.design.absorber_settling import (
    ESCAPED,
    UNSETTLED,
    WANDERING,
    random_starts,
    settle,
)
from impact_damper.design.smooth_runs import SIZE

# Largest number of rounds. A round searches the grid neighbours of the motions that the round
# before found.
ROUNDS = 50
# A start near an unstable orbit is the state of the orbit times BESIDE.
BESIDE = 1.01
# Two motions that are not periodic count as one if the ratio of their displacements exceeds ALIKE.
ALIKE = 0.95
NEIGHBOURS = ((-1, 0), (1, 0), (0, -1), (0, 1))


class Search(NamedTuple):
    """Summary of the motions of each problem of a grid, arrays of shape (n,).

    Attributes
    ----------
    most, least : numpy.ndarray
        max |x| of the largest and of the smallest motion, NaN if there is no motion. For a motion
        that is not periodic, the largest |x| while it was watched.
    motions : numpy.ndarray of int
        Number of stable periodic motions.
    share : numpy.ndarray
        Share of starts that lead to the largest motion.
    escaped : numpy.ndarray
        Share of starts that escape over the barrier of a softening spring.
    status : numpy.ndarray of int
        Flags of `competitor_status`.
    """

    most: np.ndarray
    least: np.ndarray
    motions: np.ndarray
    share: np.ndarray
    escaped: np.ndarray
    status: np.ndarray


def search(problems, shape, starts, seed, sizes=None):
    """Search for motions over a grid of frequencies and force shares.

    Parameters
    ----------
    problems : numpy.ndarray, shape (n, COUNT)
    shape : tuple of 2 ints
        Numbers of frequencies and of force shares (factors of the excitation). Their product is n.
    starts, seed : int
        Number of random starts of each problem, and their seed.
    sizes : numpy.ndarray, shape (number of shares, SIZE), optional
        Largest components of the states of known motions for each force share. Random starts extend
        beyond these.

    Returns
    -------
    summary : Search
    orbits : Orbits
        The stable orbits, in the form of `settling.Settled.orbits`.
    sizes : numpy.ndarray, shape (number of shares, SIZE)
        For each force share the largest components of the orbits and of the argument `sizes`.
    """
    found = find_orbits(problems, *harmonic_seeds(problems))
    known = _stable(found)
    most = np.zeros((shape[1], SIZE)) if sizes is None else sizes.copy()
    np.maximum.at(most, known.problem % shape[1], known.largest)
    wide = most.copy()
    # The displacement of the machine relative to the absorber may be as large as the displacement
    # of the machine.
    wide[:, 2:] = np.maximum(wide[:, 2:], wide[:, :2])
    wide = np.tile(wide, (shape[0], 1))
    problem = np.repeat(np.arange(len(problems)), starts)
    states = random_starts(problems, wide, starts, seed)
    lost = _without_period(found)
    ends = settle(problems, known, problem, states, wide)
    ends = ends.joined(settle(problems, ends.orbits, lost.problem, BESIDE * lost.state, wide))
    orbits = _with_neighbours(problems, ends.orbits, len(known.problem), shape)
    ends = _with_wandering(problems, ends._replace(orbits=orbits), shape, wide)
    return _summary(ends, len(problems), starts), ends.orbits, most


def _without_period(orbits) -> Orbits:
    """Return the unstable orbits near which motions that are not periodic are searched for.

    The largest multiplier of such an orbit is complex (a quasi-periodic motion may be near) or
    negative (a motion of twice the period may be near).
    """
    orbits = orbits.take(orbits.converged & ~orbits.stable).distinct()
    place = np.abs(orbits.multipliers).argmax(axis=1)
    largest = orbits.multipliers[np.arange(len(place)), place]
    return orbits.take((largest.imag != 0) | (largest.real < 0))


def _stable(orbits) -> Orbits:
    """Return the stable orbits, each once."""
    return orbits.take(orbits.stable).distinct()


def _neighbours(index, shape):
    """Return the grid neighbours of the problems in `index`.

    A second array holds, for each neighbour, the place in `index` of the problem that it adjoins.
    """
    frequency, force = np.unravel_index(index, shape)
    there = [(frequency + i, force + j) for i, j in NEIGHBOURS]
    frequency, force = np.concatenate(there, axis=1)
    inside = (frequency >= 0) & (frequency < shape[0]) & (force >= 0) & (force < shape[1])
    beside = np.ravel_multi_index((frequency[inside], force[inside]), shape)
    return beside, np.tile(np.arange(len(index)), len(NEIGHBOURS))[inside]


def _with_neighbours(problems, orbits, first, shape):
    """Follow the orbits from index `first` on to neighbouring problems; return all orbits."""
    for _ in range(ROUNDS):
        new = orbits.take(slice(first, None))
        first = len(orbits.problem)
        for period in np.unique(new.period):
            some = new.take(new.period == period)
            index, place = _neighbours(some.problem, shape)
            orbits = orbits.joined(_stable(find_orbits(problems, index, some.state[place], period)))
        orbits = orbits.distinct()
        if len(orbits.problem) == first:
            break
    return orbits


def _with_wandering(problems, ends, shape, sizes):
    """Add to `ends` runs that begin at motions without a period, found at neighbouring problems."""
    tried = np.zeros(len(problems), bool)
    first = 0
    for _ in range(ROUNDS):
        new = first + np.flatnonzero(ends.orbit[first:] == WANDERING)
        first = len(ends.orbit)
        tried[ends.problem[new]] = True
        index, place = _neighbours(ends.problem[new], shape)
        index, once = np.unique(index, return_index=True)
        fresh = ~tried[index]
        index, place = index[fresh], place[once[fresh]]
        if not len(index):
            break
        tried[index] = True
        ends = ends.joined(settle(problems, ends.orbits, index, ends.state[new[place]], sizes))
    return ends


def _summary(ends, count, starts) -> Search:
    """Return the summary of each problem.

    The first `starts` runs of a problem begin at random starts. Shares refer to these runs only.
    """
    orbits = ends.orbits
    displacement = orbits.largest[:, 0]
    settled, wandering = ends.orbit >= 0, ends.orbit == WANDERING
    most, least = np.full(count, -np.inf), np.full(count, np.inf)
    for problem, sizes in (
        (orbits.problem, displacement),
        (ends.problem[wandering], ends.displacement[wandering]),
    ):
        np.maximum.at(most, problem, sizes)
        np.minimum.at(least, problem, sizes)
    reached = ends.displacement.copy()
    reached[settled] = displacement[ends.orbit[settled]]
    # Runs that lead to the same motion without a period have slightly different displacements.
    worst = reached >= ALIKE * most[ends.problem]

    def share(mask):
        return mask[: count * starts].reshape(count, starts).mean(axis=1)

    known = np.bincount(orbits.problem, weights=1 / orbits.period, minlength=count)
    status = np.full(count, flag("competitor_status", "found"))
    status[np.isinf(most)] = flag("competitor_status", "escaped")
    status[ends.problem[ends.orbit == UNSETTLED]] = flag("competitor_status", "not_settled")
    status[ends.problem[wandering]] = flag("competitor_status", "not_periodic")
    none = np.isinf(most)
    most[none] = least[none] = np.nan
    escaped = share(ends.orbit == ESCAPED)
    return Search(most, least, np.rint(known).astype(int), share(worst), escaped, status)
