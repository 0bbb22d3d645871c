"""Values and extrema of real Fourier series, and the intervals in which a series exceeds a level.

`harmonics` is an ascending array of positive integers k, and `coefficients` holds a number c_k for
each k. The series is z(s) = sum over k of c_k exp(i k s) + conj(c_k) exp(-i k s).
"""

import numpy as np
from scipy.fft import next_fast_len
from scipy.optimize import brentq

SHORTEST = 1e-9  # smallest width of an interval that the search for crossings halves, in radian


def samples(coefficients, harmonics, count) -> np.ndarray:
    """Return values of a series at `count` equally spaced s in one period, the first at s = 0."""
    spectrum = np.zeros(count // 2 + 1, complex)
    spectrum[harmonics] = coefficients
    return np.fft.irfft(spectrum, count) * count


def value(coefficients, harmonics, angle, order=0) -> np.ndarray:
    """Return a series, or its derivative of the given order, at each angle s."""
    weights = 2 * (1j * harmonics) ** order * coefficients
    return (np.exp(1j * np.multiply.outer(angle, harmonics)) @ weights).real


def product_samples(harmonics, degree) -> int:
    """Return how many samples give exact Fourier coefficients of a product of `degree` series."""
    return next_fast_len((degree + 1) * int(harmonics[-1]) + 1, real=True)


def largest(coefficients, harmonics) -> float:
    """Return the largest absolute value of a series, by Newton's method from its samples."""
    count = next_fast_len(16 * int(harmonics[-1]) + 64)
    size = np.abs(samples(coefficients, harmonics, count))
    top = np.flatnonzero((size >= np.roll(size, 1)) & (size >= np.roll(size, -1)))
    angle = 2 * np.pi / count * top[size[top] > 0.9 * np.max(size)]
    for _ in range(6):
        slope, bend = (value(coefficients, harmonics, angle, order) for order in (1, 2))
        angle = angle - np.clip(slope / np.where(bend == 0, 1, bend), -np.pi / count, np.pi / count)
    return float(max(np.max(size), np.max(np.abs(value(coefficients, harmonics, angle)))))


def intervals(coefficients, harmonics, level) -> np.ndarray:
    """Return a row (wall, begin, end) for each interval in which a series z has |z| > level.

    `wall` is 1 if z > level, and -1 if z < -level. The search uses a bound on z'', and misses no
    interval wider than SHORTEST.
    """
    return np.concatenate([_beyond(coefficients, harmonics, level, wall) for wall in (1, -1)])


def _beyond(coefficients, harmonics, level, wall):

    def penetration(angle):
        return wall * value(coefficients, harmonics, angle) - level

    count = next_fast_len(16 * int(harmonics[-1]) + 16)
    ends = np.linspace(0, 2 * np.pi, count + 1)
    q = wall * samples(coefficients, harmonics, count) - level
    cells = _cells(penetration, coefficients, harmonics, ends, np.append(q, q[0]))
    if not len(cells):
        return np.empty((0, 3))
    roots = np.array([brentq(penetration, *cell, xtol=1e-15, rtol=1e-15) for cell in cells])
    entering = penetration(cells[:, 0]) <= 0
    begin, end = roots[entering], roots[~entering]
    if end[0] < begin[0]:
        end = np.append(end[1:], end[0] + 2 * np.pi)
    return np.stack([np.full(len(begin), wall), begin, end], axis=-1)


def _cells(function, coefficients, harmonics, ends, values):
    bound = 2 * np.sum(harmonics**2 * np.abs(coefficients))
    lower, upper, first, last = ends[:-1], ends[1:], values[:-1], values[1:]
    crossed = []
    while len(lower):
        bend = bound * (upper - lower) ** 2 / 2
        crossing = (first > 0) != (last > 0)
        single = crossing & ((np.abs(last - first) > bend) | (upper - lower < SHORTEST))
        clear = np.minimum(np.abs(first), np.abs(last)) > bend / 4
        unclear = ~np.where(crossing, single, clear | (upper - lower < SHORTEST))
        crossed.append(np.stack([lower[single], upper[single]]))
        lower, upper, first, last = (each[unclear] for each in (lower, upper, first, last))
        middle = (lower + upper) / 2
        between = function(middle)
        lower, upper = np.concatenate([lower, middle]), np.concatenate([middle, upper])
        first, last = np.concatenate([first, between]), np.concatenate([between, last])
    cells = np.concatenate(crossed, axis=1).T
    return cells[np.argsort(cells[:, 0])]


def indicator(rows, orders) -> np.ndarray:
    """Return Fourier coefficients of the indicator function of the intervals `rows`."""
    _, begin, end = rows.T[:, :, None]
    half = (end - begin) / 2
    turn = np.exp(-0.5j * orders * (begin + end))
    return np.sum(turn * half / np.pi * np.sinc(orders * half / np.pi), axis=0)
