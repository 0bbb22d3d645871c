"""Motions from random starts at cells, and the displacement that bounds a share of all starts.

A cell is a gap, a forcing frequency and factors of the values that may deviate. A motion on an
orbit counts with the largest displacement of the orbit. Motions that do not settle count with the
record of their regime, which grows as they are run longer: docs/explanation/promise.md.
"""

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from impact_damper.design.task import NOMINAL
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble
from impact_damper.motions.records import AT_REST, DRIFTING, NON_COLLIDING, SETTLED, follow_peaks
from impact_damper.motions.start_states import random_starts

# Outcomes of motions whose largest displacement is known.
LASTING = (SETTLED, NON_COLLIDING, AT_REST, DRIFTING)
KEPT = (SETTLED, NON_COLLIDING, AT_REST)
# Purposes for which starts are drawn. The index is part of the seed, so that no start is used both
# for a choice and for its confirmation.
STREAMS = ("search", "compared", "confirmed", "orbit", "forces", "masses")
# Cells for which a thread draws starts at once, motions that a thread follows at once, and cells
# whose motions are followed together.
DRAWN, FOLLOWED, TOGETHER = 4, 8, 8
# Motions that do not settle belong to one regime if their records, in order of size, differ by a
# factor of at most APART from one to the next.
APART = 1.3
# A record is known if the motions of the regime were run for POOLED cycles in all, and the last
# doubling of this number let it grow by less than GROWN. Run for MOST_POOLED cycles, it counts as
# it is, with a flag. Before, it may grow by MISSING for each doubling up to POOLED.
POOLED, GROWN, MOST_POOLED = 25_000, 0.01, 200_000
MISSING = 0.025
# A motion that approaches an orbit may exceed it by SLACK.
SLACK = 0.001
# Cycles in which a motion that is followed must settle to be found on an orbit.
CHECKED = 100


class Cell(NamedTuple):
    """A gap (m) and a forcing frequency (Hz), with factors of the values that may deviate."""

    gap: float
    frequency: float
    factors: tuple = NOMINAL


def draw_starts(task, cells, count, stream) -> np.ndarray:
    """Return random starts, shape (cells, count, 4), as large as the motions without the damper.

    `stream` is one of STREAMS and, if it is used several times, a number.
    """
    states, stop = np.empty((len(cells), count, 4)), np.zeros(1, bool)
    name, *turn = stream

    def work(part):
        for place in range(part.start, part.stop):
            if not stop[0]:
                seed = [task.effort.seed, STREAMS.index(name), *turn, place]
                system = task.system(*cells[place])
                states[place], _ = random_starts(*system, count, seed, task.effort.settling)

    ensemble.run_chunks(work, len(cells), task.effort.workers, None, stop, size=DRAWN)
    return states


