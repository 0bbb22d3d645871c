"""Holds of the damper recorded at even phases, and where releases from them lead."""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.attraction.labels import UNRESOLVED
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import advance, workspace
from impact_damper.migration.policies import switch_on
from impact_damper.migration.release_set import depth_of
from impact_damper.motions import ensemble
from impact_damper.system.packed import FREQUENCY


class Recording(NamedTuple):
    """Holds with the damper on, at moments of even phases.

    Attributes
    ----------
    begin : numpy.ndarray, shape (n,)
        Time of the switching on, in steps between two phases.
    limits : numpy.ndarray, shape (n,)
        Forcing periods at the end of each hold.
    states : numpy.ndarray, shape (n, moments, 2)
        Z1 and Z1'; not defined beyond the end of a hold.
    depth : numpy.ndarray, shape (n, moments)
        Depth inside the release set; NaN beyond the end of a hold.
    impacts : numpy.ndarray of int, shape (n, moments)
        Contacts begun until then.
    phases : int
        Phases in a forcing period.
    """

    begin: np.ndarray
    limits: np.ndarray
    states: np.ndarray
    depth: np.ndarray
    impacts: np.ndarray
    phases: int

    def phase(self, rows, moments):
        """Return the index of the phase of moments; `rows` and `moments` are indices of them."""
        return (np.floor(self.begin[rows]).astype(int) + 1 + moments) % self.phases

    def cycles(self, rows, moments):
        """Return the forcing periods from the switching on to moments."""
        return (1 + moments - self.begin[rows] % 1) / self.phases

    def ahead(self, rows, moments):
        """Return the forcing periods from moments to the next strobe."""
        return (self.phases // 4 - self.phase(rows, moments)) % self.phases / self.phases


@kernel
def record_many(
    on, off, starts, draws, limits, inside, half, tolerance, states, depth, impacts, stop
):
    """Write the states at even phases with the damper on.

    Parameters
    ----------
    on, off, starts, draws, limits, tolerance, stop
        As of `policies.hold_many`.
    inside, half : array
        Of the `ReleaseSet`.
    states, depth, impacts : array, shape (n, moments, 2) and (n, moments)
        Get Z1 and Z1', the depth inside the release set and the contacts begun.
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
    """Return the `Recording` of holds, run on several threads; arguments of `policies.hold`."""
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
    # the strobe is a quarter of a period after phase 0
    return Recording(phases * (0.25 + draws[:, 0]), limits, states, depth, impacts, phases)


def label_moments(free, recording, rows, moments, latest):
    """Return the labels of free motions from moments, and the forcing periods until arrival.

    Parameters
    ----------
    free : FreeCase
    recording : Recording
    rows, moments : array of int, shape (m,)
        Indices of the moments.
    latest : array, shape (m,)
        Forcing periods from the switching on after which an arrival is of no interest; the label
        is then UNRESOLVED.
    """
    labels, periods = np.full(len(rows), UNRESOLVED), np.zeros(len(rows), int)
    strobe = recording.cycles(rows, moments) + recording.ahead(rows, moments)
    every = recording.phase(rows, moments)
    for phase in np.unique(every):
        here = np.flatnonzero(every == phase)
        states = recording.states[rows[here], moments[here]]
        left = max(0.0, np.ceil(np.max((latest - strobe)[here])))
        angle = 2 * math.pi * phase / recording.phases
        labels[here], periods[here] = free.labels(states, angle, left)
    return labels, strobe + periods
