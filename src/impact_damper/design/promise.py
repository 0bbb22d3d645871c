"""Promised displacement: a bound over band and tolerances (see docs/explanation/promise.md)."""

import itertools

import numpy as np
from scipy.special import bdtr

from impact_damper.data.shares import DOUBT, bounding_rank
from impact_damper.design.cells import STREAMS, Cell, run
from impact_damper.design.task import VARIED

# Largest number of corners. In a corner each value is at one end of its tolerance.
CORNERS = 8
# The peak of a set of factors is the largest of its bounds at all frequencies.
# Up to SPLITS rounds add frequencies beside peaks that are at least NEAR x the largest peak.
# A finite peak is known if the last round raised it at most by the fraction PEAK, and if a parabola
# through the peak and its two neighbours is higher than the peak by at most this fraction.
NEAR, PEAK, SPLITS = 0.9, 0.01, 4
# A set of factors that is not nominal is first run at half of the frequencies, but at least FEWEST.
FEWEST = 9
# A cell has rare motions if its bound exceeds RARE x the largest usual displacement of all cells.
# Cells with rare motions are run again with MORE x as many starts, in groups of SOME cells. The
# cells with the largest bounds come first. After a group whose least old bound was b, the bounds of
# the cells that remain are below b. If a new bound exceeds KEPT x b, they are not run again.
RARE, MORE, SOME, KEPT = 1.2, 6, 8, 0.95


class Promise:
    """Motions at one gap (m) for several sets of factors, and bounds of their displacement.

    Attributes
    ----------
    sets : array, shape (s, len(VARIED))
        One row for each set: factors by which nominal values are multiplied.
    cells : list of tuple
        Index of the set and frequency (Hz), for each cell in `motions`.
    bounds : array, shape (cells,)
        Displacement (mm) below which at least the fraction `task.share` of all motions stays.
    peak_known : bool
        Whether the largest peak, and peaks of nearly the same height, are known (see PEAK).
    grows : bool
        Whether a displacement in the worst cell still grows after many cycles (`Motions.grows`).
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
        """Run further cells, and compute the bounds of all cells."""
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
        """Run cells with rare motions again, with more starts (see RARE)."""
        allowed = int(2 * (1 - self.task.share) * self.count) + 1
        usual, bounds = (self.motions.bounds(rank)[0] for rank in (allowed, self.rank))
        for place, bound in self.again.items():
            usual[place] = bounds[place] = bound
        rare = np.flatnonzero(bounds > RARE * np.maximum(usual, usual.max()))
        rare = [place for place in rare[np.argsort(-bounds[rare])] if place not in self.again]
        total = MORE * self.count
        # With a probability of at least 1 - DOUBT both the old and the new bound of a cell hold.
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
        """Add frequencies beside peaks until the peaks are known (see PEAK). Return `self`."""
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
        """Return the peak of each set of factors: its largest bound (mm) over all frequencies."""
        owners = np.array([k for k, _ in self.cells])
        return np.array([self.bounds[owners == k].max() for k in range(len(self.sets))])

    def over_frequency(self, k) -> tuple:
        """Return ascending frequencies (Hz), and the bounds (mm) at them for set k of factors."""
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
        """Cell with the largest bound: index of the set of factors, and frequency (Hz)."""
        return self.cells[int(np.argmax(self.bounds))]


def is_peak_known(frequencies, bounds, before) -> bool:
    """Return whether the peak, the largest of `bounds`, is known (see PEAK).

    `before` is the peak before the last frequencies were added, or 0 if none were added.
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
    """Return the middles of the frequency intervals on both sides of the largest bound."""
    k = int(np.argmax(bounds))
    ends = frequencies[max(k - 1, 0) : k + 2]
    return [float(middle) for middle in (ends[1:] + ends[:-1]) / 2]


def factor_sets(task, gap) -> np.ndarray:
    """Return the sets of factors to be run at a gap (mm), one in each row.

    The first set is nominal. In the next sets only the gap deviates, to one end of its tolerance.
    The remaining sets are corners (see CORNERS).
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
    """Return the rows of `factor_sets`, but with 1 as the factor of the gap. Rows do not repeat."""
    rows = factor_sets(task, gap)
    rows[:, 0] = 1
    return np.unique(rows, axis=0)
