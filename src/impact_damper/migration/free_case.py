"""What releases are judged by: the free oscillator at one frequency, and the goal."""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.attraction.attractors import Attractors
from impact_damper.attraction.labels import label_states
from impact_damper.migration.release_set import ReleaseSet
from impact_damper.system.settling import Settling


class FreeCase(NamedTuple):
    """The free oscillator at one frequency, its goal, and how its motions are run.

    Attributes
    ----------
    p : numpy.ndarray, shape (packed.COUNT,)
        Packed parameters without a damper.
    attractors : attraction.attractors.Attractors
        The last of them is the resonance motion.
    goal : int
        Index of the non-resonance motion among them.
    releases : ReleaseSet
        Of this goal; with a wrong model of the oscillator, the one that the controller knows.
    settling : Settling
    workers : int
        Threads; results do not depend on it.
    """

    p: np.ndarray
    attractors: Attractors
    goal: int
    releases: ReleaseSet
    settling: Settling
    workers: int = 1

    @property
    def resonance(self):
        """Index of the resonance motion among the attractors."""
        return len(self.attractors.records) - 1

    @property
    def size(self):
        """Largest displacement of the resonance motion."""
        return float(self.attractors.records["maximum_displacement"][-1])

    def labels(self, states, phase=math.pi / 2, limit=math.inf):
        """Return labels of states at a phase W T, and the forcing periods until they are known.

        A motion not known after `limit` forcing periods counts as unresolved.
        """
        most = int(min(self.settling.limit, limit))
        given = self.attractors, self.settling.tolerance, most, self.workers
        return label_states(self.p, states, phase, *given)

    def strobe_states(self, labels, shares):
        """Return a state at a strobe of each attractor, of one of its passages.

        `shares` are numbers from 0 to 1, which choose the passage.
        """
        owner = self.attractors.owner
        first = np.searchsorted(owner, labels)
        number = np.searchsorted(owner, labels, side="right") - first
        passage = np.minimum((shares * number).astype(int), number - 1)
        return self.attractors.centre[first + passage]
