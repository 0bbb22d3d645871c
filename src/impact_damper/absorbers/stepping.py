"""Motions of many problems side by side, with fixed steps of the Runge-Kutta method of order 8.

The coefficients are those of SciPy's DOP853 (Hairer, Norsett and Wanner, Solving Ordinary
Differential Equations I, 1993). Steps are a share of the forcing period and short against the
fastest vibration, so that no step has to be rejected. Problems are run in blocks that fit the
processor's cache, each with its own number of steps.
"""

import numpy as np
from scipy.integrate import DOP853

from impact_damper.absorbers.problems import rate, secants, slopes

# Longest step in radian of the fastest vibration: COARSE for the way to an orbit, FINE on it.
COARSE, FINE = 0.7, 0.25
# Problems run side by side.
BLOCK = 512
STAGES = [
    (float(c), [(j, float(a)) for j, a in enumerate(row) if a])
    for c, row in zip(DOP853.C, DOP853.A, strict=True)
]
WEIGHTS = [(j, float(b)) for j, b in enumerate(DOP853.B) if b]


def steps_for(problems, largest, longest):
    """Return the number of steps in a forcing period for each problem: a power of 2 of 3, 4.

    Parameters
    ----------
    problems : Problems
    largest : numpy.ndarray, shape (2, n) or (1, n)
        Largest displacements expected of the machine and of the absorber.
    longest : float
        Longest step in radian of the fastest vibration.
    """
    cubic = np.maximum(problems.cubic, 0)
    fastest = problems.stiffness + 3 * cubic * largest[0] ** 2
    if problems.link is not None:
        mass, stiffness, _, third = problems.link
        tuned = stiffness + 3 * np.maximum(third, 0) * largest[1] ** 2
        fastest = fastest + tuned * (1 + 1 / mass)
    ratio = np.maximum(np.sqrt(fastest) / problems.frequency, 1.0)
    least = np.maximum(2 * np.pi * ratio / longest, 8)
    return (2.0 ** (np.ceil(2 * np.log2(least)) / 2)).astype(int)


def blocks(steps):
    """Yield numbers of steps with indices of at most BLOCK problems that have them."""
    for count in np.unique(steps):
        chosen = np.flatnonzero(steps == count)
        for first in range(0, len(chosen), BLOCK):
            yield int(count), chosen[first : first + BLOCK]


def step(problems, state, variation, phase, h):
    """Return state and variation after a step.

    Parameters
    ----------
    problems : Problems
    state : numpy.ndarray, shape (size, n)
    variation : numpy.ndarray, shape (size, columns, n), or None
        Disturbances of the state.
    phase, h : float
        W T at the beginning, and step, both in forcing periods.
    """
    length = 2 * np.pi * h / problems.frequency
    rates, changes = [], []
    for c, row in STAGES:
        here = _combined(state, rates, row, length)
        force = problems.force * np.cos(2 * np.pi * (phase + c * h))
        rates.append(rate(problems, secants(problems, here), force, here))
        if variation is not None:
            beside = _combined(variation, changes, row, length)
            changes.append(rate(problems, slopes(problems, here), 0.0, beside))
    after = _combined(state, rates, WEIGHTS, length)
    if variation is not None:
        variation = _combined(variation, changes, WEIGHTS, length)
    return after, variation


def _combined(start, rates, row, length):
    if not row:
        return start
    total = row[0][1] * rates[row[0][0]]
    for j, weight in row[1:]:
        total += weight * rates[j]
    total *= length
    total += start
    return total
