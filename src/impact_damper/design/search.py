"""The search for the gap with the smallest displacement.

The first search runs gaps over the whole range, with nominal values of all other parameters. Later
rounds run gaps near the best ones, with more starts and frequencies, and with other parameters at
the ends of their tolerances. The results form a curve of the largest displacement over the gap.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.sweeps import runs_of_true
from impact_damper.design.cells import STREAMS, Cell, run
from impact_damper.design.promise import MORE, other_sets
from impact_damper.design.task import NOMINAL, Task

# The first search runs up to GAPS gaps at the frequencies `Task.few(FREQUENCIES)`, with STARTS
# random starts at each gap and frequency.
GAPS, FREQUENCIES, STARTS = 80, 5, 10
# Up to ROUNDS rounds follow the first search. A round has CLOSE_STARTS random starts in each cell,
# and runs the frequencies `Task.few(CLOSE_FREQUENCIES)` and those in `Curve.critical`.
CLOSE_FREQUENCIES, CLOSE_STARTS, ROUNDS = 11, 24, 5
# A gap has one cell for each frequency and set of factors. The cell with the largest displacement
# is run again, with more starts, if this displacement exceeds DOUBTED x the largest usual
# displacement of the gap's cells. About 10 % of a cell's motions exceed its usual displacement.
DOUBTED = 1.1
# There is a jump between two neighbouring gaps if the ratio of their displacements exceeds JUMP.
# The interval between neighbouring gaps a < b is split if log(b/a) > SMOOTH. If there is a jump
# between a and b, the interval is split if log(b/a) > FINE.
JUMP, SMOOTH, FINE = 1.3, 0.03, 0.004
# The tolerated displacement of a nominal gap is the largest displacement at all gaps within its
# tolerance. S is the smallest tolerated displacement of all nominal gaps.
# CANDIDATE: a gap is a candidate if its tolerated displacement is at most CANDIDATE x S.
# LEVEL: neighbouring candidates form a group. Around the best gap of each group there is a range.
#   It ends where the tolerated displacement exceeds LEVEL x that of the best gap.
# ALIKE: a range is good if the tolerated displacement of its best gap is at most ALIKE x S.
CANDIDATE, ALIKE, LEVEL = 1.15, 1.04, 1.05
NOMINAL_GAPS = 4001  # number of nominal gaps whose tolerated displacements are computed
# The gap near the middle of a range is rounded to DIGITS significant digits. If the rounded gap
# lies outside the range, the gap is rounded to more digits, but fewer than MOST_DIGITS.
DIGITS, MOST_DIGITS = 3, 9
HUGE = 1e9  # displacement (mm) that stands for an infinite displacement


class Range(NamedTuple):
    """Nominal gaps from `low` to `high`, and one `gap` near the middle, mm.

    `size` (mm) is the smallest tolerated displacement of these gaps (see CANDIDATE).
    """

    low: float
    high: float
    gap: float
    size: float


class Curve:
    """Gaps (mm), and at each the largest displacement (mm) and its frequency (Hz)."""

    def __init__(self, task: Task):
        self.task = task
        self.gaps, self.sizes, self.worst = np.empty((3, 0))
        self.close = np.empty(0, bool)  # False at gaps that only the first runs have computed
        self.sets = [NOMINAL]  # sets of factors with the largest displacements near the best gaps

    def put(self, gaps, sizes, worst, *, close=True, replace=False) -> None:
        """Add to the curve gaps[i] (mm), its displacement sizes[i] (mm), and worst[i] (Hz).

        The displacement occurs at the frequency worst[i]. If the curve already has a displacement
        at a gap, the larger of both is kept, or with `replace` the new one. `close` is False in the
        first search, which has few starts, and True otherwise.
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
        """Return the largest displacement (mm) between the gaps lows[i] and highs[i], for each i.

        At these two gaps the displacement is interpolated between neighbouring points of the curve.
        If there is a jump between the points (see JUMP), the larger of their displacements counts.
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
        """Return nominal gaps all over the curve, and their tolerated displacements, in mm."""
        share, width = self.task.gap_tolerance
        first, last = (self.gaps[0] + width) / (1 - share), (self.gaps[-1] - width) / (1 + share)
        gaps = np.geomspace(first, max(last, first), NOMINAL_GAPS)
        return gaps, self.within(*self.task.gap_ends(gaps))

    def ranges(self) -> list:
        """Return all ranges of nominal gaps with small displacements (see CANDIDATE)."""
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
        """Return the good range (see ALIKE) with the greatest ratio of `high` to `low`."""
        ranges = self.ranges()
        best = min(each.size for each in ranges)
        good = [each for each in ranges if each.size <= ALIKE * best]
        return max(good, key=lambda each: each.high / each.low)

    def lost(self, gap, size) -> np.ndarray:
        """Return the nearest lost gap on each side of `gap`, and the displacement there, in mm.

        A gap is lost if it lies outside the tolerance of `gap` and its displacement exceeds `size`.
        Rows: gap, displacement. Columns: smaller gap, larger gap. NaN stands for no lost gap.
        """
        found = np.full((2, 2), np.nan)
        for side, end, step in zip((0, 1), self.task.gap_ends(gap), (-1, 1), strict=True):
            outside = (self.sizes > size) & (step * (self.gaps / end - 1) > 1e-9)
            for k in np.flatnonzero(outside)[::step][:1]:
                found[:, side] = self.gaps[k], self.sizes[k]
        return found

    def worst_inside(self, gap) -> np.ndarray:
        """Return sets of factors, one in a row, for the worst gap within the tolerance of `gap`.

        The worst gap g is the one with the largest displacement on the curve. The sets are
        `self.sets`, with g/`gap` as the factor of the gap. If the displacement at `gap` or at an
        end of its tolerance is as large as at g, the result has no rows.
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
        """Return the worst frequency (Hz) of each gap with a small displacement (see CANDIDATE)."""
        return np.unique(self.worst[self.sizes <= CANDIDATE * self.nominal()[1].min()])

    def unclear(self) -> np.ndarray:
        """Return the gaps (mm) that the next round should run, the most important first."""
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
    """Return a gap near the middle between `first` and `last`, with few digits (see DIGITS)."""
    middle = float(np.sqrt(first * last))
    for digits in range(DIGITS, MOST_DIGITS):
        gap = float(f"{middle:.{digits}g}")
        if first <= gap <= last:
            return gap
    return middle


