"""The gap that is best in the worst case: over the band, the starts, and a deviation of the gap.

Gaps are first compared coarsely, with few starts at some of the frequencies. The candidates, around
the best of these, are then run from all starts at all frequencies; a candidate that fails in the
first starts is not run from the others.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.data.shares import failures_allowed
from impact_damper.design.outcomes import Case, draw_starts, run, run_starts, summarise

# Coarse comparison: most gaps (fewer with few candidates), number of frequencies and of starts.
COARSE_GAPS, COARSE_FREQUENCIES, COARSE_STARTS = 28, 9, 12
# Starts after which a gap is given up if it can no longer be quiet.
TRIAL = 24
# The candidates reach beyond the tolerated deviation from the best gap of the coarse comparison by
# this factor.
BEYOND = 1.15
# Largest displacement of a quiet motion, divided by the worst one at the best gap of the coarse
# comparison. It leaves room for gaps within a tolerance, at which the quiet motion is larger.
ABOVE = 2.5
# Least share of quiet starts at a candidate beside which further ones are compared.
PROMISING = 0.5
# Displacement (mm) that stands for a motion that escapes; relative difference of displacements, and
# difference of shares, that are alike.
HUGE = 1e6
ALIKE = 1e-3
# Digits of a nominal gap, which is to be built, and most digits if it must lie in a narrow range.
DIGITS, MOST_DIGITS = 3, 9


class Choice(NamedTuple):
    """A nominal gap.

    Attributes
    ----------
    gap : float
        mm.
    kind : str
        "robust" if all gaps within the tolerance are quiet, for the one of these gaps whose worst
        displacement within the tolerance is least; "needs_tolerance" if only ranges narrower than
        the tolerance are quiet, for the middle of the widest; "least_worst" if no gap is quiet, for
        the gap at which, within the tolerance, most starts end quiet over the band.
    """

    gap: float
    kind: str


class Comparison(NamedTuple):
    """Motions over gaps and frequencies.

    Attributes
    ----------
    gaps : numpy.ndarray, shape (m,)
        Ascending, mm.
    frequencies : numpy.ndarray, shape (n,)
        Hz.
    numbers : dict of numpy.ndarray, shape (m, n) or (m, n, 2)
        As returned by `summarise`.
    limit : float
        Largest displacement of a quiet motion, mm.
    share : float
        Share of starts that must end quiet.
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
        """Least share of quiet starts over the band at each gap, shape (m,)."""
        return self.numbers["start_quiet_share"].min(axis=1)

    @property
    def quiet(self) -> np.ndarray:
        """Whether a gap is quiet at all frequencies, shape (m,).

        The share of quiet starts is claimed for each frequency or, with too few starts for a claim,
        all starts are quiet.
        """
        claimed = self.numbers["start_quiet_interval"][..., 0] >= self.share
        return (claimed | (self.numbers["start_quiet_share"] == 1)).all(axis=1)

    def choose(self, tolerance) -> Choice:
        """Return the nominal gap that is best when the gap deviates by up to a tolerance.

        Worst displacements are interpolated between the gaps compared. Between two of these a gap
        is quiet only if both are.

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

    def robust_gaps(self, tolerance) -> np.ndarray:
        """Return the nominal gaps within whose tolerance all gaps are quiet, mm."""
        nominal, lows, highs, covered = self._nominal(tolerance)
        return nominal[covered & self._quiet_within(lows, highs)]

    def _nominal(self, tolerance):
        """Return nominal gaps, the ends of their tolerance, and whether these were compared."""
        nominal = buildable(self.gaps[0], self.gaps[-1])
        lows, highs = nominal * (1 - tolerance), nominal * (1 + tolerance)
        return nominal, lows, highs, (lows >= self.gaps[0]) & (highs <= self.gaps[-1])

    def _widest(self):
        """Return the ends of the widest range of quiet gaps, of equal ones of the quietest."""
        begins, ends = runs_of(self.quiet)
        widths = np.log(self.gaps[ends] / self.gaps[begins])
        worst = [self.worst[a : b + 1].max() for a, b in zip(begins, ends, strict=True)]
        k = int(np.argmin(np.where(widths >= widths.max() - ALIKE, worst, np.inf)))
        return self.gaps[begins[k]], self.gaps[ends[k]]

    def _quiet_within(self, lows, highs):
        """Return whether all gaps are quiet between ends, those beside the ends among them."""
        first = np.searchsorted(self.gaps, lows, side="right") - 1
        last = np.searchsorted(self.gaps, highs, side="left")
        loud = np.concatenate([[0], np.cumsum(~self.quiet)])
        return loud[np.minimum(last, len(self.gaps) - 1) + 1] == loud[np.maximum(first, 0)]


def buildable(least, most) -> np.ndarray:
    """Return the numbers of DIGITS digits in a range; its geometric middle if there is none."""
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
    """Return the largest value between each pair of ends, interpolated over the logarithm.

    Parameters
    ----------
    gaps, values : array, shape (m,)
        Ascending gaps.
    lows, highs : array, shape (n,)
        Ends; values beyond the gaps are those of the first and of the last gap.
    """
    ends = np.interp(np.log([lows, highs]), np.log(gaps), values).max(axis=0)
    between = (gaps >= np.reshape(lows, (-1, 1))) & (gaps <= np.reshape(highs, (-1, 1)))
    return np.maximum(ends, np.where(between, values, -np.inf).max(axis=1))


def _middle(nominal, scores):
    """Return the middle of the longest run of gaps that are as good as the best."""
    begins, ends = runs_of(scores <= scores.min() + ALIKE)
    k = int(np.argmax(ends - begins))
    return float(nominal[(begins[k] + ends[k]) // 2])


def middle_gap(first, last) -> float:
    """Return a gap near the middle of a range, within it, with no more digits than that needs."""
    middle = math.sqrt(first * last)
    for digits in range(DIGITS, MOST_DIGITS):
        gap = float(f"{middle:.{digits}g}")
        if first <= gap <= last:
            return gap
    return float(middle)


def runs_of(flags) -> tuple[np.ndarray, np.ndarray]:
    """Return the first and the last index of each run of true flags."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return edges[::2], edges[1::2] - 1


