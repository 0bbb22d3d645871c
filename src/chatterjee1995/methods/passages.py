"""Passages: random flights without walls whose largest |Z2| is known to rounding."""

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from chatterjee1995.methods.integrators.taylor import SERIES, all_steps, turning_points
from impact_damper.model.packed import CLEARANCE

# Tolerance of the Taylor series.
TOLERANCE = 1e-15


class Passage(NamedTuple):
    """A flight without walls over one forcing cycle from the state `state` at T = 0.

    `time`, `extremum` and `curvature` are the time at which |Z2| is largest, and |Z2| and |Z2''|
    there.
    """

    state: np.ndarray
    time: float
    extremum: float
    curvature: float


def without_walls(p):
    """Return a copy of the packed parameters with the walls infinitely far away."""
    flying = p.copy()
    flying[CLEARANCE] = math.inf
    return flying


def draw_passages(p, count, radius, deepest, seed) -> list:
    """Return `count` random passages over one forcing cycle.

    Initial states are uniform in a ball. A flight is a passage if |Z2| at both ends is at least
    `deepest` below its largest value, so that walls nearer by this are not touched there.
    """
    random = np.random.default_rng(seed)
    flying = without_walls(p)
    passages = []
    while len(passages) < count:
        direction = random.standard_normal(4)
        size = radius * random.random() ** 0.25
        state = size * direction / np.linalg.norm(direction)
        rows, end = all_steps(flying, state, 0.0, 1, TOLERANCE)
        series = rows[:, SERIES:].T.copy()
        # The loose mass flies at a constant velocity, so that Z2 - Z1 is linear in time.
        series[0] += state[2] - state[0] + (state[3] - state[1]) * rows[:, 0]
        series[1] += state[3] - state[1]
        step, within = turning_points(rows, series)
        turned = np.abs(polyval(within, series[:, step], tensor=False))
        largest = np.max(turned, initial=0.0)
        if largest > 2 * deepest and largest - max(abs(state[2]), abs(end[2])) > deepest:
            k = np.argmax(turned)
            bend = polyval(within[k], polyder(series[:, step[k]], 2))
            passages.append(Passage(state, rows[step[k], 0] + within[k], largest, abs(bend)))
    return passages
