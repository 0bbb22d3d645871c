"""All stable motions found over a grid of frequencies and forces, and where random starts end.

Orbits come first from the balance of one harmonic (`seeds`), then from random starts that end near
none of them (`settling`). An orbit that only a start led to is looked for at the neighbouring
frequencies and forces too.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.absorbers.orbits import Orbits, find_orbits
from impact_damper.absorbers.seeds import harmonic_seeds
from impact_damper.absorbers.settling import ESCAPED, UNSETTLED, random_starts, settle
from impact_damper.data.datasets import flag

# Times that neighbours of new orbits are searched.
ROUNDS = 50


class Search(NamedTuple):
    """Motions and ends of starts for each problem of a grid, arrays of shape (n,).

    Attributes
    ----------
    most, least : numpy.ndarray
        Largest |x| in the largest and in the smallest motion, NaN if there is none. A motion that
        is unsettled counts with its largest |x| in a last stretch.
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
    """Search motions over a grid.

    Parameters
    ----------
    problems : numpy.ndarray, shape (n, COUNT)
    shape : tuple of 2 ints
        Numbers of frequencies and of force shares; their product is n.
    starts, seed : int
        Random starts of each problem, and their seed.
    sizes : numpy.ndarray, shape (number of shares, SIZE), optional
        Components of motions that the starts shall exceed, for each force share.

    Returns
    -------
    found : Search
    orbits : Orbits
        The stable orbits, as in `settling.Settled`.
    sizes : numpy.ndarray, shape (number of shares, SIZE)
        Largest components of the orbits for each force share, and of `sizes`.
    """
    known = _stable(find_orbits(problems, *harmonic_seeds(problems)))
    most = np.zeros((shape[1], problems.shape[1] // 2)) if sizes is None else sizes.copy()
    np.maximum.at(most, known.problem % shape[1], known.largest)
    wide = most.copy()
    # an absorber may be as far from the machine as this is from its rest
    wide[:, 2:] = np.maximum(wide[:, 2:], wide[:, :2])
    begun = random_starts(problems, np.tile(wide, (shape[0], 1)), starts, seed)
    ends = settle(problems, known, begun)
    orbits = _with_neighbours(problems, ends.orbits, len(known.problem), shape)
    return _summary(ends, orbits, len(problems)), orbits, most


def _stable(orbits) -> Orbits:
    return orbits.take(orbits.stable).distinct()


def _with_neighbours(problems, orbits, first, shape):
    """Return orbits with those found from orbits from index `first` on at neighbouring problems."""
    for _ in range(ROUNDS):
        new = orbits.take(slice(first, None))
        first = len(orbits.problem)
        places = np.unravel_index(new.problem, shape)
        for axis, change in ((0, -1), (0, 1), (1, -1), (1, 1)):
            there = [place + change * (k == axis) for k, place in enumerate(places)]
            inside = np.flatnonzero((there[axis] >= 0) & (there[axis] < shape[axis]))
            for period in np.unique(new.period[inside]):
                some = inside[new.period[inside] == period]
                index = np.ravel_multi_index([each[some] for each in there], shape)
                found = find_orbits(problems, index, new.state[some], period)
                orbits = orbits.joined(_stable(found)).distinct()
        if len(orbits.problem) == first:
            break
    return orbits


def _summary(ends, orbits, count) -> Search:
    """Return the values of each problem."""
    displacement = orbits.largest[:, 0]
    settled, unsettled = ends.orbit >= 0, ends.orbit == UNSETTLED
    most, least = np.full(count, -np.inf), np.full(count, np.inf)
    for problem, sizes in (
        (orbits.problem, displacement),
        (ends.problem[unsettled], ends.displacement[unsettled]),
    ):
        np.maximum.at(most, problem, sizes)
        np.minimum.at(least, problem, sizes)
    reached = ends.displacement.copy()
    reached[settled] = displacement[ends.orbit[settled]]
    starts = len(ends.problem) / count

    def share(mask):
        return np.bincount(ends.problem[mask], minlength=count) / starts

    # runs that are unsettled on one motion differ in what they reach within a stretch
    worst = reached >= 0.95 * most[ends.problem]
    known = np.bincount(orbits.problem, weights=1 / orbits.period, minlength=count)
    status = np.full(count, flag("competitor_status", "found"))
    status[np.isinf(most)] = flag("competitor_status", "escaped")
    status[share(unsettled) > 0] = flag("competitor_status", "not_periodic")
    none = np.isinf(most)
    most[none] = least[none] = np.nan
    escaped = share(ends.orbit == ESCAPED)
    return Search(most, least, np.rint(known).astype(int), share(worst), escaped, status)