def score(task, gaps, frequencies, starts, stream, progress=None, sets=(NOMINAL,)) -> tuple:
    """Return three sequences, with an entry for the worst cell at each of `gaps` (mm).

    The first holds displacements (mm), the second frequencies (Hz), the third sets of factors. A
    cell is a gap, one of `frequencies` and one of `sets`. It has `starts` random starts (`stream`:
    see `draw_starts`). About the fraction (1 - task.share)/2 of the motions of a cell exceed its
    displacement. The worst cell has the largest displacement. If only rare motions reach this
    displacement, the worst cell is run again (see DOUBTED).
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
    count = len(motions.peaks)
    sizes = np.array([np.sort(motions.numbers(k, rough=True)[0]) for k in range(count)])
    return task.millimetres(np.stack([sizes[:, -1 - rank] for rank in ranks]))


def search(task, progress=None, rounds=ROUNDS) -> Curve:
    """Return the `Curve` of displacements over all gaps, with more points near good gaps."""
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
    """Return the `Curve` from gap/2 to 2 gap (mm), with the largest displacement over `sets`."""
    curve, few = Curve(task), task.few(FREQUENCIES)
    gaps = gap * np.geomspace(0.5, 2, 2 * task.effort.candidates + 1)
    curve.put(gaps, *score(task, gaps, few, STARTS, ("search",), progress, sets)[:2])
    return curve
