"""Motions from random starts at cells, and the displacement that bounds a share of all starts.

A cell is a gap, a forcing frequency and factors of the values that may deviate. The displacement
of a motion on an orbit is the largest of the orbit; of one that does not settle, the record
(largest so far) of its regime, which grows as it runs on: docs/explanation/promise.md.
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
STREAMS = ("search", "compared", "confirmed", "orbit", "forces", "masses", "repeated")
# Cells for which a thread draws starts at once, motions that a thread follows at once, and cells
# that are followed before bounds are compared again.
DRAWN, FOLLOWED, TOGETHER = 4, 8, 8
# Motions that do not settle belong to one regime if their records, in order of size, differ by a
# factor of at most APART from one to the next.
APART = 1.3
# A regime's displacement is exceeded once in HORIZON cycles, by extrapolation from the TAIL largest
# peaks, each of BLOCK cycles. All its motions together are run for POOLED cycles at least and for
# MOST_POOLED at most.
BLOCK, TAIL, HORIZON = 50, 50, 100_000
POOLED, MOST_POOLED = 25_000, 200_000
# A record over fewer than POOLED cycles may grow by MISSING with each doubling.
MISSING = 0.03
# If the records of the four quarters of a run differ by at most STEADY, the regime is a torus.
# A motion that approaches an orbit may exceed it by as much as SLACK.
STEADY, SLACK = 0.002, 0.001
# A followed motion is on an orbit if it settles within CHECKED cycles.
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
    peaks : array, shape (m, n)
        Largest displacement of the orbit, or so far.
    blocks : array of arrays, shape (m,)
        Peaks of motions that are followed: each of shape (n, blocks), one for BLOCK cycles.
    """

    task: object
    parameters: np.ndarray
    records: np.ndarray
    states: np.ndarray
    settled: np.ndarray
    peaks: np.ndarray
    blocks: np.ndarray

    def regimes(self, k) -> list:
        """Return the regimes of cell k, each as an array of places of motions not settled."""
        places = np.flatnonzero(~self.settled[k])
        order = places[np.argsort(self.peaks[k, places], kind="stable")]
        sizes = self.peaks[k, order]
        found = np.split(order, 1 + np.flatnonzero(sizes[1:] > APART * sizes[:-1]))
        return [regime for regime in found if len(regime)]

    def measured(self, k, regime) -> tuple:
        """Return the displacement of a regime, whether it is known, and whether it was tested."""
        record, peaks = self.peaks[k, regime].max(), self.blocks[k][regime]
        peaks = peaks[:, np.isfinite(peaks).any(axis=0)]
        pooled = BLOCK * np.isfinite(peaks).sum()
        if np.isinf(record):
            return record, True, True
        if pooled < POOLED:
            cycles = max(pooled, len(regime) * self.task.effort.settling.watched)
            return record * (1 + MISSING * np.log2(max(2, POOLED / cycles))), False, False
        quarters = np.nanmax(peaks, axis=0)
        quarters = [part.max() for part in np.array_split(quarters, 4)]
        if np.ptp(quarters) <= STEADY * record:
            return (1 + STEADY) * record, True, True
        middle = peaks.shape[1] // 2
        tested = np.nanmax(peaks[:, middle:]) <= return_level(peaks[:, :middle])
        return return_level(peaks), tested or pooled >= MOST_POOLED, tested

    def numbers(self, k) -> tuple:
        """Return the displacement of each start of cell k, and whether it is known."""
        sizes, known = (1 + SLACK) * self.peaks[k], self.settled[k].copy()
        for regime in self.regimes(k):
            sizes[regime], known[regime], _ = self.measured(k, regime)
        return sizes, known

    def bounds(self, rank) -> tuple:
        """Return displacement and index of the start of a rank in each cell, and if it is known."""
        found = np.empty(len(self.peaks)), *np.empty((2, len(self.peaks)), int)
        for k in range(len(self.peaks)):
            sizes, known = self.numbers(k)
            place = np.argsort(-sizes, kind="stable")[rank - 1]
            found[0][k], found[1][k], found[2][k] = sizes[place], place, known[place]
        return found

    def grows(self, k) -> bool:
        """Return whether a record of cell k exceeded its extrapolation after MOST_POOLED cycles."""
        results = [self.measured(k, regime) for regime in self.regimes(k)]
        return any(known and not tested for _, known, tested in results)

    def largest(self, rank, least=0.0, left_out=()) -> np.ndarray:
        """Follow motions until a largest bound above `least` is known; return all bounds.

        Cells `left_out` are not followed.
        """
        while True:
            bounds, places, known = self.bounds(rank)
            unsure = known == 0
            unsure[list(left_out)] = known[list(left_out)] = False
            largest = max(least, np.max(bounds, where=known == 1, initial=0.0))
            unsure = np.flatnonzero(unsure & (bounds > largest))
            if not len(unsure):
                return bounds
            for k in unsure[np.argsort(-bounds[unsure], kind="stable")[:TOGETHER]]:
                self.follow(k, next(each for each in self.regimes(k) if places[k] in each))

    def follow(self, k, regime) -> None:
        """Run the motions of a regime of cell k as long again, or at first for half of POOLED.

        What was measured before they were followed is forgotten, as it may include transients.
        """
        loud = regime[~self._settle(k, regime)]
        if not len(loud):
            return
        done = np.isfinite(self.blocks[k][loud]).sum(axis=1)
        number = done.max() or int(np.ceil(POOLED / 2 / BLOCK / len(loud)))
        peaks = np.full((len(self.settled[k]), number), np.nan)
        peaks[loud] = self._run(k, loud, number)
        self.blocks[k] = np.hstack([self.blocks[k], peaks])
        before = np.where(done > 0, self.peaks[k, loud], 0.0)
        self.peaks[k, loud] = np.maximum(before, peaks[loud].max(axis=1))

    def _run(self, k, places, number):
        """Return the peaks of motions of cell k in a number of blocks, shape (motions, number)."""
        tolerance, stop = self.task.effort.settling.tolerance, np.zeros(1, bool)
        states, peaks = self.states[k, places], np.zeros((number, len(places)))
        parameters = np.repeat(self.parameters[k : k + 1], len(places), axis=0)

        def work(part):
            for row in peaks:
                follow_peaks(parameters[part], states[part], BLOCK, tolerance, row[part], stop)

        ensemble.run_chunks(work, len(places), self.task.effort.workers, None, stop, size=FOLLOWED)
        self.states[k, places] = states
        return peaks.T

    def _settle(self, k, places):
        """Return which motions of cell k have settled meanwhile."""
        effort = self.task.effort
        found = ensemble.settle(
            np.repeat(self.parameters[k : k + 1], len(places), axis=0),
            self.states[k, places],
            Settling(effort.settling.tolerance, CHECKED, CHECKED, 1, 0),
            from_strobe=True,
            workers=effort.workers,
        )
        on = np.isin(found["outcome"], KEPT)
        self.settled[k, places[on]] = True
        self.peaks[k, places[on]] = found["maximum_displacement"][on]
        self.states[k, places] = found["state"]
        return on

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
    blocks = np.empty(len(cells), object)
    for k in range(len(cells)):
        blocks[k] = np.empty((count, 0))
    return Motions(
        task=task,
        parameters=parameters,
        records=records,
        states=records["state"].copy(),
        settled=settled | np.isinf(peaks),
        peaks=peaks.copy(),
        blocks=blocks,
    )


def return_level(peaks) -> float:
    """Return the displacement that motions exceed once in HORIZON cycles, from peaks of blocks.

    The excesses over a high level are taken as exponential (S. Coles, An Introduction to
    Statistical Modeling of Extreme Values, 2001, chapter 4). The tail of a bounded motion is
    shorter, so that the level is rather too large.
    """
    peaks = np.sort(peaks[np.isfinite(peaks)])
    tops = peaks[-TAIL - 1 :]
    expected = HORIZON / BLOCK * (len(tops) - 1) / len(peaks)
    excess = np.mean(tops[1:] - tops[0]) if len(tops) > 1 else 0.0
    return float(max(tops[-1], tops[0] + excess * np.log(max(expected, 1.0))))
