"""The promised displacement of a gap: a bound over the band and within all tolerances."""

import itertools

import numpy as np
from scipy.special import bdtr

from impact_damper.data.shares import DOUBT, bounding_rank
from impact_damper.design.cells import STREAMS, Cell, run
from impact_damper.design.task import VARIED

# Largest number of corners, which are sets of factors with each value at an end of its tolerance.
CORNERS = 8
# The peak of a set of factors is its largest bound over the frequency. In at most SPLITS rounds,
# frequencies are added beside the peaks that are at least NEAR times the largest one, until they
# are known. An infinite peak is known. Any other peak is known if the last frequencies raised it by
# at most the fraction PEAK, and if a parabola through it and two neighbours adds at most as much.
NEAR, PEAK, SPLITS = 0.9, 0.01, 4
# Sets that deviate are run first at half of the grid's frequencies, or at FEWEST if that is more.
FEWEST = 9
# The usual displacement of a cell is the one that twice the allowed share of its starts exceeds. A
# cell has rare motions if its bound exceeds RARE times the largest usual displacement. Such cells
# are run again with MORE times as many starts, in groups of SOME, the largest bounds first. Runs
# stop after a group in which a new bound exceeds KEPT times the least old bound of the group.
RARE, MORE, SOME, KEPT = 1.2, 6, 8, 0.95


class Promise:
    """Motions at a gap (m) for sets of factors, over frequencies that are denser at peaks.

    Attributes
    ----------
    sets : array, shape (s, len(VARIED))
    cells : list of tuple
        A cell is a tuple: index of the set, frequency (Hz). The order is that of `motions`.
    bounds : array, shape (cells,)
        Bound (mm) of each cell: at least the fraction `task.share` of all starts stays below it.
    peak_known : bool
        Whether the peak over the frequency is known within PEAK.
    grows : bool
        Whether motions at the largest bound exceeded their extrapolation until their run ended.

    docs/explanation/promise.md shows why the number of cells needs no correction.
    """

    def __init__(self, task, gap, sets, stream, count=None, frequencies=None, progress=None):
        self.task, self.gap, self.sets = task, gap, np.asarray(sets)
        self.stream, self.count = stream, count or task.effort.starts
        self.progress, self.grows = progress, False
        self.rank = bounding_rank(task.share, self.count)
        self.cells, self.motions, self.peak_known = [], None, True
        self.again = {}  # dimensionless bounds of cells that were run again
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
        """Run cells with rare motions again, with more starts.

        The probability that at least one of the two bounds of a cell is wrong is at most DOUBT.
        """
        allowed = int(2 * (1 - self.task.share) * self.count) + 1
        usual, bounds = (self.motions.bounds(rank)[0] for rank in (allowed, self.rank))
        for place, bound in self.again.items():
            usual[place] = bounds[place] = bound
        rare = np.flatnonzero(bounds > RARE * np.maximum(usual, usual.max()))
        rare = [place for place in rare[np.argsort(-bounds[rare])] if place not in self.again]
        total = MORE * self.count
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
        """Add frequencies until the peak is known, at most SPLITS times. Return the object."""
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
        """Return for each set the largest displacement over the frequency, mm."""
        owners = np.array([k for k, _ in self.cells])
        return np.array([self.bounds[owners == k].max() for k in range(len(self.sets))])

    def over_frequency(self, k) -> tuple:
        """Return two arrays for set k: ascending frequencies (Hz), and displacements (mm)."""
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
        """Cell with the largest displacement: index of the set of factors, and frequency (Hz)."""
        return self.cells[int(np.argmax(self.bounds))]


def is_peak_known(frequencies, bounds, before) -> bool:
    """Return whether the largest of `bounds` is the peak over the frequency within PEAK.

    `before` is the largest bound before the last frequencies were added, 0 if none were added.
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
    """Return the middles of the frequency intervals on both sides of the largest of `bounds`."""
    k = int(np.argmax(bounds))
    ends = frequencies[max(k - 1, 0) : k + 2]
    return [float(middle) for middle in (ends[1:] + ends[:-1]) / 2]


def factor_sets(task, gap) -> np.ndarray:
    """Return factor sets for a gap (mm): nominal, both ends of the gap's tolerance, and corners."""
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
    """Return the `factor_sets` with the nominal gap in each. Sets that become equal occur once."""
    rows = factor_sets(task, gap)
    rows[:, 0] = 1
    return np.unique(rows, axis=0)
