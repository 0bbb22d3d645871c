"""The search for the gap: a curve of displacements over the gap, finer at small displacements.

Later runs, near the best gaps, use more starts and frequencies, and other values than the gap
deviate too. The value of a nominal gap is the largest displacement at all gaps in its tolerance.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.sweeps import runs_of_true
from impact_damper.design.cells import STREAMS, Cell, run
from impact_damper.design.promise import MORE, other_sets
from impact_damper.design.task import NOMINAL, Task

# The first search computes up to GAPS gaps at the frequencies `Task.few(FREQUENCIES)`, with STARTS
# random starts at each gap and frequency.
GAPS, FREQUENCIES, STARTS = 80, 5, 10
# Up to ROUNDS later rounds compute gaps near the best gaps, with CLOSE_STARTS starts in each cell.
# Their frequencies are `Task.few(CLOSE_FREQUENCIES)` and the worst frequencies of earlier rounds.
CLOSE_FREQUENCIES, CLOSE_STARTS, ROUNDS = 11, 24, 5
# The worst displacement at a gap is computed again, with more starts, if it exceeds DOUBTED x the
# largest usual displacement at this gap.
DOUBTED = 1.1
# Two neighbouring gaps have a jump between them if the ratio of their displacements exceeds JUMP.
# The interval between two gaps a < b is split if log(b/a) > SMOOTH, or > FINE if there is a jump.
JUMP, SMOOTH, FINE = 1.3, 0.03, 0.004
# The value of a nominal gap is the largest displacement within its tolerance. V is the least value.
# A stretch of gaps with values up to CANDIDATE x V has a least value v of its own. Its gaps around
# v with values up to LEVEL x v form a range. A range is good if v is at most ALIKE x V.
CANDIDATE, ALIKE, LEVEL = 1.15, 1.04, 1.05
NOMINAL_GAPS = 4001  # number of nominal gaps whose values are computed
# A chosen gap is rounded to DIGITS significant digits. If this leads out of its range of good gaps,
# it is rounded to more digits, but fewer than MOST_DIGITS.
DIGITS, MOST_DIGITS = 3, 9
# Displacement (mm) that stands for an infinite displacement.
HUGE = 1e9


class Range(NamedTuple):
    """A range of nominal gaps (mm), one `gap` in it, and `size`, its least displacement (mm)."""

    low: float
    high: float
    gap: float
    size: float


class Curve:
    """Largest displacement (mm) at each of several gaps (mm), and its frequency (Hz)."""

    def __init__(self, task: Task):
        self.task = task
        self.gaps, self.sizes, self.worst = np.empty((3, 0))
        self.close = np.empty(0, bool)  # False at gaps that only the first runs have computed
        self.sets = [NOMINAL]  # sets of factors with the largest displacements near the best gaps

    def put(self, gaps, sizes, worst, *, close=True, replace=False) -> None:
        """Add displacements `sizes` (mm) at `gaps` (mm), with their `worst` frequencies (Hz).

        If the curve has a displacement at a gap already, the larger one is kept. With `replace` the
        new one is kept. `close` is False in the first search.
        """
        for gap, size, frequency in zip(gaps, np.minimum(sizes, HUGE), worst, strict=True):
            k = int(np.searchsorted(self.gaps, gap * (1 - 1e-9)))
            if k < len(self.gaps) and self.gaps[k] <= gap * (1 + 1e-9):
                if replace or size > self.sizes[k]:
                    self.sizes[k], self.worst[k] = size, frequency
                self.close[k] |= close
            else:
                self.gaps = np.insert(self.gaps, k, gap)
                self.sizes = np.insert(self.sizes, k, size)
                self.worst = np.insert(self.worst, k, frequency)
                self.close = np.insert(self.close, k, close)

    def within(self, lows, highs) -> np.ndarray:
        """Return the largest displacement on the curve in each interval lows[i] to highs[i].

        At the ends of an interval the curve is interpolated. At a jump the larger value counts.
        """
        logs, values = np.log(self.gaps), np.log(self.sizes)
        found = np.full(len(lows), -np.inf)
        for ends in (lows, highs):
            k = np.clip(np.searchsorted(self.gaps, ends) - 1, 0, len(logs) - 2)
            low, high = values[k], values[k + 1]
            share = np.clip((np.log(ends) - logs[k]) / (logs[k + 1] - logs[k]), 0, 1)
            jump = (np.abs(high - low) > np.log(JUMP)) & (share > 0) & (share < 1)
            value = np.where(jump, np.maximum(low, high), low + share * (high - low))
            found = np.maximum(found, value)
        inside = (self.gaps >= np.reshape(lows, (-1, 1))) & (
            self.gaps <= np.reshape(highs, (-1, 1))
        )
        return np.exp(np.maximum(found, np.where(inside, values, -np.inf).max(axis=1)))

    def nominal(self) -> tuple:
        """Return many nominal gaps (mm), and the largest displacement in the tolerance of each."""
        share, width = self.task.gap_tolerance
        first, last = (self.gaps[0] + width) / (1 - share), (self.gaps[-1] - width) / (1 + share)
        gaps = np.geomspace(first, max(last, first), NOMINAL_GAPS)
        return gaps, self.within(*self.task.gap_ends(gaps))

    def ranges(self) -> list:
        """Return ranges of nominal gaps with small displacements (see CANDIDATE)."""
        gaps, values = self.nominal()
        found = []
        for first, after in runs_of_true(values <= CANDIDATE * values.min()):
            least = first + int(np.argmin(values[first:after]))
            level = runs_of_true(values[first:after] <= LEVEL * values[least])
            begin, end = next(each for each in level if each[0] <= least - first < each[1])
            low, high = gaps[first + begin], gaps[first + end - 1]
            found.append(Range(low, high, middle_gap(low, high), float(values[least])))
        return found

    def choose(self) -> Range:
        """Return the widest range of gaps with displacements near the smallest (see ALIKE)."""
        ranges = self.ranges()
        best = min(each.size for each in ranges)
        good = [each for each in ranges if each.size <= ALIKE * best]
        return max(good, key=lambda each: each.high / each.low)

    def lost(self, gap, size) -> np.ndarray:
        """Return the nearest lost gaps below and above `gap`, and the displacements at both.

        A gap is lost if it lies outside the tolerance of `gap` and has a displacement above `size`.
        If no gap on one side is lost, both values of this side are NaN.
        """
        found = np.full((2, 2), np.nan)
        for side, end, step in zip((0, 1), self.task.gap_ends(gap), (-1, 1), strict=True):
            outside = (self.sizes > size) & (step * (self.gaps / end - 1) > 1e-9)
            for k in np.flatnonzero(outside)[::step][:1]:
                found[:, side] = self.gaps[k], self.sizes[k]
        return found

    def worst_inside(self, gap) -> np.ndarray:
        """Return `self.sets`, sets of factors, with (worst gap)/`gap` as the factor of the gap.

        The worst gap has the largest displacement within the tolerance of `gap`. The result has no
        rows if the displacement at `gap`, or at an end of its tolerance, is at least as large.
        """
        low, high = self.task.gap_ends(gap)
        inside = np.flatnonzero((self.gaps > low) & (self.gaps < high))
        known = np.array([low, gap, high])
        if not len(inside) or self.sizes[inside].max() <= self.within(known, known).max():
            return np.empty((0, len(NOMINAL)))
        rows = np.array(self.sets, float)
        rows[:, 0] = self.gaps[inside[np.argmax(self.sizes[inside])]] / gap
        return rows

    def critical(self) -> np.ndarray:
        """Return the worst frequencies (Hz) of all gaps with displacements near the smallest."""
        return np.unique(self.worst[self.sizes <= CANDIDATE * self.nominal()[1].min()])

    def unclear(self) -> np.ndarray:
        """Return the gaps at which the curve must be computed next, the most important first."""
        gaps, values = self.nominal()
        good = values <= CANDIDATE * values.min()
        low, high = self.task.gap_ends(gaps[good])
        widths = np.diff(np.log(self.gaps))
        jumps = np.abs(np.diff(np.log(self.sizes))) > np.log(JUMP)
        matters = np.array(
            [
                np.any((low <= after) & (high >= begin))
                for begin, after in zip(self.gaps[:-1], self.gaps[1:], strict=True)
            ]
        )
        # A narrow range of better gaps may lie beside a gap with a small displacement.
        small = self.sizes <= CANDIDATE * values.min()
        matters |= small[:-1] | small[1:]
        middles = np.sqrt(self.gaps[:-1] * self.gaps[1:])
        split = matters & (widths > np.where(jumps, FINE, SMOOTH))
        again = np.array([np.any((low <= g) & (high >= g)) for g in self.gaps]) & ~self.close
        order = np.argsort(-widths[split] * np.where(jumps[split], 4, 1), kind="stable")
        return np.concatenate([self.gaps[again], middles[split][order]])


def middle_gap(first, last) -> float:
    """Return a gap near the middle of a range, with as few digits as possible (see DIGITS)."""
    middle = float(np.sqrt(first * last))
    for digits in range(DIGITS, MOST_DIGITS):
        gap = float(f"{middle:.{digits}g}")
        if first <= gap <= last:
            return gap
    return middle


def score(task, gaps, frequencies, starts, stream, progress=None, sets=(NOMINAL,)) -> tuple:
    """Return three sequences over gaps (mm): displacement (mm), frequency (Hz), set of factors.

    A cell is a gap with one of `frequencies` and one of `sets`. The results of a gap are those of
    its worst cell. About (1 - share)/2 of the motions of a cell exceed its displacement. A doubtful
    cell is run again with more starts (see DOUBTED).
    """
    conditions = [(f, tuple(each)) for f in frequencies for each in sets]
    cells = [Cell(1e-3 * gap, *each) for gap in gaps for each in conditions]
    found = run(task, cells, starts, stream, progress)
    table, usual = _exceeded_by(task, found, _ranks(task, starts)).reshape(2, len(gaps), -1)
    usual, known, turn = usual.max(axis=1), np.zeros(table.shape, bool), 0
    while True:
        worst = table.argmax(axis=1)
        rows = np.arange(len(gaps))
        rows = rows[(table.max(axis=1) > DOUBTED * usual) & ~known[rows, worst]]
        if not len(rows):
            return table.max(axis=1), *zip(*(conditions[k] for k in worst), strict=True)
        some, turn = [cells[k * len(conditions) + worst[k]] for k in rows], turn + 1
        again = "searched_again", STREAMS.index(stream[0]), *stream[1:], turn
        more = run(task, some, MORE * starts, again, progress)
        table[rows, worst[rows]] = _exceeded_by(task, more, _ranks(task, MORE * starts))[0]
        known[rows, worst[rows]] = True


def _ranks(task, starts):
    allowed = starts * (1 - task.share)
    return round(allowed / 2), int(2 * allowed)  # for the displacement, the usual displacement


def _exceeded_by(task, motions, ranks):
    """Return, for each rank and each cell, the displacement (mm) that `rank` motions exceed."""
    count = len(motions.peaks)
    sizes = np.array([np.sort(motions.numbers(k, rough=True)[0]) for k in range(count)])
    return task.millimetres(np.stack([sizes[:, -1 - rank] for rank in ranks]))


def search(task, progress=None, rounds=ROUNDS) -> Curve:
    """Return the curve of displacements over all gaps. Its points are denser near good gaps."""
    curve, few = Curve(task), task.few(FREQUENCIES)
    gaps = np.geomspace(*task.gap_span, min(GAPS, 6 * task.effort.candidates + 8))
    first = score(task, gaps, few, STARTS, ("search",), progress)
    curve.put(gaps, *first[:2], close=False)
    for turn in range(rounds):
        gaps = curve.unclear()[: task.effort.candidates]
        if not len(gaps):
            break
        few = task.few(CLOSE_FREQUENCIES, *curve.critical())
        sets = curve.sets if turn else other_sets(task, gaps[0])
        given = few, CLOSE_STARTS, ("compared", turn), progress, sets
        sizes, worst, harmful = score(task, gaps, *given)
        curve.put(gaps, sizes, worst)
        curve.sets = np.unique(harmful, axis=0)
    return curve


def search_around(task, gap, sets, progress=None) -> Curve:
    """Return the curve of displacements from gap/2 to 2 gap (mm), for the worst of `sets`."""
    curve, few = Curve(task), task.few(FREQUENCIES)
    gaps = gap * np.geomspace(0.5, 2, 2 * task.effort.candidates + 1)
    curve.put(gaps, *score(task, gaps, few, STARTS, ("search",), progress, sets)[:2])
    return curve
