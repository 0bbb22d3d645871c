"""Choice of the gap whose worst case over band, starts and deviation of the gap is best.

The gap is the full play of the loose mass. A start is a random initial state. The motion to which a
start leads is quiet if its largest displacement is at most the quiet limit. A gap is called quiet
if, at every frequency of the band, the share of starts that lead to quiet motions is large enough.
The tolerance is the largest relative deviation of the built gap from the nominal one.
"""

import math
from typing import NamedTuple

import numpy as np

# Displacement (mm) in place of infinity for a motion that escapes, so that it can be interpolated.
HUGE = 1e6
# Two displacements count as equal if their relative difference is smaller, two shares if their
# difference is smaller.
ALIKE = 1e-3
# Significant digits of a nominal gap: usual number, and largest number if the gap must lie in a
# narrow range.
DIGITS, MOST_DIGITS = 3, 9


class Choice(NamedTuple):
    """A nominal gap.

    Attributes
    ----------
    gap : float
        mm.
    kind : str
        "robust": all gaps within the tolerance of `gap` are quiet, and of all such gaps, `gap` has
        the smallest worst displacement within the tolerance. "needs_tolerance": only ranges
        narrower than the tolerance are quiet, and `gap` is the middle of the widest. "least_worst":
        no gap is quiet, or only ranges so narrow that a builder cannot keep a gap within them
        (`cliff.HOLDABLE`). At `gap` the share of quiet starts is largest.
    """

    gap: float
    kind: str


class Comparison(NamedTuple):
    """Comparison of the motions at several gaps and frequencies.

    Attributes
    ----------
    gaps : numpy.ndarray, shape (m,)
        Ascending, mm.
    frequencies : numpy.ndarray, shape (n,)
        Hz.
    numbers : dict of numpy.ndarray, shape (m, n) or (m, n, 2)
        As returned by `outcomes.summarise`, for each gap and frequency.
    limit : float
        Quiet limit, the largest displacement of a quiet motion, mm.
    share : float
        Least share of starts that must lead to quiet motions at every frequency.
    """

    gaps: np.ndarray
    frequencies: np.ndarray
    numbers: dict
    limit: float
    share: float

    @property
    def worst(self) -> np.ndarray:
        """Largest displacement over the band at each gap, mm, shape (m,)."""
        return self.numbers["worst_displacement"].max(axis=1)

    @property
    def least_share(self) -> np.ndarray:
        """Share of quiet starts at the worst frequency of the band, for each gap, shape (m,)."""
        return self.numbers["start_quiet_share"].min(axis=1)

    @property
    def quiet(self) -> np.ndarray:
        """Whether a gap is quiet at all frequencies, shape (m,).

        At each frequency the 95 % confidence interval of the share of quiet starts must lie above
        `share`. If there are too few starts for such an interval, all of them must lead to quiet
        motions.
        """
        claimed = self.numbers["start_quiet_interval"][..., 0] >= self.share
        return (claimed | (self.numbers["start_quiet_share"] == 1)).all(axis=1)

    def choose(self, tolerance) -> Choice:
        """Return the nominal gap that is best if the gap deviates by up to a tolerance.

        Worst displacements are interpolated between the compared gaps. A gap between two compared
        gaps counts as quiet if both are quiet.

        Parameters
        ----------
        tolerance : float
            Relative deviation of the gap.
        """
        nominal, lows, highs, covered = self._nominal(tolerance)
        logs = np.log(np.minimum(self.worst, HUGE))
        sizes = largest_within(self.gaps, logs, lows, highs)
        robust = covered & self._quiet_within(lows, highs)
        if robust.any():
            return Choice(_middle(nominal, np.where(robust, sizes, np.inf)), "robust")
        if self.quiet.any():
            return Choice(middle_gap(*self._widest()), "needs_tolerance")
        shares = self.numbers["start_quiet_share"].mean(axis=1)
        loud = largest_within(self.gaps, 1 - shares, lows, highs)
        allowed = covered if covered.any() else ~covered
        fewest = allowed & (loud <= loud[allowed].min() + ALIKE)
        return Choice(_middle(nominal, np.where(fewest, sizes, np.inf)), "least_worst")

    def only(self, kept) -> "Comparison":
        """Return the comparison of some of the gaps; `kept` are booleans, shape (m,)."""
        numbers = {name: values[kept] for name, values in self.numbers.items()}
        return self._replace(gaps=self.gaps[kept], numbers=numbers)

    def without(self, low, high) -> "Comparison":
        """Return the comparison without the gaps from `low` to `high` (mm)."""
        return self.only((self.gaps < low) | (self.gaps > high))

    def joined(self, other) -> "Comparison":
        """Return the comparison of the gaps of two comparisons of the same task."""
        gaps = np.concatenate([self.gaps, other.gaps])
        order = np.argsort(gaps)
        numbers = {
            name: np.concatenate([values, other.numbers[name]])[order]
            for name, values in self.numbers.items()
        }
        return self._replace(gaps=gaps[order], numbers=numbers)

    def robust_gaps(self, tolerance) -> np.ndarray:
        """Return the nominal gaps (mm) for which all gaps within the tolerance are quiet."""
        nominal, lows, highs, covered = self._nominal(tolerance)
        return nominal[covered & self._quiet_within(lows, highs)]

    def _nominal(self, tolerance):
        """Return nominal gaps, the least and greatest gap of each, and whether both are covered.

        Covered means that they lie between the first and the last compared gap.
        """
        nominal = buildable(self.gaps[0], self.gaps[-1])
        lows, highs = nominal * (1 - tolerance), nominal * (1 + tolerance)
        return nominal, lows, highs, (lows >= self.gaps[0]) & (highs <= self.gaps[-1])

    def _widest(self):
        """Return the ends of the widest range of quiet gaps (mm).

        Of several ranges of equal width, the one with the smallest displacement is returned.
        """
        begins, ends = runs_of(self.quiet)
        widths = np.log(self.gaps[ends] / self.gaps[begins])
        worst = [self.worst[a : b + 1].max() for a, b in zip(begins, ends, strict=True)]
        k = int(np.argmin(np.where(widths >= widths.max() - ALIKE, worst, np.inf)))
        return self.gaps[begins[k]], self.gaps[ends[k]]

    def _quiet_within(self, lows, highs):
        """Return whether all compared gaps between `lows` and `highs` are quiet, shape (n,).

        The nearest compared gap outside each end must be quiet too.
        """
        first = np.searchsorted(self.gaps, lows, side="right") - 1
        last = np.searchsorted(self.gaps, highs, side="left")
        loud = np.concatenate([[0], np.cumsum(~self.quiet)])
        return loud[np.minimum(last, len(self.gaps) - 1) + 1] == loud[np.maximum(first, 0)]


