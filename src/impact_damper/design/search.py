"""The search for the gap: a curve of displacements over the gap, refined where it is small.

The first curve follows from few starts at few frequencies. Later runs near the best gaps also vary
other values. The value of a nominal gap is the largest displacement within the gap's tolerance.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.sweeps import runs_of_true
from impact_damper.design.cells import STREAMS, Cell, run
from impact_damper.design.promise import MORE, other_sets
from impact_damper.design.task import NOMINAL, Task

# The first search runs STARTS starts at each of at most GAPS gaps and `Task.few(FREQUENCIES)`.
GAPS, FREQUENCIES, STARTS = 80, 5, 10
# Near the best gaps at most ROUNDS rounds follow, each with CLOSE_STARTS starts at
# `Task.few(CLOSE_FREQUENCIES)` and at the worst frequencies so far.
CLOSE_FREQUENCIES, CLOSE_STARTS, ROUNDS = 11, 24, 5
# A cell is run again if its displacement exceeds DOUBTED times the largest usual displacement.
DOUBTED = 1.1
# Two neighbouring displacements whose ratio exceeds JUMP form a jump. An interval between two gaps
# is split if the logarithm of their ratio exceeds SMOOTH or, at a jump, FINE.
JUMP, SMOOTH, FINE = 1.3, 0.03, 0.004
# Nominal gaps whose value is at most CANDIDATE times the least value form ranges. Each range is cut
# where the value exceeds LEVEL times the least value of the range. Ranges whose least value is at
# most ALIKE times the least value of all gaps are equally good. The widest of these is chosen.
CANDIDATE, ALIKE, LEVEL = 1.15, 1.04, 1.05
NOMINAL_GAPS = 4001
# A gap keeps at least DIGITS and fewer than MOST_DIGITS significant digits, or is not rounded.
DIGITS, MOST_DIGITS = 3, 9
# Displacement in place of infinity, mm.
HUGE = 1e9


class Range(NamedTuple):
    """Range of nominal gaps with similar values, mm: ends, a gap near the middle, least value."""

    low: float
    high: float
    gap: float
    size: float


class Curve:
    """Displacements (mm) at ascending gaps (mm), and the frequencies (Hz) at which they occur."""

    def __init__(self, task: Task):
        self.task = task
        self.gaps, self.sizes, self.worst = np.empty((3, 0))
        self.close = np.empty(0, bool)
        self.sets = [NOMINAL]  # sets of factors with the largest displacements near the best gaps

    def put(self, gaps, sizes, worst, *, close=True, replace=False) -> None:
        """Add displacements. At a known gap keep the larger one or, with `replace`, the new one."""
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
        """Return the largest displacement between each gap in `lows` and its partner in `highs`.

        At the two gaps the curve is interpolated. Inside a jump the larger of both sides counts.
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
        """Return two arrays: many nominal gaps, and their values (see the top of this module)."""
        share, width = self.task.gap_tolerance
        first, last = (self.gaps[0] + width) / (1 - share), (self.gaps[-1] - width) / (1 + share)
        gaps = np.geomspace(first, max(last, first), NOMINAL_GAPS)
        return gaps, self.within(*self.task.gap_ends(gaps))

    def ranges(self) -> list:
        """Return the candidates: ranges of nominal gaps whose values are near the least value."""
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
        """Return the widest of the ranges whose least value is close to the least of all."""
        ranges = self.ranges()
        best = min(each.size for each in ranges)
        good = [each for each in ranges if each.size <= ALIKE * best]
        return max(good, key=lambda each: each.high / each.low)

    def keeping(self, gap, size) -> tuple:
        """Return two lists: the ends of a range of gaps, and the displacements just beyond them.

        The range is the tolerance of `gap` and all adjoining gaps with displacements up to `size`.
        The displacement beyond an end is NaN if the curve ends there.
        """
        ends, beyond = [], []
        for end, step in zip(self.task.gap_ends(gap), (-1, 1), strict=True):
            outside = (self.sizes > size) & (step * (self.gaps / end - 1) > 1e-9)
            loud = np.flatnonzero(outside)[:: int(step)]
            last = loud[0] - step if len(loud) else (len(self.gaps) - 1 if step > 0 else 0)
            ends.append(float(step * max(step * self.gaps[last], step * end)))
            beyond.append(self.sizes[loud[0]] if len(loud) else np.nan)
        return ends, beyond

    def worst_inside(self, gap) -> np.ndarray:
        """Return `sets` at the worst gap within the tolerance of `gap`.

        No set is returned if `gap` or an end of its tolerance is at least as bad.
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
        """Return the worst frequencies (Hz) of all gaps with displacements near the least value."""
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
        # Beside a gap with a small motion there may be a narrow range of better gaps.
        small = self.sizes <= CANDIDATE * values.min()
        matters |= small[:-1] | small[1:]
        middles = np.sqrt(self.gaps[:-1] * self.gaps[1:])
        split = matters & (widths > np.where(jumps, FINE, SMOOTH))
        again = np.array([np.any((low <= g) & (high >= g)) for g in self.gaps]) & ~self.close
        order = np.argsort(-widths[split] * np.where(jumps[split], 4, 1), kind="stable")
        return np.concatenate([self.gaps[again], middles[split][order]])


def middle_gap(first, last) -> float:
    """Return a gap near the middle of a range, with as few digits as possible, at least DIGITS."""
    middle = float(np.sqrt(first * last))
    for digits in range(DIGITS, MOST_DIGITS):
        gap = float(f"{middle:.{digits}g}")
        if first <= gap <= last:
            return gap
    return middle


def score(task, gaps, frequencies, starts, stream, progress=None, sets=(NOMINAL,)) -> tuple:
    """Return three sequences over gaps (mm): displacement (mm), its frequency, its set of factors.

    The displacement is the largest over frequencies and sets. In each cell the largest motions are
    left out, about the fraction (1 - share)/2. Few starts hardly distinguish rare motions from
    others. If rare motions decide on a gap, their cell is run again with more starts.
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
    """Return how many motions exceed a cell's displacement, and how many its usual displacement."""
    allowed = starts * (1 - task.share)
    return round(allowed / 2), int(2 * allowed)


def _exceeded_by(task, motions, ranks):
    """Return displacements (mm) that `ranks` motions of each cell exceed, shape (ranks, cells)."""
    count = len(motions.peaks)
    sizes = np.array([np.sort(motions.numbers(k, rough=True)[0]) for k in range(count)])
    return task.millimetres(np.stack([sizes[:, -1 - rank] for rank in ranks]))


def search(task, progress=None, rounds=ROUNDS) -> Curve:
    """Return the curve over all gaps, refined where displacements are small, most at jumps."""
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
    """Return a curve from half to twice a given gap (mm): largest displacements over `sets`."""
    curve, few = Curve(task), task.few(FREQUENCIES)
    gaps = gap * np.geomspace(0.5, 2, 2 * task.effort.candidates + 1)
    curve.put(gaps, *score(task, gaps, few, STARTS, ("search",), progress, sets)[:2])
    return curve