@dataclass
class Motions:
    """Motions from n starts at each of m cells; displacements are dimensionless.

    Attributes
    ----------
    parameters : array, shape (m, packed.COUNT)
    records : array of records.MOTION, shape (m, n)
        As they were when the motions settled or were stopped first.
    states : array, shape (m, n, 4)
        At the last strobe.
    settled : array of bool, shape (m, n)
        Whether the motion is on an orbit.
    peaks, earlier : array, shape (m, n)
        Largest displacement of the orbit or so far, and before the last doubling.
    cycles : array, shape (m,)
        Cycles over which motions that have not settled were measured.
    followed : array of bool, shape (m,)
        Whether the motions were followed beyond the first run.
    """

    task: object
    parameters: np.ndarray
    records: np.ndarray
    states: np.ndarray
    settled: np.ndarray
    peaks: np.ndarray
    earlier: np.ndarray
    cycles: np.ndarray
    followed: np.ndarray

    def regimes(self, k) -> list:
        """Return the regimes of cell k, each as an array of places of motions not settled."""
        places = np.flatnonzero(~self.settled[k])
        order = places[np.argsort(self.peaks[k, places], kind="stable")]
        sizes = self.peaks[k, order]
        return np.split(order, 1 + np.flatnonzero(sizes[1:] > APART * sizes[:-1]))

    def growth(self, k, regime) -> float:
        """Return how much the record of a regime grew in the last doubling."""
        if np.isinf(self.peaks[k, regime]).any():
            return 0.0
        return self.peaks[k, regime].max() / self.earlier[k, regime].max() - 1

    def is_known(self, k, regime) -> bool:
        """Return whether the record of a regime is known, or will not be known better."""
        pooled = self.cycles[k] * len(regime)
        certain = self.followed[k] and pooled >= POOLED and self.growth(k, regime) < GROWN
        return certain or pooled >= MOST_POOLED or np.isinf(self.peaks[k, regime]).any()

    def numbers(self, k) -> tuple:
        """Return the displacement with which each start of cell k counts, and if it is known."""
        sizes, known = (1 + SLACK) * self.peaks[k], self.settled[k].copy()
        for regime in self.regimes(k):
            if len(regime):
                known[regime] = self.is_known(k, regime)
                left = max(GROWN, self.growth(k, regime))
                if not known[regime[0]] and self.cycles[k] * len(regime) < POOLED:
                    doublings = np.log2(POOLED / (self.cycles[k] * len(regime)))
                    left = max(left, MISSING * doublings)
                sizes[regime] = self.peaks[k, regime].max() * (1 + left)
        return sizes, known

    def bounds(self, rank) -> tuple:
        """Return the displacement of the start of a rank in each cell, shape (m,), and if known."""
        found = np.empty(len(self.peaks)), np.empty(len(self.peaks), bool)
        for k in range(len(self.peaks)):
            sizes, known = self.numbers(k)
            place = np.argsort(-sizes, kind="stable")[rank - 1]
            found[0][k], found[1][k] = sizes[place], known[place]
        return found

    def grows(self, k) -> bool:
        """Return whether a record of cell k still grew when it was run for MOST_POOLED."""
        return any(self.growth(k, regime) >= GROWN for regime in self.regimes(k) if len(regime))

    def largest(self, rank) -> np.ndarray:
        """Return the bounds of all cells, after the largest one is known."""
        while True:
            bounds, known = self.bounds(rank)
            largest = np.max(bounds, where=known, initial=0.0)
            unsure = np.flatnonzero(~known & (bounds > largest))
            if not len(unsure):
                return bounds
            self.follow(unsure[np.argsort(-bounds[unsure], kind="stable")[:TOGETHER]])

    def follow(self, cells) -> None:
        """Run the motions of some cells that have not settled for another doubling.

        The first time, what was measured before is forgotten, because transients may have lasted,
        and all motions of a cell together are run for POOLED cycles.
        """
        first = cells[~self.followed[cells]]
        if len(first):
            self.followed[first] = True
            self._settle(first)
            loud = ~self.settled[first]
            self.peaks[first] = np.where(loud, 0.0, self.peaks[first])
            half = np.ceil(POOLED / 2 / np.maximum(loud.sum(axis=1), 1))
            self.cycles[first] = np.maximum(half, self.task.effort.settling.watched)
            self._run(first)
        self._settle(cells)
        self.earlier[cells] = self.peaks[cells]
        self._run(cells)
        self.cycles[cells] *= 2

    def _places(self, cells):
        """Return rows and columns of the motions of some cells that have not settled."""
        chosen = np.isin(np.arange(len(self.peaks)), cells)
        return np.nonzero(~self.settled & chosen[:, None])

    def _run(self, cells):
        """Run each motion of some cells that has not settled for the `cycles` of its cell."""
        rows, columns = self._places(cells)
        tolerance, stop = self.task.effort.settling.tolerance, np.zeros(1, bool)
        for length in np.unique(self.cycles[rows]):
            these = self.cycles[rows] == length
            i, j = rows[these], columns[these]
            given, states, peaks = self.parameters[i], self.states[i, j], self.peaks[i, j]

            def work(part, given=given, states=states, peaks=peaks, length=length):
                follow_peaks(given[part], states[part], length, tolerance, peaks[part], stop)

            work(slice(0, 0))
            ensemble.run_chunks(work, len(i), self.task.effort.workers, None, stop, size=FOLLOWED)
            self.states[i, j], self.peaks[i, j] = states, peaks

    def _settle(self, cells):
        """Find the motions of some cells that have settled meanwhile."""
        rows, columns = self._places(cells)
        effort = self.task.effort
        found = ensemble.settle(
            self.parameters[rows],
            self.states[rows, columns],
            Settling(effort.settling.tolerance, CHECKED, CHECKED, 1, 0),
            from_strobe=True,
            workers=effort.workers,
        )
        on = np.isin(found["outcome"], KEPT)
        self.settled[rows[on], columns[on]] = True
        self.peaks[rows[on], columns[on]] = found["maximum_displacement"][on]
        self.states[rows, columns] = found["state"]

    def join(self, other) -> "Motions":
        """Return these motions and others, in this order."""
        pairs = {
            each.name: np.concatenate([getattr(self, each.name), getattr(other, each.name)])
            for each in fields(self)
            if each.name != "task"
        }
        return Motions(task=self.task, **pairs)


def run(task, cells, count, stream, progress=None) -> Motions:
    """Return the motions from `count` random starts at each cell, after a first run."""
    starts = draw_starts(task, cells, count, stream)
    parameters = np.array([task.packed(*cell) for cell in cells])
    records = ensemble.settle(
        np.repeat(parameters, count, axis=0),
        starts.reshape(-1, 4),
        task.hurried,
        workers=task.effort.workers,
        progress=progress,
    ).reshape(len(cells), count)
    peaks, settled = records["maximum_displacement"], np.isin(records["outcome"], LASTING)
    return Motions(
        task=task,
        parameters=parameters,
        records=records,
        states=records["state"].copy(),
        settled=settled | np.isinf(peaks),
        peaks=peaks.copy(),
        earlier=peaks.copy(),
        cycles=np.full(len(cells), task.effort.settling.watched),
        followed=np.zeros(len(cells), bool),
    )
