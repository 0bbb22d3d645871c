"""Promised displacement: a bound over band and tolerances (see docs/explanation/promise.md)."""

import itertools

import numpy as np
from scipy.special import bdtr

from impact_damper.data.shares import DOUBT, bounding_rank
from impact_damper.design.cells import STREAMS, Cell, run
from impact_damper.design.task import VARIED

CORNERS = 8  # largest number of corners. In a corner each value is at one end of its tolerance.
# A set of factors has a bound of the displacement at each frequency. The largest of these bounds is
# the peak of the set. Up to SPLITS rounds add frequencies on both sides of each peak that is at
# least NEAR x the largest peak of all sets. No frequencies are added beside an accurate peak.
# A finite peak is accurate if two conditions hold: (1) The latest round has raised the peak by at
# most the fraction PEAK. (2) The maximum of a parabola exceeds the peak by at most the fraction
# PEAK. The parabola passes through the peak and the bounds at both neighbouring frequencies.
NEAR, PEAK, SPLITS = 0.9, 0.01, 4
FEWEST = 9  # least number of frequencies at which a set other than the nominal one is run first
# A cell has rare motions if its bound exceeds RARE x the largest usual displacement of all cells.
# Such cells are run again with MORE x as many starts, in groups of SOME cells. Groups with larger
# bounds come first. Let b be the least old bound in a group. If a new bound in this group exceeds
# KEPT x b, the groups after it are not run again, because their old bounds are at most b.
RARE, MORE, SOME, KEPT = 1.2, 6, 8, 0.95


