"""The free oscillator at one frequency, and the free motions to which releases lead.

The goal of a release is the free non-resonance motion.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.attraction.attractors import Attractors
from impact_damper.attraction.labels import label_states
from impact_damper.migration.release_set import ReleaseSet
from impact_damper.system.settling import Settling


class FreeCase(NamedTuple):
    """The free oscillator at one frequency, its goal, and the settings of its runs.

    Attributes
    ----------
    p : numpy.ndarray, shape (packed.COUNT,)
        Packed parameters without a damper.
    attractors : attraction.attractors.Attractors
        The last of them is the resonance motion.
    goal : int
        Index of the non-resonance motion among them.
    releases : ReleaseSet
        Release set of the goal. If the controller has a wrong model of the oscillator, the release
        set of this model.
    settling : Settling
    workers : int
        Number of threads, on which results do not depend.
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
        """max |Z1| of the resonance motion."""
        return float(self.attractors.records["maximum_displacement"][-1])

    def labels(self, states, phase=math.pi / 2, limit=math.inf):
        """Return labels of states at a phase W T, and the forcing cycles until they are known.

        A motion whose label is not known after `limit` cycles counts as unresolved.
        """
        most = int(min(self.settling.limit, limit))
        settings = self.attractors, self.settling.tolerance, most, self.workers
        return label_states(self.p, states, phase, *settings)

    def strobe_states(self, labels, draws):
        """Return for each label a state Z1, Z1' of its attractor at a strobe (W T = pi/2).

        An attractor of period n has n such states. `draws` are numbers between 0 and 1 that select
        one of them.
        """
        owner = self.attractors.owner
        first = np.searchsorted(owner, labels)
        number = np.searchsorted(owner, labels, side="right") - first
        place = np.minimum((draws * number).astype(int), number - 1)
        return self.attractors.centre[first + place]
