"""Motions from random starts at cells, and the displacement that bounds a share of all starts.

A cell is a gap, a forcing frequency and a set of factors. A factor multiplies a value that may
deviate. A start is a random initial state. A record is the largest displacement of a motion so far.
A regime is a set of motions of one cell that have not settled and have similar records.
docs/explanation/promise.md says how the displacement of a regime is extrapolated.
"""

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from impact_damper.design.task import NOMINAL
from impact_damper.kernel.batch import advance
from impact_damper.kernel.single import side_of
from impact_damper.model.packed import FREQUENCY
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble
from impact_damper.motions.records import AT_REST, DRIFTING, NON_COLLIDING, SETTLED
from impact_damper.motions.start_states import random_starts
from impact_damper.motions.steady import run_chunks

# Outcomes with a known largest displacement: LASTING of the first run, KEPT of further runs.
LASTING = (SETTLED, NON_COLLIDING, AT_REST, DRIFTING)
KEPT = (SETTLED, NON_COLLIDING, AT_REST)
# Purposes for which starts are drawn. The index of a purpose is part of the seed. A choice and its
# confirmation therefore have different starts.
STREAMS = "search compared confirmed orbit forces masses repeated shocks searched_again".split()
# A thread draws the starts of at most DRAWN cells at once, and runs at most FOLLOWED motions at
# once. At most TOGETHER regimes are run further before bounds are compared again.
DRAWN, FOLLOWED, TOGETHER = 4, 64, 8
# Largest ratio of a record in a regime to the next smaller record.
APART = 1.3
# A peak is the largest displacement of a motion in BLOCK cycles. The displacement that a regime
# exceeds once in HORIZON cycles is extrapolated from its TAIL largest peaks.
BLOCK, TAIL, HORIZON = 50, 50, 100_000
# The cycles of all motions of a regime are added. From POOLED cycles on, the displacement is
# extrapolated. From MOST_POOLED cycles on, the regime is not run further.
POOLED, MOST_POOLED = 25_000, 200_000
# Relative growth of a record that is assumed for each doubling of the cycles up to POOLED.
MISSING = 0.03
# A regime is a torus if its largest displacements in QUARTERS parts of the run differ by at most
# the fraction STEADY, or ROUGH if gaps are only compared. SLACK: largest fraction by which a
# settled motion exceeds its orbit.
QUARTERS, STEADY, ROUGH, SLACK = 4, 0.002, 0.01, 0.001
# Number of cycles in which a motion may still settle before it is run further.
CHECKED = 100


class Cell(NamedTuple):
    """A gap (m), a forcing frequency (Hz), and the factors of the values that may deviate."""

    gap: float
    frequency: float
    factors: tuple = NOMINAL


def draw_starts(task, cells, count, stream) -> np.ndarray:
    """Return `count` random starts for each cell, shape (cells, count, 4).

    The tuple `stream` is a name in STREAMS, followed by numbers if the name is used several times.
    """
    states, stop = np.empty((len(cells), count, 4)), np.zeros(1, bool)
    name, *turn = stream

    def work(part):
        for place in range(part.start, part.stop):
            if not stop[0]:
                seed = [task.effort.seed, STREAMS.index(name), *turn, place]
                system = task.system(*cells[place])
                states[place], _ = random_starts(*system, count, seed, task.effort.settling)

    run_chunks(work, len(cells), task.effort.workers, None, stop, size=DRAWN)
    return states


