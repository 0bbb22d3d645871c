"""Single-term harmonic balance in each cell of a balance map, and start states for simulations.

A cell is a pair of a forcing frequency (column) and a value of another parameter (row). a is the
amplitude of Z1, the displacement of the primary mass. b is the amplitude of Z2, the displacement of
the primary mass relative to the loose mass. The quiet solution is the motion for which the damper
is designed. The high solution has an amplitude comparable with the resonance without the damper.
`balance_cells` defines both. Single-term harmonic balance assumes elastic contact, so cells with
restitution e < 1 have the solutions for e = 1.

W is the forcing frequency, and T the time. Numbers in brackets are equations of the paper.
"""

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.theory.free_oscillator import resonance
from impact_damper.theory.single_harmonic import impacting_solutions
from impact_damper.theory.slow_flow import fixed_points, growth_rate, stability

# A motion is high if its amplitude is at least HIGH times the free resonance amplitude, and quiet
# if its amplitude is below this limit.
HIGH = 0.5
# A settled motion is near a predicted motion if max |Z1| differs relatively by at most NEAR.
NEAR = 0.2


class Cells(NamedTuple):
    """Solutions of harmonic balance in all cells, and start states; NaN without a solution.

    Attributes
    ----------
    resonance : numpy.ndarray, shape (rows, columns)
        Amplitude of the free resonance branch. Beyond the frequency at which the branch ends, the
        amplitude at this end.
    quiet, high : numpy.ndarray of int, shape (rows, columns)
        Values of the flags `balance_quiet` and `balance_high`.
    quiet_amplitude, high_amplitude : numpy.ndarray, shape (rows, columns)
        |a| of the quiet and of the high solution.
    quiet_growth : numpy.ndarray, shape (rows, columns)
        Growth rate of the slow flow at the quiet solution, per unit time T.
    quiet_start, high_start : numpy.ndarray, shape (rows, columns, 4)
        State Z1, Z1', Z2, Z2' of the quiet and of the high solution at T = 0. Without a high
        solution `high_start` is the state on the free resonance branch, with the loose mass at rest
        in the middle of the gap.
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
    """Solve the harmonic balance (7) in all cells of a map.

    The quiet limit is half the amplitude of the free resonance branch. The quiet solution is the
    solution with the smallest |a|, if this |a| is below the limit. The high solution is the stable
    solution with the largest |a|, if this |a| is not below the limit.

    Parameters
    ----------
    rows : list of tuple
        Oscillator, Damper and array of forcing frequencies of each row.

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
    """Return the harmonic balance in one cell, as `Cells` with one entry in place of each array."""
    free, phase = _resonance(oscillator, frequency)
    high_start = np.full(4, np.nan)
    if phase is not None:
        start = _start(free, 0.0, phase, frequency)
        # The loose mass is at rest in the middle of the gap: Z2 = 0 and Z2' = Z1'.
        high_start = np.array([start[0], start[1], 0.0, start[1]])
    nothing = np.nan, np.nan, np.full(4, np.nan)
    elastic = replace(damper, restitution=1.0)
    try:
        solutions, growth = _solutions(oscillator, elastic, frequency)
    except ArithmeticError:
        unresolved = flag("balance_quiet", "unresolved")
        return Cells(free, unresolved, *nothing, unresolved, np.nan, high_start)
    signs = stability(growth)
    amplitude = np.abs(solutions.amplitude)

    def start_at(k):
        return _start(*(values[k] for values in solutions), frequency)

    quiet = flag("balance_quiet", "none"), *nothing
    if len(amplitude) and np.min(amplitude) < HIGH * free:
        k = np.argmin(amplitude)
        verdict = {1: "stable", -1: "unstable", 0: "unresolved"}[int(signs[k])]
        quiet = flag("balance_quiet", verdict), amplitude[k], growth[k], start_at(k)
    high = flag("balance_high", "none"), np.nan, high_start
    large = np.flatnonzero((signs == flag("stability", "stable")) & (amplitude >= HIGH * free))
    if len(large):
        k = large[np.argmax(amplitude[large])]
        high = flag("balance_high", "stable"), amplitude[k], start_at(k)
    return Cells(free, *quiet, *high)


@lru_cache(4096)
def _solutions(oscillator, damper, frequency):
    """Return the solutions of (7) and their growth rates.

    The result is cached because cells that differ only in the restitution share it.
    """
    solutions = impacting_solutions(oscillator, damper, frequency)
    return solutions, growth_rate(fixed_points(solutions), oscillator, damper, frequency)


_resonance = lru_cache(4096)(resonance)


def _start(amplitude, relative_amplitude, phase, frequency):
    """Return Z1, Z1', Z2, Z2' at T = 0 of Z1 = a cos(W T + t1), Z2 = b cos(W T + t1)."""
    inline, across = np.cos(phase), -frequency * np.sin(phase)
    return np.array(
        [
            amplitude * inline,
            amplitude * across,
            relative_amplitude * inline,
            relative_amplitude * across,
        ]
    )
