"""What single-term harmonic balance says in each cell of a map.

It knows elastic contact only: with e < 1 it says what it says for e = 1.
"""

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.theory import single_harmonic as balance
from impact_damper.theory.slow_flow import fixed_points, growth_rate, stability

# A motion is high from this share of the free resonance's amplitude on.
HIGH = 0.5


class Cells(NamedTuple):
    """What harmonic balance says in cells, and where runs start; NaN where there is none.

    Attributes
    ----------
    resonance : numpy.ndarray, shape (rows, columns)
        Amplitude of the free resonance branch, beyond its end that at its end.
    quiet, high : numpy.ndarray, shape (rows, columns)
        Flags `balance_quiet` and `balance_high`.
    quiet_amplitude, quiet_growth, high_amplitude : numpy.ndarray, shape (rows, columns)
        |a| of these solutions, and the growth rate of the slow flow.
    quiet_start, high_start : numpy.ndarray, shape (rows, columns, 4)
        States at T = 0 of these solutions; where there is no high one, on the free resonance
        branch with the loose mass at rest amid the gap.
    """

    resonance: np.ndarray
    quiet: np.ndarray
    quiet_amplitude: np.ndarray
    quiet_growth: np.ndarray
    quiet_start: np.ndarray
    high: np.ndarray
    high_amplitude: np.ndarray
    high_start: np.ndarray


def balance_cells(rows) -> Cells:
    """Harmonic balance in the cells of a map.

    The quiet solution is that of (7) with the smallest |a|, if it is below half of the free
    resonance; the high one is the stable solution with the largest |a| from that half on.

    Parameters
    ----------
    rows : list of tuple
        Of each row the oscillator, the damper and the forcing frequencies.

    Returns
    -------
    Cells
    """
    cells = [
        [_cell(oscillator, damper, frequency) for frequency in frequencies]
        for oscillator, damper, frequencies in rows
    ]
    return Cells(
        *(np.array([[cell[k] for cell in row] for row in cells]) for k in range(len(Cells._fields)))
    )


def _cell(oscillator, damper, frequency):
    """Harmonic balance in one cell."""
    resonance, top = _resonance(oscillator, frequency)
    high_start = np.full(4, np.nan)
    if top is not None:
        # the loose mass at rest amid the gap
        start = _start(resonance, 0.0, top, frequency)
        high_start = np.array([start[0], start[1], 0.0, start[1]])
    nothing = np.nan, np.nan, np.full(4, np.nan)
    elastic = replace(damper, restitution=1.0)
    try:
        found, growth = _solutions(oscillator, elastic, frequency)
    except ArithmeticError:
        unresolved = flag("balance_quiet", "unresolved")
        return Cells(resonance, unresolved, *nothing, unresolved, np.nan, high_start)
    signs = stability(growth)
    size = np.abs(found.amplitude)
    quiet = flag("balance_quiet", "none"), *nothing
    if len(size) and np.min(size) < HIGH * resonance:
        k = np.argmin(size)
        verdict = {1: "stable", -1: "unstable", 0: "unresolved"}[int(signs[k])]
        start = _start(found.amplitude[k], found.relative_amplitude[k], found.phase[k], frequency)
        quiet = flag("balance_quiet", verdict), size[k], growth[k], start
    high = flag("balance_high", "none"), np.nan, high_start
    large = np.flatnonzero((signs == flag("stability", "stable")) & (size >= HIGH * resonance))
    if len(large):
        k = large[np.argmax(size[large])]
        start = _start(found.amplitude[k], found.relative_amplitude[k], found.phase[k], frequency)
        high = flag("balance_high", "stable"), size[k], start
    return Cells(resonance, *quiet, *high)


@lru_cache(4096)
def _solutions(oscillator, damper, frequency):
    """Solutions of (7) and their growth rates; kept, for over e they do not change."""
    found = balance.impacting_solutions(oscillator, damper, frequency)
    return found, growth_rate(fixed_points(found), oscillator, damper, frequency)


@lru_cache(4096)
def _resonance(oscillator, frequency):
    """Amplitude and phase of the free resonance branch; beyond its end that amplitude and None."""
    folds = _folds(oscillator)
    if folds and frequency > folds[-1].frequency:
        return folds[-1].amplitude, None
    free = balance.free_solutions(oscillator, frequency)
    return free.amplitude[-1], free.phase[-1]


_folds = lru_cache(balance.free_folds)


def _start(amplitude, relative_amplitude, phase, frequency):
    """State at T = 0 of Z1 = a cos(W T + t1), Z2 = b cos(W T + t1)."""
    inline, across = np.cos(phase), -frequency * np.sin(phase)
    sizes = amplitude, relative_amplitude
    return np.array([part for size in sizes for part in (size * inline, size * across)])
