"""Motions with their derivatives by the first state, as Taylor series of each step."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev

from impact_damper.kernel.equation import no_return
from impact_damper.kernel.single import (
    COLUMNS,
    CONTACT_ORDER,
    DQ,
    DX,
    FLIGHT_ORDER,
    Q,
    X,
    side_of,
    workspace,
)
from impact_damper.kernel.tangents import step_with_tangents
from impact_damper.model.packed import CLEARANCE
from impact_damper.motions.strobe_map import POLISH_TOLERANCE

# Number of points of a step, including its ends. In a step in contact the phase of the contact's
# oscillation grows by up to 3.5 radian, and the phase of a product of two such oscillations by up
# to 7 radian. With 21 points the error of integrals of such products is about 1e-13.
POINTS = 21
# Number of Newton corrections of the time of a turn (extremum).
CORRECTIONS = 4
# Number of coefficients of a Taylor series.
TERMS = max(FLIGHT_ORDER, CONTACT_ORDER) + 1
# _ON_CIRCLE: the Chebyshev points on [-1, 1], projections of points on a circle.
# _TO_SERIES: matrix that maps values at the points to coefficients of Chebyshev polynomials.
_ON_CIRCLE = -np.cos(np.pi * np.arange(POINTS) / (POINTS - 1))
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_ON_CIRCLE, POINTS - 1))
# PLACES: the points on a step of length 1.
# INTEGRALS: matrix that maps values at the points to the integrals from the beginning of the step
#     to each point.
PLACES = (_ON_CIRCLE + 1) / 2
INTEGRALS = chebyshev.chebval(_ON_CIRCLE, chebyshev.chebint(_TO_SERIES, lbnd=-1)).T / 2


@dataclass(frozen=True)
class Path:
    """A motion in m steps, each in flight or in contact, with its tangents.

    N = m POINTS is the number of points of all steps.

    p: Packed parameters; shape (packed.COUNT,).
    sides: Wall touched in each step, -1 or 1, or 0 in flight; shape (m,).
    begins, lengths: Times at which steps begin, and their lengths; shape (m,).
    series: Coefficients of the Taylor series, from the beginning of each step, of Z1 and Z2, and of
        their derivatives with respect to the four numbers of the first state; shape (m, TERMS, 2,
        5).
    """

    p: np.ndarray
    sides: np.ndarray
    begins: np.ndarray
    lengths: np.ndarray
    series: np.ndarray

    @cached_property
    def _values(self):
        """Z1, Z1', Z2, Z2' and their derivatives at the N points of all steps, shape (5, 4, N)."""
        powers = (self.lengths[:, None] * PLACES)[..., None] ** np.arange(TERMS)
        series = self.series.reshape(len(self.sides), TERMS, 10)
        slopes = np.arange(1, TERMS)[:, None] * series[:, 1:]
        values = np.stack([powers @ series, powers[..., :-1] @ slopes])
        return values.reshape(2, -1, 2, 5).transpose(3, 2, 0, 1).reshape(5, 4, -1)

    @property
    def states(self):
        """Z1, Z1', Z2, Z2' at the points of all steps, shape (4, N)."""
        return self._values[0]

    @cached_property
    def tangents(self):
        """Derivatives P of the states by the first state at all points, shape (4, 4, N)."""
        return np.ascontiguousarray(self._values[1:].swapaxes(0, 1))

    @property
    def matrix(self):
        """Derivative of the last state with respect to the first, shape (4, 4)."""
        return self.tangents[..., -1]

    @cached_property
    def times(self):
        """Times of all points, shape (N,)."""
        return (self.begins[:, None] + self.lengths[:, None] * PLACES).ravel()

    @cached_property
    def contacts(self):
        """Wall in contact (-1, 0 or 1) and signed penetration at all points, shape (N,) each."""
        walls = np.repeat(self.sides, POINTS)
        clearance = self.p[CLEARANCE] if walls.any() else 0.0
        return walls, np.where(walls, self.states[2] - walls * clearance, 0.0)

    @cached_property
    def events(self):
        """Beginnings and ends of contacts (events), three arrays with an entry for each event.

        They hold the index of the last of the N points before the event, the wall, and 1 for a
        beginning or -1 for an end.
        """
        change = np.abs(self.sides[1:]) - np.abs(self.sides[:-1])
        at = np.flatnonzero(change)
        return POINTS * (at + 1) - 1, (self.sides[1:] + self.sides[:-1])[at], change[at]

    def turns(self, moving):
        """Find the turns (extrema) of Z1 or of Z2, at which its velocity is zero."""
        speed = self.states[2 * moving + 1].reshape(-1, POINTS)
        steps, points = np.nonzero(speed[:, :-1] * speed[:, 1:] <= 0)
        before, after = speed[steps, points], speed[steps, points + 1]
        fraction = before / np.where(before == after, 1.0, before - after)
        lengths = self.lengths[steps]
        times = lengths * (PLACES[points] + fraction * (PLACES[points + 1] - PLACES[points]))
        series = self.series[steps, :, moving, 0]
        for _ in range(CORRECTIONS):
            slope, curve = (_derivative(series, times, order) for order in (1, 2))
            times = times - np.divide(slope, curve, out=np.zeros_like(slope), where=curve != 0)
        weights = chebyshev.chebvander(2 * times / lengths - 1, POINTS - 1) @ _TO_SERIES
        return steps, _derivative(series, times, 0), weights, self.begins[steps] + times


def _derivative(series, times, order):
    """Return a derivative of each of n series at its time, shape (n,); the value for order 0.

    `series` are coefficients, shape (n, terms), and `times` has the shape (n,).
    """
    for _ in range(order):
        series = series[:, 1:] * np.arange(1, series.shape[1])
    return np.sum(series * times[:, None] ** np.arange(series.shape[1]), axis=1)


def follow_path(p, state, begin, end) -> Path:
    """Return the path of a motion from one time to another."""
    y, tangents, work = np.array(state, float), np.eye(4), workspace()
    side, t, farthest = side_of(p, y), begin, no_return(p)
    sides, begins, lengths, series = [], [], [], []
    while t < end:
        before, first = side, np.vstack([y, tangents])
        length, side = step_with_tangents(p, y, tangents, side, t, end - t, POLISH_TOLERANCE, work)
        if not (abs(y[0]) <= farthest or y[0] * y[1] <= 0):
            raise ArithmeticError(f"the motion escapes at the time {t:g}")
        sides.append(before)
        begins.append(t)
        lengths.append(length)
        series.append(_series(p, work, before, first))
        t = end if length >= end - t else t + length
    return Path(p, *map(np.array, (sides, begins, lengths, series)))


def _series(p, work, side, first):
    """Return the series of a step, shape (TERMS, 2, 5).

    They come from the workspace of the integrator after the step, and from the state and tangents
    at the beginning of the step (`first`). `side` is the wall in contact.
    """
    series = np.zeros((TERMS, 2, 5))
    count = (FLIGHT_ORDER if side == 0 else CONTACT_ORDER) + 1
    series[:count, 0, 0] = work[X : X + count]
    series[:count, 0, 1:] = work[DX : DX + count * COLUMNS].reshape(count, COLUMNS)
    if side == 0:
        series[:, 1] = series[:, 0]
        series[0, 1] = first[:, 2]
        series[1, 1] = first[:, 3]
    else:
        series[:count, 1, 0] = work[Q : Q + count]
        series[0, 1, 0] += side * p[CLEARANCE]
        series[:count, 1, 1:] = work[DQ : DQ + count * COLUMNS].reshape(count, COLUMNS)
    return series
