"""Motions from random starts, and the displacement below which a share of all motions stays.

A cell is a gap, a forcing frequency, and a factor for each value that may deviate from its nominal
value. A regime is a group of unsettled motions of one cell with similar largest displacements.
docs/explanation/promise.md says how the displacement of a regime is extrapolated.
"""

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from impact_damper.design.task import NOMINAL
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble
from impact_damper.motions.records import AT_REST, DRIFTING, NON_COLLIDING, SETTLED
from impact_damper.motions.start_states import random_starts
from impact_damper.motions.steady import run_chunks

# A motion is not continued after these outcomes: LASTING in its first run, KEPT in later runs.
LASTING = (SETTLED, NON_COLLIDING, AT_REST, DRIFTING)
KEPT = (SETTLED, NON_COLLIDING, AT_REST)
# Purposes for which starts are drawn. The seed of the starts depends on the purpose. The search for
# a gap and the confirmation of the gap therefore use different starts.
STREAMS = "search compared confirmed orbit forces masses repeated shocks searched_again".split()
# A thread draws the starts of DRAWN cells at a time, and runs FOLLOWED motions at a time.
# `Motions.largest` continues up to TOGETHER regimes, then computes the bounds of all cells again.
DRAWN, FOLLOWED, TOGETHER = 4, 64, 8
# Unsettled motions are sorted by displacement. Neighbours with a ratio up to APART form a regime.
APART = 1.3
# A block peak is the largest displacement of a motion in BLOCK cycles. `return_level` extrapolates
# the TAIL largest block peaks to the displacement that is exceeded once in HORIZON cycles.
BLOCK, TAIL, HORIZON = 50, 50, 100_000
# The cycles of all motions of a regime are added up. The displacement is extrapolated if the sum is
# POOLED or more. A regime is not run further if the sum is MOST_POOLED or more.
POOLED, MOST_POOLED = 25_000, 200_000
# With fewer than POOLED cycles the displacement is not extrapolated. It is raised by the fraction
# MISSING for each time that the number of cycles must be doubled to reach POOLED.
MISSING = 0.03
# A run has QUARTERS parts, each with a largest displacement. If these differ at most by the
# fraction STEADY, nothing is extrapolated. To compare gaps, ROUGH is used instead of STEADY.
# SLACK: largest fraction by which a settled motion exceeds the displacement of its orbit.
QUARTERS, STEADY, ROUGH, SLACK = 4, 0.002, 0.01, 0.001
# Before a regime is run further, its motions get this number of cycles to settle.
CHECKED = 100


class Cell(NamedTuple):
    """A gap (m), a forcing frequency (Hz), and a factor for each value named in VARIED."""

    gap: float
    frequency: float
    factors: tuple = NOMINAL