class Promise:
    """Motions at one gap (m) for several sets of factors, and bounds of their displacement.

    Attributes
    ----------
    sets : array, shape (s, len(VARIED))
        Each row is a set of factors, by which the nominal values in VARIED are multiplied.
    cells : list of tuple
        For each cell the index of its row in `sets`, and its frequency (Hz).
    bounds : array, shape (cells,)
        For each cell the displacement (mm) below which at least the fraction `task.share` of all
        its motions stays, with 95 % confidence.
    peak_known : bool
        Whether the largest bounds over the frequency are accurate (see PEAK).
    grows : bool
        Whether motions in the cell with the largest bound still reach new peaks after a long run.
    """

    def __init__(self, task, gap, sets, stream, count=None, frequencies=None, progress=None):
        self.task, self.gap, self.sets = task, gap, np.asarray(sets)
        self.stream, self.count = stream, count or task.effort.starts
        self.progress, self.grows = progress, False
        self.rank = bounding_rank(task.share, self.count)
        self.cells, self.motions, self.peak_known = [], None, True
        self.again = {}  # index of a cell that was run again -> dimensionless bound
        few = task.few(max(FEWEST, (len(task.grid) + 1) // 2))
        full, half = (task.grid, few) if frequencies is None else (frequencies, frequencies)
        deviating = [(k, f) for k in range(1, len(self.sets)) for f in half]
        self.add([(0, f) for f in full] + deviating)

    def add(self, cells) -> None:
        """Run motions in further `cells`, and compute the bounds of all cells again."""
        stream = (*self.stream, len(self.cells))
        motions = run(self.task, self._made(cells), self.count, stream, self.progress)
        self.motions = motions if self.motions is None else self.motions.join(motions)
        self.cells += cells
        self._repeat_rare()
        bounds = self.motions.largest(self.rank, max(self.again.values(), default=0.0), self.again)
        for place, bound in self.again.items():
            bounds[place] = bound
        self.bounds = self.task.millimetres(bounds)
        worst = int(np.argmax(bounds))
        self.grows |= worst not in self.again and self.motions.grows(worst)

    def _made(self, cells):
        return [Cell(self.gap, f, tuple(self.sets[k])) for k, f in cells]

    def _repeat_rare(self) -> None:
        allowed = int(2 * (1 - self.task.share) * self.count) + 1
        usual, bounds = (self.motions.bounds(rank)[0] for rank in (allowed, self.rank))
        for place, bound in self.again.items():
            usual[place] = bounds[place] = bound
        rare = np.flatnonzero(bounds > RARE * np.maximum(usual, usual.max()))
        rare = [place for place in rare[np.argsort(-bounds[rare])] if place not in self.again]
        total = MORE * self.count
        # A cell that is run again has two bounds. The probability that one of them is wrong is at
        # most DOUBT: `used` for the first bound, the rest for the second.
        used = bdtr(self.rank - 1, self.count, 1 - self.task.share)
        rank = bounding_rank(self.task.share, total, DOUBT - used)
        while rare and rank:
            some, rare = rare[:SOME], rare[SOME:]
            made = self._made([self.cells[place] for place in some])
            stream = "repeated", STREAMS.index(self.stream[0]), *self.stream[1:], len(self.again)
            motions = run(self.task, made, total, stream, self.progress)
            found = motions.largest(rank, usual.max())
            self.again |= dict(zip(some, found, strict=True))
            self.grows |= motions.grows(int(np.argmax(found)))
            if found.max() > KEPT * bounds[some].min():
                return

    def refined(self) -> "Promise":
        """Add frequencies until the largest bounds are accurate (see PEAK), and return `self`."""
        before = {}
        for _ in range(SPLITS):
            cells = []
            for k in np.flatnonzero(self.by_set() >= NEAR * self.by_set().max()):
                frequencies, bounds = self.over_frequency(k)
                if not is_peak_known(frequencies, bounds, before.get(k, 0.0)):
                    cells += [(k, f) for f in beside_peak(frequencies, bounds)]
                before[k] = bounds.max()
            if not cells:
                return self
            self.add(cells)
        self.peak_known = False
        return self

    def by_set(self) -> np.ndarray:
        """Return the largest bound (mm) over all frequencies, for each row of `sets`."""
        owners = np.array([k for k, _ in self.cells])
        return np.array([self.bounds[owners == k].max() for k in range(len(self.sets))])

    def over_frequency(self, k) -> tuple:
        """Return the frequencies (Hz) at which row k of `sets` was run, and the bounds (mm)."""
        places = [place for place, cell in enumerate(self.cells) if cell[0] == k]
        frequencies = np.array([self.cells[place][1] for place in places])
        order = np.argsort(frequencies)
        return frequencies[order], self.bounds[places][order]

    @property
    def size(self) -> float:
        """Promised displacement, mm."""
        return float(self.bounds.max())

    @property
    def worst(self) -> tuple:
        """Cell with the largest bound, as a tuple: row in `sets`, frequency (Hz)."""
        return self.cells[int(np.argmax(self.bounds))]


def is_peak_known(frequencies, bounds, before) -> bool:
    """Return whether the largest of `bounds` over `frequencies` is accurate (see PEAK).

    `before` is the largest bound of the preceding round, or 0 in the first round.
    """
    k = int(np.argmax(bounds))
    if np.isinf(bounds[k]):
        return True
    if bounds[k] > (1 + PEAK) * before:
        return False
    if not 0 < k < len(bounds) - 1:
        return True
    x, y = frequencies[k - 1 : k + 2] - frequencies[k], bounds[k - 1 : k + 2]
    bend, slope, _ = np.polyfit(x, y, 2)
    return bend >= 0 or slope**2 / (-4 * bend) <= PEAK * bounds[k]


def beside_peak(frequencies, bounds) -> list:
    """Return the middle between the frequency of the largest bound and each of its neighbours."""
    k = int(np.argmax(bounds))
    ends = frequencies[max(k - 1, 0) : k + 2]
    return [float(middle) for middle in (ends[1:] + ends[:-1]) / 2]


def factor_sets(task, gap) -> np.ndarray:
    """Return the sets of factors to be run at a gap (mm), one in each row.

    In the first set all factors are 1. In the next two sets only the gap is at an end of its
    tolerance. The remaining sets are corners (see CORNERS). Repeated sets are left out.
    """
    widths = task.deviations(gap)
    signs = [(-1, 1) if width else (0,) for width in widths]
    corners = np.array(list(itertools.product(*signs)), float)
    if len(corners) > CORNERS:
        generator = np.random.default_rng(task.effort.seed)
        corners = corners[np.sort(generator.permutation(len(corners))[:CORNERS])]
    ends = np.zeros((2, len(VARIED)))
    ends[:, 0] = -1, 1
    rows = 1 + np.vstack([np.zeros((1, len(VARIED))), ends, corners]) * widths
    place = VARIED.index("restitution")
    rows[:, place] = np.minimum(rows[:, place], 1 / task.restitution)
    return rows[np.sort(np.unique(rows, axis=0, return_index=True)[1])]


def other_sets(task, gap) -> np.ndarray:
    """Return the rows of `factor_sets`, with the factor of the gap set to 1 and no row twice."""
    rows = factor_sets(task, gap)
    rows[:, 0] = 1
    return np.unique(rows, axis=0)
