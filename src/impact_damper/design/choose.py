"""Choice of the gap whose worst case over band, starts and deviation of the gap is best.

A comparison is a dataset of gaps and frequencies (`compare.compare`). The tolerance is the largest
relative deviation of the built gap from the nominal one.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.data.sweeps import runs_of_true

# Displacement (mm) in place of infinity for a motion that escapes, so that it can be interpolated.
HUGE = 1e6
# Two displacements count as equal if their relative difference is smaller, two shares if their
# difference is smaller.
ALIKE = 1e-3
# Significant digits of a nominal gap: usual number, and largest number if the gap must lie in a
# narrow range.
DIGITS, MOST_DIGITS = 3, 9


class Choice(NamedTuple):
    """A nominal gap (mm), and the name of a flag of `design_choice`.

    "robust": all gaps within the tolerance are quiet. "needs_tolerance": only ranges narrower than
    the tolerance are quiet, and the gap is the middle of the widest. "least_worst": no range of
    gaps that a builder can hold is quiet, and here the share of quiet starts is largest.
    """

    gap: float
    kind: str


def worst_sizes(compared) -> np.ndarray:
    """Return the largest displacement over the band at each gap, mm."""
    return compared["worst_displacement"].values.max(axis=1)


def least_shares(compared) -> np.ndarray:
    """Return the share of quiet starts at the worst frequency of the band, for each gap."""
    return compared["start_quiet_share"].values.min(axis=1)


def quiet_gaps(compared, share) -> np.ndarray:
    """Return at which gaps the share of quiet starts is proved at all frequencies.

    The 95 % confidence interval must lie above `share`. With too few starts for this, all of them
    must lead to quiet motions.
    """
    claimed = compared["start_quiet_interval"].values[..., 0] >= share
    return (claimed | (compared["start_quiet_share"].values == 1)).all(axis=1)


def choose(compared, share, tolerance) -> Choice:
    """Return the nominal gap that is best if the gap deviates by up to a tolerance.

    Worst displacements are interpolated between the compared gaps. A gap between two compared gaps
    counts as quiet if both are quiet.
    """
    gaps, quiet = compared["candidate_gap"].values, quiet_gaps(compared, share)
    nominal, lows, highs, covered = _nominal(gaps, tolerance)
    logs = np.log(np.minimum(worst_sizes(compared), HUGE))
    sizes = largest_within(gaps, logs, lows, highs)
    robust = covered & _quiet_within(gaps, quiet, lows, highs)
    if robust.any():
        return Choice(_middle(nominal, np.where(robust, sizes, np.inf)), "robust")
    if quiet.any():
        return Choice(middle_gap(*_widest(gaps, quiet, worst_sizes(compared))), "needs_tolerance")
    shares = compared["start_quiet_share"].values.mean(axis=1)
    loud = largest_within(gaps, 1 - shares, lows, highs)
    allowed = covered if covered.any() else ~covered
    fewest = allowed & (loud <= loud[allowed].min() + ALIKE)
    return Choice(_middle(nominal, np.where(fewest, sizes, np.inf)), "least_worst")


def robust_gaps(compared, share, tolerance) -> np.ndarray:
    """Return the nominal gaps (mm) for which all gaps within the tolerance are quiet."""
    gaps = compared["candidate_gap"].values
    nominal, lows, highs, covered = _nominal(gaps, tolerance)
    return nominal[covered & _quiet_within(gaps, quiet_gaps(compared, share), lows, highs)]


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
    """Return the largest value between each pair of ends, interpolated over log(gap).

    Beyond the first and the last gap the value is that of the first or last gap.
    """
    ends = np.interp(np.log([lows, highs]), np.log(gaps), values).max(axis=0)
    between = (gaps >= np.reshape(lows, (-1, 1))) & (gaps <= np.reshape(highs, (-1, 1)))
    return np.maximum(ends, np.where(between, values, -np.inf).max(axis=1))


def middle_gap(first, last) -> float:
    """Return a gap inside a range, near its middle, with as few digits as possible."""
    middle = math.sqrt(first * last)
    for digits in range(DIGITS, MOST_DIGITS):
        gap = float(f"{middle:.{digits}g}")
        if first <= gap <= last:
            return gap
    return float(middle)


def _nominal(gaps, tolerance):
    """Return nominal gaps, their least and greatest values, and whether the gaps cover both."""
    nominal = buildable(gaps[0], gaps[-1])
    lows, highs = nominal * (1 - tolerance), nominal * (1 + tolerance)
    return nominal, lows, highs, (lows >= gaps[0]) & (highs <= gaps[-1])


def _quiet_within(gaps, quiet, lows, highs):
    """Return whether all gaps between `lows` and `highs` and the nearest ones outside are quiet."""
    first = np.searchsorted(gaps, lows, side="right") - 1
    last = np.searchsorted(gaps, highs, side="left")
    loud = np.concatenate([[0], np.cumsum(~quiet)])
    return loud[np.minimum(last, len(gaps) - 1) + 1] == loud[np.maximum(first, 0)]


def _widest(gaps, quiet, worst):
    """Return the ends of the widest range of quiet gaps; of equal ones, that of least motion."""
    runs = runs_of_true(quiet)
    widths = np.log([gaps[after - 1] / gaps[first] for first, after in runs])
    sizes = [worst[first:after].max() for first, after in runs]
    first, after = runs[np.argmin(np.where(widths >= widths.max() - ALIKE, sizes, np.inf))]
    return gaps[first], gaps[after - 1]


def _middle(nominal, scores):
    """Return the middle of the longest run of gaps whose scores equal the smallest score."""
    runs = runs_of_true(scores <= scores.min() + ALIKE)
    first, after = runs[np.argmax(runs[:, 1] - runs[:, 0])]
    return float(nominal[(first + after - 1) // 2])
