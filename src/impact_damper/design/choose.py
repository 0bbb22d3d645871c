"""The gap that is best in the worst case: over the band, the starts, and a deviation of the gap.

Gaps are first compared coarsely, with few starts at some of the frequencies. The candidates, around
the best of these, are then run from all starts at all frequencies.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.design.outcomes import Case, run, summarise

# Coarse comparison: number of gaps, of frequencies and of starts.
COARSE = 14, 9, 24
# The candidates reach beyond the tolerated deviation from the best gap of the coarse comparison by
# this share.
BEYOND = 1.2
# Gaps between which the worst displacement is interpolated.
DENSE = 2000
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
    """

    gaps: np.ndarray
    frequencies: np.ndarray
    numbers: dict

    @property
    def worst(self) -> np.ndarray:
        """Largest displacement over the band at each gap, mm, shape (m,)."""
        return self.numbers["worst_displacement"].max(axis=1)

    def best_gap(self, tolerance) -> float:
        """Return the nominal gap (mm) whose worst displacement within the tolerance is least.

        The logarithm of the worst displacement is interpolated over that of the gap. The tolerated
        deviations stay within the gaps compared.
        """
        dense = np.geomspace(self.gaps[0], self.gaps[-1], DENSE)
        worst = np.interp(
            np.log(dense), np.log(self.gaps), np.log(np.minimum(self.worst, 1e300))
        )
        nominal = dense[
            (dense * (1 - tolerance) >= dense[0]) & (dense * (1 + tolerance) <= dense[-1])
        ]
        lows = np.searchsorted(dense, nominal * (1 - tolerance))
        highs = np.searchsorted(dense, nominal * (1 + tolerance), side="right")
        scores = [
            worst[low : max(high, low + 1)].max() for low, high in zip(lows, highs, strict=True)
        ]
        least = np.min(scores)
        # of a range of gaps that are equally good its middle is farthest from both ends
        good = nominal[np.asarray(scores) <= least + 1e-3]
        return float(f"{np.sqrt(good[0] * good[-1]):.{DIGITS}g}")


def compare(task, gaps, frequencies, limit, starts, seed, *, workers=1, progress=None, placed=False):
    """Return the motions at all gaps (mm) and frequencies (Hz).

    Parameters
    ----------
    task : Task
    gaps, frequencies : array
    limit : float
        Largest displacement of a quiet motion, mm.
    starts, seed, workers, progress, placed
        As in `outcomes.run`.

    Returns
    -------
    Comparison
    """
    cases = [Case(1e-3 * gap, f) for gap in gaps for f in frequencies]
    found = run(task, cases, starts, seed, workers=workers, progress=progress, placed=placed)
    numbers = summarise(task, found, limit)
    shape = len(gaps), len(frequencies)
    folded = {name: values.reshape(*shape, *values.shape[1:]) for name, values in numbers.items()}
    return Comparison(np.asarray(gaps), np.asarray(frequencies), folded)


def coarse_comparison(task, screening, **running) -> Comparison:
    """Compare gaps over the whole range of the screening, with few starts."""
    gaps, frequencies, starts = COARSE
    columns = np.linspace(0, len(screening.frequencies) - 1, frequencies).round().astype(int)
    kept = sorted({*columns.tolist(), screening.worst})
    return compare(
        task,
        np.geomspace(screening.gaps[0], screening.gaps[-1], gaps),
        screening.frequencies[kept],
        screening.limit,
        starts,
        task.seed + 1,
        **running,
    )


def candidate_comparison(task, screening, coarse, **running) -> Comparison:
    """Compare the candidates around the best gap of a coarse comparison, from all starts."""
    tolerance = task.tolerances.get("gap", 0.0)
    middle = coarse.best_gap(tolerance)
    least = max(middle * (1 - tolerance) / BEYOND, coarse.gaps[0])
    most = min(middle * (1 + tolerance) * BEYOND, coarse.gaps[-1])
    return compare(
        task,
        np.geomspace(least, most, task.candidates),
        screening.frequencies,
        screening.limit,
        task.starts,
        task.seed + 2,
        **running,
    )
