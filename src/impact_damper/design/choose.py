"""The gap that is best in the worst case: over the band, the starts, and a deviation of the gap.

Gaps are first compared coarsely, with few starts at some of the frequencies. The candidates, around
the best of these, are then run from all starts at all frequencies.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.design.outcomes import Case, run, summarise

# Coarse comparison: most gaps (fewer with few candidates), number of frequencies and of starts.
COARSE_GAPS, COARSE_FREQUENCIES, COARSE_STARTS = 14, 9, 24
# The candidates reach beyond the tolerated deviation from the best gap of the coarse comparison by
# this share.
BEYOND = 1.15
# Number of gaps at which the worst displacement is interpolated; displacement (mm) that stands for
# a motion that escapes; difference of logarithms of displacements that are alike.
DENSE = 2000
HUGE = 1e6
ALIKE = 1e-3
# Digits of a nominal gap, which is to be built.
DIGITS = 3


class Comparison(NamedTuple):
    """Motions over gaps and frequencies.

    Attributes
    ----------
    gaps : numpy.ndarray, shape (m,)
        mm.
    frequencies : numpy.ndarray, shape (n,)
        Hz.
    numbers : dict of numpy.ndarray, shape (m, n) or (m, n, 2)
        As returned by `summarise`.
    share : float
        Share of starts that must end quiet.
    starts : int
        Random starts at each gap and frequency.
    """

    gaps: np.ndarray
    frequencies: np.ndarray
    numbers: dict
    share: float
    starts: int

    @property
    def worst(self) -> np.ndarray:
        """Largest displacement over the band at each gap, mm, shape (m,)."""
        return self.numbers["worst_displacement"].max(axis=1)

    @property
    def quiet(self) -> np.ndarray:
        """Whether a gap is quiet at all frequencies, shape (m,).

        The share of quiet starts is claimed for each frequency or, with too few starts for a claim,
        all starts are quiet.
        """
        claimed = self.numbers["start_quiet_interval"][..., 0] >= self.share
        return (claimed | (self.numbers["start_quiet_share"] == 1)).all(axis=1)

    def choose(self, tolerance) -> "Choice":
        """Return the nominal gap that is best when the gap deviates by up to a tolerance.

        Parameters
        ----------
        tolerance : float
            Relative deviation of the gap.
        """
        dense = np.geomspace(self.gaps[0], self.gaps[-1], DENSE)
        logs, worst = np.log(self.gaps), np.log(np.minimum(self.worst, HUGE))
        sizes = np.interp(np.log(dense), logs, worst)
        # between two gaps it is quiet only if it is at both
        quiet = np.interp(np.log(dense), logs, self.quiet.astype(float)) > 1 - 1e-9
        inside = (dense * (1 - tolerance) >= dense[0]) & (dense * (1 + tolerance) <= dense[-1])
        nominal = dense[inside]
        lows = np.searchsorted(dense, nominal * (1 - tolerance))
        highs = np.searchsorted(dense, nominal * (1 + tolerance), side="right")
        windows = [slice(low, max(high, low + 1)) for low, high in zip(lows, highs, strict=True)]
        scores = np.array([sizes[window].max() for window in windows])
        robust = np.array([quiet[window].all() for window in windows])
        if robust.any():
            return Choice(_middle(nominal, np.where(robust, scores, np.inf)), "robust")
        if self.quiet.any():
            first, last = _longest_run(self.quiet)
            gap = np.sqrt(self.gaps[first] * self.gaps[last])
            return Choice(_rounded(gap), "needs_tolerance")
        if len(nominal) == 0:  # the gaps compared span less than the tolerance
            nominal, scores = dense, sizes
        return Choice(_middle(nominal, scores), "least_worst")


class Choice(NamedTuple):
    """A nominal gap.

    Attributes
    ----------
    gap : float
        mm.
    kind : str
        "robust" if all gaps within the tolerance are quiet; "needs_tolerance" if only some gaps
        are, in a range narrower than the tolerance, of which the nominal gap is the middle;
        "least_worst" if no gap is quiet, for the gap whose worst displacement is least.
    """

    gap: float
    kind: str


def _middle(nominal, scores):
    """Return the middle of the gaps that are as good as the best, farthest from both ends."""
    good = nominal[scores <= scores.min() + ALIKE]
    return _rounded(np.sqrt(good[0] * good[-1]))


def _rounded(gap):
    return float(f"{gap:.{DIGITS}g}")


def _longest_run(flags):
    """Return the first and the last index of the longest run of true flags."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    begins, ends = edges[::2], edges[1::2]
    k = int(np.argmax(ends - begins))
    return begins[k], ends[k] - 1


