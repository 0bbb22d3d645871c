"""All stable periodic motions that are found of a machine with or without an absorber."""

from typing import NamedTuple

import numpy as np

from impact_damper.absorbers.orbits import Orbits, find_orbits
from impact_damper.absorbers.problems import Problems
from impact_damper.absorbers.seeds import harmonic_seeds

# Two orbits are one if their states differ less, relative to the larger of them.
SAME = 1e-6


class Motions(NamedTuple):
    """Stable periodic motions of several problems.

    Attributes
    ----------
    index : numpy.ndarray of int, shape (count,)
        Problem of each orbit.
    orbits : Orbits
    """

    index: np.ndarray
    orbits: Orbits


def stable_motions(problems: Problems) -> Motions:
    """Return the stable periodic motions to which the balance of one harmonic leads."""
    index, guesses = harmonic_seeds(problems)
    orbits = find_orbits(problems.take(index), guesses)
    kept = np.flatnonzero(orbits.stable)
    kept = kept[_first_of_each(index[kept], orbits.state[:, kept])]
    return Motions(index[kept], orbits.take(kept))


def _first_of_each(index, state):
    """Return the places of the different orbits: the first of those that agree."""
    kept = []
    for place in range(len(index)):
        same = [k for k in kept if index[k] == index[place]]
        size = np.abs(state[:, place]).max()
        if all(np.abs(state[:, place] - state[:, k]).max() > SAME * size for k in same):
            kept.append(place)
    return np.array(kept, int)
