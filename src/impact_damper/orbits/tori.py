"""Tori that branch off at Neimark-Sacker points: their stability and their rotation numbers.

A torus is a surface in the space of states that surrounds a periodic orbit; motions on it revolve
around the orbit. The rotation number is the mean number of revolutions in a period of the orbit. A
branch is the curve of the orbits over a parameter. At a Neimark-Sacker point of a branch a pair of
Floquet multipliers exp(+-i angle) crosses the unit circle. Let r be the amplitude of a motion close
to the orbit, in the plane of the eigenvectors of the pair. At the point, log r changes by
growth * r^2 in each period of the orbit. If the coefficient `growth` is negative, a stable torus
surrounds the unstable orbit, with the amplitude sqrt(-log |multiplier| / growth). If the
coefficient is positive, an unstable torus surrounds the stable orbit, and no stable torus branches
off (Yu. A. Kuznetsov, Elements of Applied Bifurcation Theory, section 4.7). A torus is also
unstable if another multiplier lies outside the unit circle.

The coefficient is measured on motions that begin close to the orbit. Then motions are run onto the
stable torus at two values of the parameter near the point, and their rotation numbers are
extrapolated to the point.

Z1 is the displacement of the primary mass and Z2 its displacement relative to the loose mass.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import FREQUENCY
from impact_damper.motions import traces
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.motions.undecided import birkhoff_average, find_rotation
from impact_damper.orbits.orbit import TURN, Orbit

# Measurement of the growth.
# AMPLITUDES: amplitudes of the motions.
# ITERATES: number of periods of each motion.
# AGREEMENT: largest relative difference between the results of two successive amplitudes.
# SEEN, LARGE: least and largest relative change of 1/r^2 during a motion. A smaller change is
#     hidden by rounding errors; with a larger one higher powers of r matter.
AMPLITUDES = tuple(10.0**-k for k in (2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6))
ITERATES = 400
AGREEMENT, SEEN, LARGE = 0.1, 3e-6, 0.5
# A multiplier lies on the unit circle if its modulus differs from 1 by at most ON_CIRCLE.
ON_CIRCLE = 1e-6
# Tori are searched for at orbits with log |multiplier| close to one of LEVELS, until two are found.
# CLOSE: largest relative error of log |multiplier|.
# STEPS: largest number of steps of the search for such an orbit.
LEVELS = tuple(0.01 * 0.5**k for k in range(4))
CLOSE, STEPS = 0.1, 4
# Largest distance of such an orbit from the point, in units of the parameter.
FARTHEST = 0.1
# Changes of the parameter in the difference quotient of log |multiplier|. A smaller one is used if
# log |multiplier| varies too fast.
NUDGES = (1e-7, 1e-9, 1e-11)
# APPROACH: a motion approaches the torus of a level for APPROACH / level periods.
# BLOCKS: then it runs for these numbers of periods, one after the other, until the rotation number
#     is known.
APPROACH, BLOCKS = 8.0, (1000, 3000)
# Largest number of forcing cycles of the approach.
MOST_PERIODS = 30_000


class Torus(NamedTuple):
    """The torus that branches off from an orbit at a Neimark-Sacker point.

    Attributes
    ----------
    kind : str
        stable; unstable if no stable torus branches off; of_unstable_orbit if another multiplier
        lies outside the unit circle; or unknown if the growth is not found, mostly near a grazing.
    angle : float
        Angle of the multiplier, revolutions, from 0 to 1/2.
    growth : float
        Coefficient `growth` of the module docstring, with the amplitude r measured in complex
        eigenvectors of length 1. NaN if not found.
    value : float
        Value of the parameter at which a motion was run onto a stable torus; of two such values the
        one closer to the point. NaN without two such tori.
    number : float
        Rotation number of this torus, revolutions per period of the orbit, from 0 to 1/2.
    error : float
        Error of the rotation number (`rotation_numbers.Rotation.error`).
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
    """Return the `Torus` that branches off at a Neimark-Sacker point.

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
    tori = []
    for level in LEVELS:
        if orbit.periods * APPROACH / level > MOST_PERIODS:
            continue
        beyond = _beyond(point, level)
        rotation = None if beyond is None else _rotation(beyond.orbit, level, growth)
        if rotation is not None:
            tori.append((beyond.value, rotation))
        if len(tori) == 2:
            break
    else:
        return Torus("stable", angle, growth)
    (far, first), (value, second) = tori
    slope = (first.number - second.number) / (far - value)
    limit = second.number - slope * (value - point.value)
    return Torus("stable", angle, growth, value, second.number, second.error, limit)


class _Pair(NamedTuple):
    """A complex multiplier with its eigenvectors, normalised such that left @ right = 1."""

    multiplier: complex
    right: np.ndarray
    left: np.ndarray


def _pair(orbit: Orbit):
    """Return the complex pair of an orbit that is nearest to the unit circle, or None."""
    if not np.all(np.isfinite(orbit.monodromy)):
        return None
    values, vectors = np.linalg.eig(orbit.monodromy)
    complex_ones = np.flatnonzero(values.imag > 0)
    if len(complex_ones) == 0:
        return None
    k = min(complex_ones, key=lambda i: abs(abs(values[i]) - 1))
    return _Pair(values[k], vectors[:, k], np.linalg.inv(vectors)[k])


def amplitude_growth(orbit) -> float:
    """Return the coefficient `growth` of an orbit at a Neimark-Sacker point; NaN if not found.

    With a pair on the unit circle 1/r^2 decreases by 2 * growth in each period. The coefficient
    follows from weighted averages of 1/r^2 over both halves of a motion. Averages are used because
    r also varies within each revolution.
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
    """Return the states, shape (count, 4), of a motion after each of `count` periods."""
    begin = orbit.phase / orbit.p[FREQUENCY]
    times = begin + orbit.periods * TURN / orbit.p[FREQUENCY] * np.arange(1, count + 1)
    states = np.empty((count, 4))
    traces.trace(orbit.p, state, begin, times, POLISH_TOLERANCE, states, np.empty((0, 5)))
    return states


def _beyond(point, level):
    """Return a point of the branch with log |multiplier| close to a level, or None.

    `point` is the Neimark-Sacker point.
    """
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
    """Return the point of the branch at a value of the parameter, or None."""
    return point.problem.at_value(point, value)


def _logarithm(point):
    """Return log |multiplier| of the complex pair at a point; infinity if there is no pair."""
    pair = None if point is None else _pair(point.orbit)
    return math.inf if pair is None else math.log(abs(pair.multiplier))


def _rotation(orbit, level, growth):
    """Return the `Rotation` on the torus around an unstable orbit, or None if there is no torus.

    As in `motions.undecided`, the rotation number is searched for in the planes of (Z1, Z1') and of
    (Z2, Z2').
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
        rotations = [find_rotation(points) for points in planes] if finite else []
        rotations = [rotation for rotation in rotations if rotation is not None]
        if not rotations:
            return None
        best = min(rotations, key=lambda rotation: rotation.error)
        if best.known:
            return best
    return None