def spread(values, count) -> np.ndarray:
    """Return at most `count` of some values, evenly spread, the first and the last among them."""
    return values[np.unique(np.linspace(0, len(values) - 1, count).round().astype(int))]


def compare(task, gaps, frequencies, limit, starts, seed, *, workers=1, progress=None):
    """Return the motions at all gaps (mm) and frequencies (Hz).

    Parameters
    ----------
    task : Task
    gaps, frequencies : array
    limit : float
        Largest displacement of a quiet motion, mm.
    starts, seed, workers, progress
        As in `outcomes.run`, with the settling `Task.hurried`.

    Returns
    -------
    Comparison
    """
    cases = [Case(1e-3 * gap, f) for gap in gaps for f in frequencies]
    running = {"settling": task.hurried, "workers": workers, "progress": progress}
    found = run(task, cases, starts, seed, **running)
    numbers = summarise(task, found, limit)
    shape = len(gaps), len(frequencies)
    folded = {name: values.reshape(*shape, *values.shape[1:]) for name, values in numbers.items()}
    return Comparison(np.asarray(gaps), np.asarray(frequencies), folded, task.share, starts)


def coarse_comparison(task, span, frequency, limit, *, starts=COARSE_STARTS, **running):
    """Return a comparison of gaps over a whole range, with few starts.

    Parameters
    ----------
    task : Task
    span : tuple of float
        Least and greatest gap, mm.
    frequency : float
        A frequency that is not left out, Hz.
    limit : float
        Largest displacement of a quiet motion, mm.
    starts : int
        Random starts at each gap and frequency.
    running
        `workers` and `progress` of `outcomes.run`.

    Returns
    -------
    Comparison
    """
    kept = np.union1d(spread(task.grid, COARSE_FREQUENCIES), frequency)
    gaps = np.geomspace(*span, min(COARSE_GAPS, 2 * task.candidates - 2))
    return compare(task, gaps, kept, limit, starts, task.seed + 1, **running)


def candidate_comparison(task, coarse, limit, **running) -> Comparison:
    """Return a comparison of the candidates from all starts.

    They lie around the best gap of a coarse comparison. If none of them is quiet, but some starts
    are at all frequencies, a quiet range may lie between them: they are then compared once more,
    around the one of the largest share.
    """
    tolerance = task.tolerances.get("gap", 0.0)
    middle = coarse.choose(tolerance).gap
    reach = BEYOND / (1 - tolerance)
    # an odd number of gaps, so that the middle is one of them
    shares = np.geomspace(1 / reach, reach, task.candidates | 1)
    found = compare(task, middle * shares, task.grid, limit, task.starts, task.seed + 2, **running)
    least = found.numbers["start_quiet_share"].min(axis=1)
    if found.quiet.any() or least.max() == 0:
        return found
    k = int(np.argmax(least))
    near = found.gaps[max(k - 1, 0)], found.gaps[min(k + 1, len(found.gaps) - 1)]
    gaps = np.geomspace(*near, task.candidates)
    return compare(task, gaps, task.grid, limit, task.starts, task.seed + 3, **running)
