"""Motions from random starts in each cell of a design, and bounds of their displacements."""

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from impact_damper.design.task import NOMINAL
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble
from impact_damper.motions.records import AT_REST, DRIFTING, NON_COLLIDING, SETTLED
from impact_damper.motions.start_states import random_starts
from impact_damper.motions.steady import run_chunks

# A motion that ends with one of these outcomes is not run further.
LASTING = (SETTLED, NON_COLLIDING, AT_REST, DRIFTING)  # outcomes of the first run of a motion
KEPT = (SETTLED, NON_COLLIDING, AT_REST)  # outcomes of later runs of a motion
# Purposes for which random starts are drawn. Different purposes have different starts.
STREAMS = "search compared confirmed orbit forces masses repeated shocks searched_again".split()
# DRAWN: number of cells for which a thread draws random starts at a time.
# FOLLOWED: number of motions that a thread integrates at a time.
# TOGETHER: `Motions.largest` runs motions of up to TOGETHER cells before it computes bounds again.
DRAWN, FOLLOWED, TOGETHER = 4, 64, 8
# A regime is a group of motions of one cell. The motions that have not settled are sorted by their
# largest displacements. A new regime begins where a displacement exceeds APART x its predecessor.
APART = 1.3
# A block peak is the largest displacement of a motion in a block of BLOCK forcing cycles. From the
# TAIL largest block peaks `return_level` extrapolates the largest displacement in HORIZON cycles.
BLOCK, TAIL, HORIZON = 50, 50, 100_000
# n is the sum of the forcing cycles of all motions of a regime. If n < POOLED, the largest
# displacement of the regime is multiplied by 1 + MISSING x max(1, log2(POOLED/n)). If n >= POOLED,
# this displacement is extrapolated. If n >= MOST_POOLED, the motions are not run further.
POOLED, MOST_POOLED = 25_000, 200_000
MISSING = 0.03
# D is the largest displacement of a regime. The run of the regime is divided into QUARTERS equal
# parts. The regime is steady if the largest displacements in the parts differ by at most STEADY x D
# (in the search for a gap: ROUGH x D). D is then not extrapolated, but multiplied by 1 + STEADY.
# The largest displacement of a settled motion is multiplied by 1 + SLACK.
QUARTERS, STEADY, ROUGH, SLACK = 4, 0.002, 0.01, 0.001
CHECKED = 100  # cycles of a test run before each longer run; it shows which motions settle


class Cell(NamedTuple):
    """A gap (m), a forcing frequency (Hz), and factors for the nominal values in `task.VARIED`."""

    gap: float
    frequency: float
    factors: tuple = NOMINAL