def compare(task, gaps, frequencies, limit, starts, stream, *, workers=1, progress=None):
    """Return the motions at all gaps (mm) and frequencies (Hz).

    A gap that can no longer be quiet after TRIAL starts at each frequency, because at one of them
    too many starts are not, keeps the numbers of these starts. So the numbers of gaps that are not
    quiet come from fewer starts, and those of quiet gaps, of which a share is claimed, from all.

    Parameters
    ----------
    task : Task
    gaps, frequencies : array
    limit : float
        Largest displacement of a quiet motion, mm.
    starts : int
        Random starts at each gap and frequency.
    stream, workers, progress
        As in `outcomes.run`, with the settling `Task.hurried`.

    Returns
    -------
    Comparison
    """
    gaps, frequencies = np.asarray(gaps), np.asarray(frequencies)
    cases = [Case(1e-3 * gap, f) for gap in gaps for f in frequencies]
    running = {"settling": task.hurried, "workers": workers, "progress": progress}
    drawn = draw_starts(task, cases, starts, stream, workers=workers)
    first = run_starts(task, cases, drawn[:, :TRIAL], **running)
    numbers = summarise(task, first, limit)
    allowed = max(failures_allowed(task.share, starts), 0)
    failures = np.rint((1 - numbers["start_quiet_share"]) * numbers["start_count"])
    hopeful = failures.reshape(len(gaps), -1).max(axis=1) <= allowed
    if starts > TRIAL and hopeful.any():
        places = np.flatnonzero(np.repeat(hopeful, len(frequencies)))
        rest = run_starts(task, [cases[k] for k in places], drawn[places, TRIAL:], **running)
        complete = summarise(task, np.concatenate([first[places], rest], axis=1), limit)
        for name, values in complete.items():
            numbers[name][places] = values
    return _comparison(task, gaps, frequencies, numbers, limit)


def _comparison(task, gaps, frequencies, numbers, limit):
    """Return a comparison from numbers on cases, those of one gap after those of another."""
    shape = len(gaps), len(frequencies)
    folded = {name: values.reshape(*shape, *values.shape[1:]) for name, values in numbers.items()}
    return Comparison(gaps, frequencies, folded, limit, task.share)


def coarse_comparison(task, span, limit, *, most=COARSE_GAPS, starts=COARSE_STARTS, **running):
    """Return a comparison of gaps over a whole range, with few starts, and set the limit.

    If the task gives no displacement limit, `limit` is lowered to ABOVE times the displacement that
    no motion exceeds at the best gap.

    Parameters
    ----------
    task : Task
    span : tuple of float
        Least and greatest gap, mm.
    limit : float
        Largest displacement of a quiet motion as far as known, mm.
    most, starts : int
        Most gaps, and random starts at each gap and frequency.
    running
        `workers` and `progress` of `outcomes.run`.

    Returns
    -------
    Comparison
    """
    frequencies = task.few(COARSE_FREQUENCIES)
    gaps = np.geomspace(*span, min(most, 2 * task.candidates + 4))
    cases = [Case(1e-3 * gap, f) for gap in gaps for f in frequencies]
    records = run(task, cases, starts, "coarse", settling=task.hurried, **running)
    found = _comparison(task, gaps, frequencies, summarise(task, records, limit), limit)
    if task.displacement_limit is not None:
        return found
    limit = min(limit, ABOVE * float(found.worst.min()))
    return _comparison(task, gaps, frequencies, summarise(task, records, limit), limit)


def candidate_comparison(task, coarse, **running) -> Comparison:
    """Return a comparison of the candidates from all starts, with the limit of the coarse one.

    They lie around the best gap of the coarse comparison. If none of them is quiet, but most starts
    are at one of them at all frequencies, a quiet range may lie beside it: further ones are then
    compared there.
    """
    tolerance, limit = task.tolerances.get("gap", 0.0), coarse.limit
    reach = BEYOND / (1 - tolerance)
    gaps = coarse.choose(tolerance).gap * np.geomspace(1 / reach, reach, task.candidates)
    found = compare(task, gaps, task.grid, limit, task.starts, "candidates", **running)
    least = found.least_share
    if found.quiet.any() or least.max() < PROMISING:
        return found
    k = int(np.argmax(least))
    near = gaps[max(k - 1, 0)], gaps[min(k + 1, len(gaps) - 1)]
    # the ends are compared already
    between = np.setdiff1d(np.geomspace(*near, task.candidates)[1:-1], gaps)
    stream = "further_candidates"
    further = compare(task, between, task.grid, limit, task.starts, stream, **running)
    order = np.argsort(np.concatenate([gaps, between]))
    numbers = {
        name: np.concatenate([found.numbers[name], further.numbers[name]])[order]
        for name in found.numbers
    }
    return found._replace(gaps=np.concatenate([gaps, between])[order], numbers=numbers)