def draw_starts(task, cells, count, stream) -> np.ndarray:
    """Return `count` random starts for each cell, shape (cells, count, 4).

    The tuple `stream` sets the seed. Its first entry is a name in STREAMS. Numbers follow if the
    same name is used several times.
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
        Results of the first run, which ends when the motion settles or is stopped.
    states : array, shape (m, n, 4)
        States of the motions at their last strobe. The strobe is a fixed phase of the forcing.
    settled : array of bool, shape (m, n)
        True if the motion is not run on: its outcome is in LASTING or KEPT, or it has escaped.
    peaks : array, shape (m, n)
        Largest displacement of the motion so far; infinite after an escape.
    early : array, shape (m, n, QUARTERS)
        Largest displacement in each quarter of the `Settling.watched` cycles after the first run.
        The entries of a settled motion are 0.
    blocks : array of arrays, shape (m,)
        Block peaks (see BLOCK) in each cell, shape (n, blocks). A block that was not run has NaN.
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
        """Return the regimes of cell k, each as an array with the indices of its motions."""
        places = np.flatnonzero(~self.settled[k])
        order = places[np.argsort(self.peaks[k, places], kind="stable")]
        sizes = self.peaks[k, order]
        found = np.split(order, 1 + np.flatnonzero(sizes[1:] > APART * sizes[:-1]))
        return [regime for regime in found if len(regime)]

    def measured(self, k, regime, rough=False) -> tuple:
        """Return the displacement of a regime of cell k, and two booleans: known, tested.

        A regime with a known displacement is not run further. The displacement is tested if no late
        block peak exceeds what is extrapolated from early block peaks. `rough` is for comparing
        gaps. The displacement is then an estimate, and no bound.
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
        middle = peaks.shape[1] // 2
        tested = np.nanmax(peaks[:, middle:]) <= return_level(peaks[:, :middle])
        return return_level(peaks), tested or pooled >= MOST_POOLED, tested

    def numbers(self, k, rough=False) -> tuple:
        """Return the displacement of each motion of cell k, and a boolean array: True if known."""
        sizes, known = (1 + SLACK) * self.peaks[k], self.settled[k].copy()
        for regime in self.regimes(k):
            sizes[regime], known[regime], _ = self.measured(k, regime, rough)
        return sizes, known

    def bounds(self, rank) -> tuple:
        """Return three arrays with an entry for each cell.

        The first holds the `rank`-th largest displacement, the second the index of the start that
        led to it. The third is 1 if this displacement is known, otherwise 0.
        """
        found = np.empty(len(self.peaks)), *np.empty((2, len(self.peaks)), int)
        for k in range(len(self.peaks)):
            sizes, known = self.numbers(k)
            place = np.argsort(-sizes, kind="stable")[rank - 1]
            found[0][k], found[1][k], found[2][k] = sizes[place], place, known[place]
        return found

    def grows(self, k) -> bool:
        """Return whether a regime of cell k still moves further after MOST_POOLED cycles."""
        results = [self.measured(k, regime) for regime in self.regimes(k)]
        return any(known and not tested for _, known, tested in results)

    def largest(self, rank, least=0.0, left_out=()) -> np.ndarray:
        """Run motions until the largest bound of all cells is known. Return the bounds.

        The bound of a cell is the `rank`-th largest displacement of its motions. In a cell that has
        not been run long enough, the bound is an estimate. The cell is run further if the estimate
        exceeds `least` and all known bounds. Cells with indices in `left_out` are never run.
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
        """Run a regime of cell k until its number of cycles has doubled.

        The first call runs POOLED/2 cycles or more, and replaces the displacements of earlier
        cycles, because these may be transients.
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
        """Return a new object with the cells of this object, followed by the cells of `other`."""
        pairs = {
            each.name: np.concatenate([getattr(self, each.name), getattr(other, each.name)])
            for each in fields(self)
            if each.name != "task"
        }
        return Motions(task=self.task, **pairs)


def run(task, cells, count, stream, progress=None) -> Motions:
    """Return motions from `count` random starts in each cell, after their first run."""
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
    """Return the largest displacement of each motion in each block, shape (motions, number).

    A motion is run for `number` blocks of `cycles` forcing cycles. Each block begins at a strobe.
    The final states are written into `states`. After an escape, displacements are infinite.
    """
    peaks = np.zeros((number, len(states)))

    def work(part):
        contacts = np.zeros(len(states[part]), np.int64)
        for row in peaks:
            given = parameters[part], states[part], cycles, task.effort.settling.tolerance
            ensemble.follow_many(*given, contacts, row[part])

    run_chunks(work, len(states), task.effort.workers, None, np.zeros(1), size=FOLLOWED)
    return peaks.T


def return_level(peaks) -> float:
    """Return the displacement that is exceeded once in HORIZON cycles, from block peaks.

    Excesses of peaks over a high level are assumed to be distributed exponentially (S. Coles, An
    Introduction to Statistical Modeling of Extreme Values, 2001, chapter 4). A bounded motion has
    fewer large peaks than this distribution, so the result is too large rather than too small. It
    is at least the largest block peak.
    """
    peaks = np.sort(peaks[np.isfinite(peaks)])
    tops = peaks[-TAIL - 1 :]
    expected = HORIZON / BLOCK * (len(tops) - 1) / len(peaks)
    excess = np.mean(tops[1:] - tops[0]) if len(tops) > 1 else 0.0
    return float(max(tops[-1], tops[0] + excess * np.log(max(expected, 1.0))))
