"""Passages: random motions without walls, whose largest |Z2| is exact except for rounding."""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.instances import FLIGHT_ORDER
from impact_damper.kernel.single import X, polynomial, step, workspace
from impact_damper.model.packed import CLEARANCE, FREQUENCY

PIECES = 16  # number of parts of a step; at most one extremum of Z2 is found in a part
TOLERANCE = 1e-15  # tolerance of the Taylor series


class Passage(NamedTuple):
    """A motion without walls over a cycle. At `time` |Z2| is largest, and |Z2''| is `curvature`."""

    state: np.ndarray
    time: float
    extremum: float
    curvature: float


@kernel
def largest_of_flight(p, y, t, end):
    """Integrate y in place from t to `end`. Return T, |Z2| and |Z2''| where |Z2| is largest."""
    work = workspace()
    flight = np.int64(0)  # not the literal 0, for which numba would compile `step` again
    c = np.zeros(FLIGHT_ORDER + 1)
    at, largest, bend = t, abs(y[2]), 0.0
    while t < end:
        offset, drift = y[2] - y[0], y[3] - y[1]
        length, _ = step(p, y, flight, t, end - t, TOLERANCE, work)
        # The assignment of a whole array would take 2 s longer to compile.
        for k in range(FLIGHT_ORDER + 1):
            c[k] = work[X + k]
        c[0] += offset
        c[1] += drift
        for i in range(PIECES):
            low, high = length * i / PIECES, length * (i + 1) / PIECES
            left, right = polynomial(c, FLIGHT_ORDER, low)[1], polynomial(c, FLIGHT_ORDER, high)[1]
            if left * right > 0.0:
                continue
            for _ in range(60):
                middle = 0.5 * (low + high)
                if left * polynomial(c, FLIGHT_ORDER, middle)[1] > 0.0:
                    low = middle
                else:
                    high = middle
            value = abs(polynomial(c, FLIGHT_ORDER, low)[0])
            if value > largest:
                at, largest, bend = t + low, value, 0.0
                for k in range(FLIGHT_ORDER, 1, -1):
                    bend = bend * low + k * (k - 1) * c[k]
        t = end if length >= end - t else t + length
    if abs(y[2]) > largest:
        return t, abs(y[2]), 0.0
    return at, largest, abs(bend)


def without_walls(p):
    """Return a copy of the packed parameters with the walls infinitely far away."""
    flying = p.copy()
    flying[CLEARANCE] = math.inf
    return flying


def draw_passages(p, count, radius, deepest, seed) -> list:
    """Return `count` passages from random states in a ball of the given radius.

    With walls at |Z2| = d, where d = max |Z2| - `deepest`, contacts would be up to `deepest` deep.
    Each passage begins and ends between such walls, and d exceeds `deepest`.
    """
    random = np.random.default_rng(seed)
    flying = without_walls(p)
    passages = []
    while len(passages) < count:
        direction = random.standard_normal(4)
        size = radius * random.random() ** 0.25
        state = size * direction / np.linalg.norm(direction)
        y = state.copy()
        time, extremum, bend = largest_of_flight(flying, y, 0.0, 2 * math.pi / p[FREQUENCY])
        if extremum - max(abs(state[2]), abs(y[2])) > deepest and extremum > 2 * deepest:
            passages.append(Passage(state, time, extremum, bend))
    return passages
