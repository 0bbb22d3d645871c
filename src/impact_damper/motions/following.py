"""Follow an orbit from one value of a parameter to another, by prediction and correction.

Following stops at folds of the branch; `orbits.continuation` passes them.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from impact_damper.motions.records import measured
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, polish, repeats_sooner

# Factor by which a step grows after success.
GROWTH = 1.5
# Largest correction of a predicted state (REACH) and of the first (NUDGE) within the same orbit.
REACH, NUDGE = 0.03, 1e-3
# Shortest step of the parameter, which is the accuracy of the end of a branch.
RESOLUTION = 1e-8


class Followed(NamedTuple):
    """Last two parameter values and orbits, last status, and whether the target is reached."""

    values: tuple[float, float]
    orbits: tuple
    status: str
    arrived: bool

    @property
    def orbit(self):
        """The last orbit."""
        return self.orbits[1]


class StrobeOrbit(NamedTuple):
    """State of an orbit at the strobe, shape (4,), and its dominant Floquet multiplier."""

    state: np.ndarray
    multiplier: complex


def follow(
    correct: Callable,
    start,
    target,
    orbit,
    *,
    shortest,
    growth=GROWTH,
    reach=math.inf,
    extrapolating=True,
    behind=None,
) -> Followed:
    """Follow an orbit from one value of a parameter to another, or as far as possible.

    `correct` takes a value and a predicted state (4,). It returns an orbit (None on failure) and a
    status. The first step leads to `target`. After success a step is multiplied by `growth`. A step
    is halved if the correction fails, or if Z1, Z1' or Z2 changes by `reach` or more: the new orbit
    may lie on another branch. `behind` is the orbit at the value 2 start - target, or None.
    """
    value, step, status = start, target - start, ""
    before, last_step = (start, orbit), target - start
    while value != target:
        if abs(step) > abs(target - value):
            step = target - value
        ahead = target if step == target - value else value + step
        state = orbit.state.copy()
        if extrapolating and behind is not None:
            state += (state - behind.state) * (step / last_step)
        corrected, status = correct(ahead, state)
        if corrected is not None and np.max(np.abs(corrected.state - orbit.state)[:3]) < reach:
            before, behind, last_step = (value, orbit), orbit, step
            value, orbit = ahead, corrected
            step *= growth
        else:
            step /= 2
            if abs(step) < shortest:
                break
    return Followed((before[0], value), (before[1], orbit), status, value == target)


def follow_stable(p, state, periods, parameter, target) -> tuple:
    """Follow a stable orbit while the packed parameter number `parameter` changes to `target`.

    Following stops where the orbit becomes unstable or repeats after fewer cycles. Return the
    packed parameters and the last `StrobeOrbit`. After success the parameter is exactly `target`.
    The multiplier is NaN if there is no orbit near the given state.
    """
    # A period in a record is a two-byte integer, for which numba would compile the kernels again.
    periods = int(periods)
    p, first = p.copy(), np.array(state, float)
    _, _, multiplier = polish(p, first, periods, NUDGE, POLISH_TOLERANCE)

    def correct(value, guess):
        p[parameter] = value
        converged, _, multiplier = polish(p, guess, periods, REACH, POLISH_TOLERANCE)
        if not converged:
            return None, "not_converged"
        if not abs(multiplier) < 1:
            return None, "unstable"
        if repeats_sooner(p, guess, periods, POLISH_TOLERANCE):
            return None, "repeats_sooner"
        return StrobeOrbit(guess, multiplier), "found"

    start = float(p[parameter])
    orbit = StrobeOrbit(first, multiplier)
    followed = follow(correct, start, target, orbit, shortest=RESOLUTION, reach=2 * REACH)
    p[parameter] = followed.values[1]
    return p, followed.orbit


def record_at(p, state, periods, parameter, value, tolerance=POLISH_TOLERANCE):
    """Follow an orbit to a value; return its record there, or None if following stops before."""
    p, orbit = follow_stable(p, state, periods, parameter, value)
    return measured(p, orbit.state, periods, tolerance) if p[parameter] == value else None
