"""Find the largest displacement within a band, also between the frequencies of a grid."""

import numpy as np
from scipy.optimize import minimize_scalar

from impact_damper.design.absorber_orbits import find_orbits
from impact_damper.design.absorber_problems import problems_of
from impact_damper.design.absorber_seeds import harmonic_seeds
from impact_damper.design.linear_response import response
from impact_damper.design.smooth_runs import FORCE

# A peak of the grid of frequencies is refined: POINTS frequencies divide the interval between its
# two neighbours on the grid, and the interval is narrowed ROUNDS times. At a fold the peak is the
# last stable orbit before the fold. Peaks below LOWER times the highest peak are not refined.
POINTS = 9
ROUNDS = 4
LOWER = 0.7


def linear_peak(machine, absorber, frequencies):
    """Return frequency (Hz) and height (m) of the highest peak of a linear response in a band.

    Parameters
    ----------
    machine : Machine
    absorber : TunedAbsorber or None
    frequencies : numpy.ndarray
        Grid of the band, Hz.
    """
    sizes = response(machine, absorber, frequencies)
    low, high = _beside(frequencies, np.argmax(sizes))
    best = minimize_scalar(
        lambda hertz: -response(machine, absorber, hertz),
        bounds=(low, high),
        method="bounded",
        options={"xatol": 1e-9 * high},
    )
    if -best.fun > sizes.max():
        return best.x, -best.fun
    return frequencies[np.argmax(sizes)], sizes.max()


def orbit_peaks(machine, absorber, frequencies, shares, orbits):
    """Return frequency (Hz) and height of the highest stable orbit in a band, for each force share.

    A force share is a factor of the machine's excitation.

    Parameters
    ----------
    machine : Machine
    absorber : TunedAbsorber or None
    frequencies, shares : numpy.ndarray
        Grid of frequencies in Hz, and force shares.
    orbits : Orbits
        Stable orbits on the grid, from `search.search`.

    Returns
    -------
    frequency, height : numpy.ndarray, shape (number of shares,)
        The height is dimensionless, in the scale of the machine. Both are NaN where there is no
        stable orbit of period 1.
    """
    grid = np.full((len(frequencies), len(shares)), -1)
    for place in np.argsort(orbits.largest[:, 0], kind="stable"):
        if orbits.period[place] == 1:
            grid[np.unravel_index(orbits.problem[place], grid.shape)] = place
    heights = np.full(grid.shape, -np.inf)
    heights[grid >= 0] = orbits.largest[grid[grid >= 0], 0]
    places, columns = _grid_peaks(heights)
    highest = np.full((2, len(shares)), np.nan)
    refined = _refined(
        machine, absorber, frequencies, places, shares[columns], orbits.take(grid[places, columns])
    )
    for column, *peak in sorted(zip(columns, *refined, strict=True), key=lambda each: each[2]):
        highest[:, column] = peak
    return tuple(highest)


def _grid_peaks(heights):
    """Return the rows and columns of the local maxima along columns, without low ones (LOWER)."""
    around = np.pad(heights, ((1, 1), (0, 0)), constant_values=-np.inf)
    top = (heights >= around[:-2]) & (heights >= around[2:])
    return np.nonzero(top & np.isfinite(heights) & (heights >= LOWER * heights.max(axis=0)))


def _beside(frequencies, places):
    """Return the grid frequencies before and after places; at an end of the grid, the end."""
    last = len(frequencies) - 1
    return frequencies[np.maximum(places - 1, 0)], frequencies[np.minimum(places + 1, last)]


def _refined(machine, absorber, frequencies, places, shares, orbits):
    """Return frequencies and heights of the highest orbits near the given orbits of the grid."""
    first, last = low, high = _beside(frequencies, places)
    frequency, height, state = frequencies[places], orbits.largest[:, 0].copy(), orbits.state.copy()
    for _ in range(ROUNDS if len(places) else 0):
        tried = np.linspace(low, high, POINTS)
        problems = problems_of(machine, absorber, tried.ravel(), [1.0])
        problems[:, FORCE] *= np.tile(shares, POINTS)
        index, guesses = harmonic_seeds(problems)
        index = np.concatenate([index, np.arange(len(problems))])
        better = find_orbits(
            problems, index, np.concatenate([guesses, np.tile(state, (POINTS, 1))])
        )
        better = better.take(better.stable)
        for each in np.argsort(better.largest[:, 0], kind="stable"):
            point, peak = divmod(better.problem[each], len(places))
            if better.largest[each, 0] > height[peak]:
                height[peak], state[peak] = better.largest[each, 0], better.state[each]
                frequency[peak] = tried[point, peak]
        half = (high - low) / (POINTS - 1)
        low, high = np.maximum(frequency - half, first), np.minimum(frequency + half, last)
    return frequency, height
