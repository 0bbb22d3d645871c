"""Record motions with the damper on, and label the free motions after releases from them.

A hold is a time with the damper on, which ends with a release (switching the damper off). A label
is the index of the attractor, the stable motion, to which the free motion settles. The release set
contains the states, at evenly spaced phases of the forcing, from which the free motion settles to
the goal, the small free motion. A strobe is the time in each cycle at which the forcing has the
phase W T = pi/2.

Z1 is the displacement of the primary mass. Free means without the damper.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions import ensemble
from impact_damper.motions.labels import UNRESOLVED
from impact_damper.motions.policies import switch_on
from impact_damper.motions.release_set import depth_of


class Recording(NamedTuple):
    """States of n holds at their moments, the times at the phases of the release set.

    The phases divide a forcing cycle evenly. A step is the time between two phases.

    Attributes
    ----------
    begin : numpy.ndarray, shape (n,)
        Time at which the damper is switched on, in steps.
    limits : numpy.ndarray, shape (n,)
        Length of each hold in forcing cycles.
    states : numpy.ndarray, shape (n, moments, 2)
        Z1 and Z1'; undefined beyond the end of a hold.
    depth : numpy.ndarray, shape (n, moments)
        Depth inside the release set (distance from its boundary); NaN beyond the end of a hold.
    impacts : numpy.ndarray of int, shape (n, moments)
        Number of contacts begun before each moment.
    phases : int
        Number of phases in a forcing cycle.
    """

    begin: np.ndarray
    limits: np.ndarray
    states: np.ndarray
    depth: np.ndarray
    impacts: np.ndarray
    phases: int

    def phase(self, rows, moments):
        """Return the indices of the phases at moments of holds.

        `rows` are the indices of the holds, and `moments` the indices of the moments in them.
        """
        return (np.floor(self.begin[rows]).astype(int) + 1 + moments) % self.phases

    def cycles(self, rows, moments):
        """Return the forcing cycles between switching the damper on and moments of holds."""
        return (1 + moments - self.begin[rows] % 1) / self.phases

    def ahead(self, rows, moments):
        """Return the forcing cycles from moments of holds to the next strobes."""
        return (self.phases // 4 - self.phase(rows, moments)) % self.phases / self.phases


@kernel
def record_many(
    on, off, starts, draws, limits, inside, half, tolerance, states, depth, impacts, stop
):
    """Fill the arrays of a `Recording`.

    Parameters
    ----------
    on, off, starts, draws, limits, tolerance, stop
        Arguments of `policies.hold_many`.
    inside, half : array
        The attributes `depth` and `half` of a `ReleaseSet`.
    states, depth, impacts : array, shape (n, moments, 2) and (n, moments)
        Receive the attributes of `Recording` with these names.
    """
    none, work, y = np.empty((0, 4)), workspace(), np.empty(4)
    period = 2.0 * math.pi / on[FREQUENCY]
    phases = inside.shape[0]
    step = period / phases
    for i in range(len(starts)):
        if stop[0]:
            return
        begin, side = switch_on(on, off, starts, draws, i, tolerance, y, work)
        first = int(math.floor(begin / step)) + 1
        t, total = begin, 0
        for j in range(states.shape[1]):
            end = (first + j) * step
            if end - begin > limits[i] * period:
                break
            side, contacts, _ = advance(on, y, none, side, t, end, tolerance, work)
            total += contacts
            t = end
            states[i, j, 0], states[i, j, 1] = y[0], y[1]
            depth[i, j] = depth_of(inside, half, (first + j) % phases, y[0], y[1])
            impacts[i, j] = total


def record(on, free, starts, draws, limits) -> Recording:
    """Return the `Recording` of holds, run on several threads.

    The arguments are those of `policies.hold`.
    """
    phases = len(free.releases.depth)
    shape = len(starts), math.ceil(np.max(limits) * phases)
    states, depth = np.empty((*shape, 2)), np.full(shape, np.nan)
    impacts, stop = np.zeros(shape, np.int64), np.zeros(1, bool)

    def work(part):
        record_many(
            on,
            free.p,
            starts[part],
            draws[part],
            limits[part],
            free.releases.depth,
            free.releases.half,
            free.settling.tolerance,
            states[part],
            depth[part],
            impacts[part],
            stop,
        )

    work(slice(0, 0))
    ensemble.run_chunks(work, len(starts), free.workers, None, stop, size=8)
    # A strobe is a quarter of a cycle after phase 0.
    return Recording(phases * (0.25 + draws[:, 0]), limits, states, depth, impacts, phases)


def label_moments(free, recording, rows, moments, latest):
    """Label the free motions that follow releases at recorded moments.

    Parameters
    ----------
    free : FreeCase
    recording : Recording
    rows, moments : array of int, shape (m,)
        Indices of the hold and of the moment of each release.
    latest : array, shape (m,)
        Forcing cycles from the switching on after which an arrival does not count. The label of a
        later arrival may be UNRESOLVED.

    Returns
    -------
    labels : numpy.ndarray of int, shape (m,)
        Index of the attractor, or a negative label of `attraction.labels`.
    times : numpy.ndarray, shape (m,)
        Forcing cycles from the switching on until the label is known.
    """
    labels, periods = np.full(len(rows), UNRESOLVED), np.zeros(len(rows), int)
    strobe = recording.cycles(rows, moments) + recording.ahead(rows, moments)
    every = recording.phase(rows, moments)
    for phase in np.unique(every):
        same = np.flatnonzero(every == phase)
        states = recording.states[rows[same], moments[same]]
        left = max(0.0, np.ceil(np.max((latest - strobe)[same])))
        angle = 2 * math.pi * phase / recording.phases
        labels[same], periods[same] = free.labels(states, angle, left)
    return labels, strobe + periods
