"""Tori behind Neimark-Sacker points: stable or not, and how a motion on them turns.

At a Neimark-Sacker point a pair of multipliers exp(+-i angle) leaves the unit circle. Close to the
orbit the logarithm of the amplitude r in the plane of the pair changes by growth r^2 a period. If
the growth is negative, the orbit is surrounded, where it is unstable, by a stable torus of the
amplitude sqrt(-log |multiplier| / growth). If it is positive, an unstable torus surrounds the
stable orbit, and no stable torus splits off (Yu. A. Kuznetsov, Elements of Applied Bifurcation
Theory, section 4.7). A torus is unstable too if another multiplier lies outside the unit circle.

The growth is measured on motions that begin close to the orbit; then stable tori are run onto, at
two distances from the point, and their rotation numbers are extrapolated to the point.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.motions import records
from impact_damper.motions.rotation_numbers import birkhoff_average, find_rotation
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.orbits.orbit import TURN, Orbit
from impact_damper.system.packed import FREQUENCY

# Amplitudes of the motions that measure the growth, and their iterates. Two amplitudes must agree
# to AGREEMENT, and 1/r^2 must change by a share between SEEN, which is more than rounding, and
# LARGE.
AMPLITUDES = tuple(10.0**-k for k in (2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6))
ITERATES = 400
AGREEMENT, SEEN, LARGE = 0.1, 3e-6, 0.5
# Largest |multiplier| - 1 of a pair on the unit circle.
ON_CIRCLE = 1e-6
# Tori are looked for where log |multiplier| of the orbit is close to these, until two are found.
LEVELS = tuple(0.01 * 0.5**k for k in range(4))
CLOSE, STEPS = 0.1, 4
# Largest distance of such an orbit from the point, in units of the parameter.
FARTHEST = 0.1
# Changes of the parameter from which the derivative of log |multiplier| is taken.
NUDGES = (1e-7, 1e-9, 1e-11)
# Iterates over which a motion approaches a torus, times the level, and iterates after that, one
# block after the other, until the rotation number is known.
APPROACH, BLOCKS = 8.0, (1000, 3000)
# Most forcing periods of the approach.
MOST_PERIODS = 30_000


class Torus(NamedTuple):
    """What splits off from an orbit at a Neimark-Sacker point.

    Attributes
    ----------
    kind : str
        stable, unstable (no stable torus splits off), of_unstable_orbit (another multiplier lies
        outside the unit circle) or unknown (the growth is not found, mostly next to a grazing).
    angle : float
        Angle of the multiplier, revolutions, from 0 to 1/2.
    growth : float
        Change of the logarithm of the amplitude in a period of the orbit over the square of the
        amplitude; the complex eigenvector of the amplitude 1 has the length 1. NaN if not found.
    value : float
        Parameter at which a stable torus was run onto, the closer one of two; NaN without them.
    number : float
        Its rotation number, revolutions per period of the orbit, from 0 to 1/2.
    error : float
        Of the rotation number, as in `rotation_numbers.Rotation`.
    limit : float
        Rotation number extrapolated to the Neimark-Sacker point.
    """

    kind: str
    angle: float = math.nan
    growth: float = math.nan
    value: float = math.nan
    number: float = math.nan
    error: float = math.nan
    limit: float = math.nan


def torus_behind(point) -> Torus:
    """Return what splits off at a Neimark-Sacker point.

    Parameters
    ----------
    point : continuation.Point
        Point of a branch of orbits of a damped system, at the bifurcation.
    """
    orbit = point.orbit
    away = np.abs(np.abs(orbit.multipliers) - 1)
    angle = abs(np.angle(orbit.multipliers[np.argmin(away)])) / TURN
    if np.max(np.abs(orbit.multipliers)) > 1 + ON_CIRCLE:
        return Torus("of_unstable_orbit", angle)
    growth = amplitude_growth(orbit) if np.min(away) < ON_CIRCLE else math.nan
    if not growth < 0:
        return Torus("unstable" if growth > 0 else "unknown", angle, growth)
    found = []
    for level in LEVELS:
        if orbit.periods * APPROACH / level > MOST_PERIODS:
            continue
        beyond = _beyond(point, level)
        rotation = None if beyond is None else _rotation(beyond.orbit, level, growth)
        if rotation is not None:
            found.append((beyond.value, rotation))
        if len(found) == 2:
            break
    else:
        return Torus("stable", angle, growth)
    (far, first), (value, second) = found
    slope = (first.number - second.number) / (far - value)
    limit = second.number - slope * (value - point.value)
    return Torus("stable", angle, growth, value, second.number, second.error, limit)


class _Pair(NamedTuple):
    """A complex multiplier with its eigenvectors; `left` times `right` is 1."""

    multiplier: complex
    right: np.ndarray
    left: np.ndarray


def _pair(orbit: Orbit):
    """Return the `_Pair` of an orbit that is nearest to the unit circle, or None."""
    if not np.all(np.isfinite(orbit.monodromy)):
        return None
    values, vectors = np.linalg.eig(orbit.monodromy)
    complex_ones = np.flatnonzero(values.imag > 0)
    if len(complex_ones) == 0:
        return None
    k = min(complex_ones, key=lambda i: abs(abs(values[i]) - 1))
    return _Pair(values[k], vectors[:, k], np.linalg.inv(vectors)[k])


def amplitude_growth(orbit) -> float:
    """Return the growth of an orbit at a Neimark-Sacker point, NaN if it is not found.

    On the unit circle 1/r^2 falls by twice the growth in each period. The averages over both halves
    of a motion are free of the change of r within a revolution.
    """
    pair, last = _pair(orbit), math.nan
    if pair is None:
        return math.nan
    for amplitude in AMPLITUDES:
        states = _iterates(orbit, orbit.state + amplitude * pair.right.real, ITERATES)
        inverse = 1 / np.abs(2 * (states - orbit.state) @ pair.left) ** 2
        first, second = (birkhoff_average(half) for half in np.split(inverse, 2))
        growth, change = (first - second) / ITERATES, abs(1 - second / first)
        if SEEN < change < LARGE and abs(growth - last) < AGREEMENT * abs(growth):
            return float(growth)
        last = growth if SEEN < change < LARGE else math.nan
    return math.nan


def _iterates(orbit, state, count):
    """Return the states, shape (count, 4), after each of the next periods of an orbit."""
    begin = orbit.phase / orbit.p[FREQUENCY]
    times = begin + orbit.periods * TURN / orbit.p[FREQUENCY] * np.arange(1, count + 1)
    states = np.empty((count, 4))
    records.trace(orbit.p, state, begin, times, POLISH_TOLERANCE, states, np.empty((0, 5)))
    return states


def _beyond(point, level):
    """Return the point of the branch at which log |multiplier| is close to a level, or None."""
    for nudge in NUDGES:
        sides = [_logarithm(_at(point, point.value + step)) for step in (nudge, -nudge)]
        if max(map(abs, sides)) < level:
            break
    else:
        return None
    slope = (sides[0] - sides[1]) / (2 * nudge)
    if abs(slope) * FARTHEST < level:
        return None
    change = level / slope
    for _ in range(STEPS):
        beyond = _at(point, point.value + change)
        ratio = _logarithm(beyond) / level
        if abs(ratio - 1) < CLOSE:
            return beyond
        if not 0.2 < ratio < 5 or abs(change) > ratio * FARTHEST:
            return None
        change /= ratio
    return None


def _at(point, value):
    """Return the point of the branch at a value, or None."""
    return point.problem.at_value(point, value)


def _logarithm(point):
    """Return log |multiplier| of the pair at a point, infinite if there is none."""
    pair = None if point is None else _pair(point.orbit)
    return math.inf if pair is None else math.log(abs(pair.multiplier))


def _rotation(orbit, level, growth):
    """Return the `Rotation` on the torus around an unstable orbit, None if the motion is on none.

    The two planes are those of `undecided`.
    """
    start = orbit.state + math.sqrt(level / -growth) * _pair(orbit).right.real
    state = _iterates(orbit, start, int(APPROACH / level))[-1]
    for count in BLOCKS:
        if not np.all(np.isfinite(state)):
            return None
        states = _iterates(orbit, state.copy(), count)
        state = states[-1]
        planes = [states[:, k] + 1j * states[:, k + 1] / orbit.p[FREQUENCY] for k in (0, 2)]
        finite = np.all(np.isfinite(state))
        found = [find_rotation(points) for points in planes] if finite else []
        found = [rotation for rotation in found if rotation is not None]
        if not found:
            return None
        best = min(found, key=lambda rotation: rotation.error)
        if best.known:
            return best
    return None
