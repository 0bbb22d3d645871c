"""The free oscillator at one frequency, and the free motions to which releases lead.

Without the damper the oscillator has a large motion, the resonance motion, and a small one, the
non-resonance motion. A release switches the damper off. Its goal is the non-resonance motion. The
release set contains the states from which the free motion settles to the goal.

Z1 is the displacement of the primary mass.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.model.settling import Settling
from impact_damper.motions.attractors import Attractors
from impact_damper.motions.labels import label_states
from impact_damper.motions.release_set import ReleaseSet


class FreeCase(NamedTuple):
    """The free oscillator at one frequency, its goal, and the settings of its runs.

    Attributes
    ----------
    p : numpy.ndarray, shape (packed.COUNT,)
        Packed parameters without a damper.
    attractors : attraction.attractors.Attractors
        The stable free motions. The last of them is the resonance motion.
    goal : int
        Index of the non-resonance motion among the attractors.
    releases : ReleaseSet
        The release set that a controller uses. It may belong to other parameters than `p`, to study
        a controller with a wrong model of the oscillator.
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
        """Return the labels of n states at a phase W T, and the cycles until they are known.

        A label is the index of the attractor to which a state leads, or a negative label of
        `attraction.labels`. Both arrays have the shape (n,). A motion whose label is not known
        after `limit` forcing cycles has the label UNRESOLVED.
        """
        most = int(min(self.settling.limit, limit))
        settings = self.attractors, self.settling.tolerance, most, self.workers
        return label_states(self.p, states, phase, *settings)

    def strobe_states(self, labels, draws):
        """Return a state Z1, Z1' at a strobe (W T = pi/2) for each label, shape (n, 2).

        A label is the index of an attractor. An attractor of period n has n states at strobes.
        `draws` are numbers between 0 and 1, one for each label, that select one of these states.
        """
        owner = self.attractors.owner
        first = np.searchsorted(owner, labels)
        number = np.searchsorted(owner, labels, side="right") - first
        place = np.minimum((draws * number).astype(int), number - 1)
        return self.attractors.centre[first + place]