@dataclass
class Motions:
    """Motions from n starts at each of m cells. Displacements are dimensionless.

    Attributes
    ----------
    parameters : array, shape (m, packed.COUNT)
    records : array of records.MOTION, shape (m, n)
        Results of the first run, in which each motion settles or is stopped.
    states : array, shape (m, n, 4)
        States of the motions at their last strobe. The strobe is a fixed phase of the forcing.
    settled : array of bool, shape (m, n)
        Whether the largest displacement of the motion is known.
    peaks : array, shape (m, n)
        Largest displacement of a motion that has settled, record of any other motion.
    early : array, shape (m, n, QUARTERS)
        Largest displacement in each quarter of the `Settling.watched` cycles after the first run, 0
        for a motion that has settled.
    blocks : array of arrays, shape (m,)
        Largest displacement in each block of BLOCK cycles, shape (n, blocks), NaN if not run.
    """

    task: object
    parameters: np.ndarray
    records: np.ndarray
    states: np.ndarray
    settled: np.ndarray
    peaks: np.ndarray
    early: np.ndarray
    blocks: np.ndarray

    def regimes(self, k) -> list:
        """Return the regimes of cell k, each as an array of the indices of its motions."""
        places = np.flatnonzero(~self.settled[k])
        order = places[np.argsort(self.peaks[k, places], kind="stable")]
        sizes = self.peaks[k, order]
        found = np.split(order, 1 + np.flatnonzero(sizes[1:] > APART * sizes[:-1]))
        return [regime for regime in found if len(regime)]

    def measured(self, k, regime, rough=False) -> tuple:
        """Return a regime's displacement, whether it is known, and whether it passed a test.

        With `rough` the displacement depends less on the number of motions in the regime. Then it
        serves to compare gaps, and is no bound.
        """
        record, peaks = self.peaks[k, regime].max(), self.blocks[k][regime]
        peaks = peaks[:, np.isfinite(peaks).any(axis=0)]
        pooled = BLOCK * np.isfinite(peaks).sum()
        if np.isinf(record):
            return record, True, True
        unsteady = np.ptp(self.early[k, regime].max(axis=0))
        if not pooled and unsteady <= (ROUGH if rough else STEADY) * record:
            return (1 + STEADY) * record, False, False
        if pooled < POOLED:
            count = self.peaks.shape[1] if rough else len(regime)
            cycles = max(pooled, count * self.task.effort.settling.watched)
            return record * (1 + MISSING * np.log2(max(2, POOLED / cycles))), False, False
        quarters = np.nanmax(peaks, axis=0)
        quarters = [part.max() for part in np.array_split(quarters, QUARTERS)]
        if np.ptp(quarters) <= STEADY * record:
            return (1 + STEADY) * record, True, True
        # Test: late peaks do not exceed the displacement that is extrapolated from early peaks.
        middle = peaks.shape[1] // 2
        tested = np.nanmax(peaks[:, middle:]) <= return_level(peaks[:, :middle])
        return return_level(peaks), tested or pooled >= MOST_POOLED, tested

    def numbers(self, k, rough=False) -> tuple:
        """Return two arrays over the starts of cell k: displacement, and whether it is known."""
        sizes, known = (1 + SLACK) * self.peaks[k], self.settled[k].copy()
        for regime in self.regimes(k):
            sizes[regime], known[regime], _ = self.measured(k, regime, rough)
        return sizes, known

    def bounds(self, rank) -> tuple:
        """Return three arrays over cells: `rank`-th largest displacement, its start, 1 if known."""
        found = np.empty(len(self.peaks)), *np.empty((2, len(self.peaks)), int)
        for k in range(len(self.peaks)):
            sizes, known = self.numbers(k)
            place = np.argsort(-sizes, kind="stable")[rank - 1]
            found[0][k], found[1][k], found[2][k] = sizes[place], place, known[place]
        return found

    def grows(self, k) -> bool:
        """Return whether a regime of cell k fails the test in `measured` at MOST_POOLED cycles."""
        results = [self.measured(k, regime) for regime in self.regimes(k)]
        return any(known and not tested for _, known, tested in results)

    def largest(self, rank, least=0.0, left_out=()) -> np.ndarray:
        """Run motions further until the largest bound is known or at most `least`; return bounds.

        The bound of a cell is its `rank`-th largest displacement. Cells in `left_out` are skipped.
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
        """Run a regime of cell k for as many cycles as before; at first at least POOLED/2 cycles.

        Records of the first run are dropped, because they may include transients.
        """
        loud = regime[~self._settle(k, regime)]
        if not len(loud):
            return
        done = np.isfinite(self.blocks[k][loud]).sum(axis=1)
        number = done.max() or max(QUARTERS, int(np.ceil(POOLED / 2 / BLOCK / len(loud))))
        peaks = np.full((len(self.settled[k]), number), np.nan)
        states = self.states[k, loud]
        rows = np.tile(self.parameters[k], (len(loud), 1))
        peaks[loud] = peaks_of_blocks(self.task, rows, states, number, BLOCK)
        self.states[k, loud] = states
        self.blocks[k] = np.hstack([self.blocks[k], peaks])
        before = np.where(done > 0, self.peaks[k, loud], 0.0)
        self.peaks[k, loud] = np.maximum(before, peaks[loud].max(axis=1))

    def _settle(self, k, places):
        """Run motions of cell k for up to CHECKED cycles. Return the mask of those that settle."""
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
        """Return one object with the cells of this object, followed by the cells of `other`."""
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
    rows, effort = np.repeat(parameters, count, axis=0), task.effort
    records = ensemble.settle(
        rows, starts.reshape(-1, 4), task.hurried, workers=effort.workers, progress=progress
    )
    peaks, states = records["maximum_displacement"].copy(), records["state"].copy()
    settled = np.isin(records["outcome"], LASTING) | np.isinf(peaks)
    loud = np.flatnonzero(~settled)
    moving, early = states[loud], np.zeros((len(rows), QUARTERS))
    cycles = effort.settling.watched // QUARTERS
    early[loud] = peaks_of_blocks(task, rows[loud], moving, QUARTERS, cycles)
    peaks[loud], states[loud] = early[loud].max(axis=1), moving
    blocks = np.empty(len(cells), object)
    for k in range(len(cells)):
        blocks[k] = np.empty((count, 0))
    shape = len(cells), count
    return Motions(
        task=task,
        parameters=parameters,
        records=records.reshape(shape),
        states=states.reshape(*shape, 4),
        settled=(settled | np.isinf(peaks)).reshape(shape),
        peaks=peaks.reshape(shape),
        early=early.reshape(*shape, QUARTERS),
        blocks=blocks,
    )


def peaks_of_blocks(task, parameters, states, number, cycles) -> np.ndarray:
    """Run motions in blocks; return the largest displacements in them, shape (motions, number).

    Each of the `number` blocks has `cycles` forcing cycles and begins at a strobe. `states` change
    in place. Displacements are infinite from an escape on.
    """
    peaks = np.zeros((number, len(states)))
    sides = np.array([side_of(*each) for each in zip(parameters, states, strict=True)], np.int64)
    begins = 0.5 * np.pi / parameters[:, FREQUENCY]
    ends = begins + cycles * 2 * np.pi / parameters[:, FREQUENCY]

    def work(part):
        given = parameters[part], states[part], sides[part], begins[part], ends[part]
        contacts = np.zeros(len(given[1]), np.int64)
        for row in peaks:
            advance(*given, task.effort.settling.tolerance, contacts, row[part])

    run_chunks(work, len(states), task.effort.workers, None, np.zeros(1), size=FOLLOWED)
    return peaks.T


def return_level(peaks) -> float:
    """Return the displacement exceeded once in HORIZON cycles, but at least the largest peak.

    The excesses over a high level are assumed to be distributed exponentially (S. Coles, An
    Introduction to Statistical Modeling of Extreme Values, 2001, chapter 4). The tail of a bounded
    motion is shorter. The displacement returned is therefore too large rather than too small.
    """
    peaks = np.sort(peaks[np.isfinite(peaks)])
    tops = peaks[-TAIL - 1 :]
    expected = HORIZON / BLOCK * (len(tops) - 1) / len(peaks)
    excess = np.mean(tops[1:] - tops[0]) if len(tops) > 1 else 0.0
    return float(max(tops[-1], tops[0] + excess * np.log(max(expected, 1.0))))