def buildable(least, most) -> np.ndarray:
    """Return the numbers of DIGITS digits in a range, or if there are none, its geometric mean."""
    exponents = range(math.floor(math.log10(least)), math.floor(math.log10(most)) + 1)
    first = 10 ** (DIGITS - 1)
    values = [
        float(f"{digits}e{exponent - DIGITS + 1}")
        for exponent in exponents
        for digits in range(first, 10 * first)
    ]
    found = np.array([value for value in values if least <= value <= most])
    return found if len(found) else np.array([math.sqrt(least * most)])


def largest_within(gaps, values, lows, highs) -> np.ndarray:
    """Return the largest value between each pair of ends, interpolated over log(gap), shape (n,).

    Parameters
    ----------
    gaps, values : array, shape (m,)
        Ascending gaps, and a value at each gap.
    lows, highs : array, shape (n,)
        Ends. Beyond the first and the last gap the value is that of the first or last gap.
    """
    ends = np.interp(np.log([lows, highs]), np.log(gaps), values).max(axis=0)
    between = (gaps >= np.reshape(lows, (-1, 1))) & (gaps <= np.reshape(highs, (-1, 1)))
    return np.maximum(ends, np.where(between, values, -np.inf).max(axis=1))


def _middle(nominal, scores):
    """Return the middle of the longest run of gaps whose scores equal the smallest score."""
    begins, ends = runs_of(scores <= scores.min() + ALIKE)
    k = int(np.argmax(ends - begins))
    return float(nominal[(begins[k] + ends[k]) // 2])


def middle_gap(first, last) -> float:
    """Return a gap inside a range, near its middle, with as few digits as possible."""
    middle = math.sqrt(first * last)
    for digits in range(DIGITS, MOST_DIGITS):
        gap = float(f"{middle:.{digits}g}")
        if first <= gap <= last:
            return gap
    return float(middle)


def runs_of(flags) -> tuple[np.ndarray, np.ndarray]:
    """Return the first and the last index of each run of successive true flags, as two arrays."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return edges[::2], edges[1::2] - 1
