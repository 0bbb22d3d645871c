"""Passages near a wall: free flights whose largest |Z2| is known, where the wall is then put.

A wall a little nearer than the largest |Z2| is touched once, for a short time; one a little
further away is not touched. Both are hard to tell apart for a method that looks at the ends of
its steps.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.instances import FLIGHT_ORDER
from impact_damper.kernel.single import X, polynomial, step, workspace
from impact_damper.system.packed import CLEARANCE, FREQUENCY

PIECES = 16
TOLERANCE = 1e-15


class Passage(NamedTuple):
    """A free flight over one forcing period from T = 0.

    Attributes
    ----------
    state : numpy.ndarray, shape (4,)
        Z1, Z1', Z2, Z2' at T = 0.
    time, extremum, curvature : float
        When |Z2| is largest, the largest |Z2|, and |Z2''| there.
    """

    state: np.ndarray
    time: float
    extremum: float
    curvature: float


@kernel
def largest_of_flight(p, y, t, end):
    """Time, value and second derivative of the largest |Z2| of a flight within (t, end).

    Signs of Z2' bracket the extrema in each of `PIECES` parts of a step of the Taylor series;
    bisection of Z2' finds them to rounding. y is left at the end. The value is that at the ends,
    and the second derivative 0, where no extremum exceeds them.
    """
    work = workspace()
    none = np.empty((0, 4))
    flight = np.int64(0)  # a literal would have the step compiled for it alone
    c = np.zeros(FLIGHT_ORDER + 1)
    at, largest, bend = t, abs(y[2]), 0.0
    while t < end:
        offset, drift = y[2] - y[0], y[3] - y[1]
        length, _ = step(p, y, none, flight, t, end - t, TOLERANCE, work)
        # one by one: to assign arrays compiles the message for unlike shapes too, for 2 s
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


def free_flight(p):
    """The packed parameters without walls."""
    free = p.copy()
    free[CLEARANCE] = math.inf
    return free


def draw_passages(p, count, radius, deepest, seed):
    """Random passages over one forcing period, and how many were drawn to find them.

    States are uniform in a ball. Kept are flights that begin and end at least `deepest` below
    their largest |Z2|, so that it is an extremum and a wall `deepest` nearer is not yet passed.

    Parameters
    ----------
    p : numpy.ndarray, shape (packed.COUNT,)
        Packed parameters; only those of the oscillator count.
    count : int
    radius, deepest : float
    seed : int

    Returns
    -------
    list of Passage, int
    """
    random = np.random.default_rng(seed)
    free = free_flight(p)
    passages, drawn = [], 0
    while len(passages) < count:
        drawn += 1
        direction = random.standard_normal(4)
        size = radius * random.random() ** 0.25
        state = size * direction / np.linalg.norm(direction)
        y = state.copy()
        found = largest_of_flight(free, y, 0.0, 2 * math.pi / p[FREQUENCY])
        if found[1] - max(abs(state[2]), abs(y[2])) > deepest and found[1] > 2 * deepest:
            passages.append(Passage(state, *found))
    return passages, drawn