def draw_starts(task, cells, count, stream) -> np.ndarray:
    """Return `count` random starts for each of `cells`, shape (cells, count, 4).

    `stream` is a tuple: a name in STREAMS, then integers. Each tuple gives different starts.
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
    """Motions from n random starts in each of m cells. Displacements are dimensionless.

    Attributes
    ----------
    parameters : packed parameters of each cell, shape (m, packed.COUNT)
    records : array of records.MOTION, shape (m, n)
        Result of each motion's first run. This run ends when the motion settles, or at a limit.
    states : array, shape (m, n, 4)
        State of each motion at its last strobe. The strobe is a fixed phase of the forcing.
    settled : array of bool, shape (m, n)
        True after an outcome in LASTING or KEPT, or an escape. The motion is then not run further.
    peaks : array, shape (m, n)
        Largest displacement of each motion so far; infinite after an escape.
    early : array, shape (m, n, QUARTERS)
        After the first run, motions that have not settled run `task.effort.settling.watched`
        cycles. Largest displacement in each quarter of these cycles; 0 for settled motions.
    blocks : array of arrays, shape (m,)
        For each cell an array of block peaks (see BLOCK), shape (n, blocks); NaN if not run.
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
        """Return the regimes of cell k (see APART), each as an array of indices of motions."""
        places = np.flatnonzero(~self.settled[k])
        order = places[np.argsort(self.peaks[k, places], kind="stable")]
        sizes = self.peaks[k, order]
        found = np.split(order, 1 + np.flatnonzero(sizes[1:] > APART * sizes[:-1]))
        return [regime for regime in found if len(regime)]

    def measured(self, k, regime, rough=False) -> tuple:
        """Return a displacement for the motions of cell k in `regime` (indices), and two booleans.

        The displacement is an estimate for HORIZON cycles, or with `rough` the less accurate
        estimate that the search for a gap uses. The first boolean is True if the motions need not
        be run further. The second is True if the estimate has passed a test: the regime is steady
        (see STEADY), or no block peak of the second half of the run exceeds the displacement that
        is extrapolated from the first half. After an escape both booleans are True. Otherwise both
        are False until the motions of the regime, taken together, have run POOLED cycles.
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
        """Return two arrays over the motions of cell k: displacement, and True if it is final.

        A displacement is final if its motion need not be run further. For `rough` see `measured`.
        """
        sizes, known = (1 + SLACK) * self.peaks[k], self.settled[k].copy()
        for regime in self.regimes(k):
            sizes[regime], known[regime], _ = self.measured(k, regime, rough)
        return sizes, known

    def bounds(self, rank) -> tuple:
        """Return three arrays with an entry for each cell.

        The first holds the `rank`-th largest displacement of all motions in the cell, the second
        the index of the motion with this displacement. The third is 1 if the displacement is final,
        or 0 if the motion must be run further.
        """
        found = np.empty(len(self.peaks)), *np.empty((2, len(self.peaks)), int)
        for k in range(len(self.peaks)):
            sizes, known = self.numbers(k)
            place = np.argsort(-sizes, kind="stable")[rank - 1]
            found[0][k], found[1][k], found[2][k] = sizes[place], place, known[place]
        return found

    def grows(self, k) -> bool:
        """Return whether motions of cell k reach new peaks even after MOST_POOLED cycles in all."""
        results = [self.measured(k, regime) for regime in self.regimes(k)]
        return any(known and not tested for _, known, tested in results)

    def largest(self, rank, least=0.0, left_out=()) -> np.ndarray:
        """Run motions until the largest bound is final. Return the bounds of all cells.

        The bound of a cell is the `rank`-th largest displacement of its motions. As long as the
        motion with this displacement must be run further, the bound is an estimate. Such a motion
        is run if the estimate exceeds `least` and all final bounds. `left_out`: cells not to run.
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
        """Double the number of blocks that the motions of cell k in `regime` (indices) have run.

        If these motions have not run a block (see BLOCK), they run at least POOLED/2 cycles in all.
        Displacements before the first block are dropped: they may belong to transients.
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
    """Return `Motions` from random starts, `count` in each cell (`stream`: see `draw_starts`)."""
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

    Motion i begins at a strobe (a fixed phase of the forcing) with states[i], and has the packed
    parameters in parameters[i]. It runs for `number` blocks of `cycles` forcing cycles. The states
    at the end are written into `states`. After an escape, displacements are infinite.
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
    """Return the displacement exceeded once in HORIZON cycles, but at least the largest of `peaks`.

    `peaks` are largest displacements in blocks of BLOCK cycles. The amounts by which peaks exceed a
    high level are assumed to be distributed exponentially (S. Coles, An Introduction to Statistical
    Modeling of Extreme Values, 2001, chapter 4). A motion is bounded, and has fewer large peaks
    than this distribution. The result is therefore too large rather than too small.
    """
    peaks = np.sort(peaks[np.isfinite(peaks)])
    tops = peaks[-TAIL - 1 :]
    expected = HORIZON / BLOCK * (len(tops) - 1) / len(peaks)
    excess = np.mean(tops[1:] - tops[0]) if len(tops) > 1 else 0.0
    return float(max(tops[-1], tops[0] + excess * np.log(max(expected, 1.0))))
