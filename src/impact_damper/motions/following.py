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
# Largest corrections that stay on an orbit. REACH: of predicted states. NUDGE: of the first state.
REACH, NUDGE = 0.03, 1e-3
# Shortest step of the parameter. The end of a branch is found with this accuracy.
RESOLUTION = 1e-8


class Followed(NamedTuple):
    """The last two parameter values, their orbits, last status, and if the target is reached."""

    values: tuple[float, float]
    orbits: tuple
    status: str
    arrived: bool

    @property
    def orbit(self):
        """The last orbit."""
        return self.orbits[1]


class StrobeOrbit(NamedTuple):
    """State of an orbit at the strobe, shape (4,), and the orbit's dominant Floquet multiplier."""

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
    status. The first step leads to `target`. After success the step is multiplied by `growth`. The
    step is halved if `correct` fails, or if Z1, Z1' or Z2 changes by `reach` or more: then the new
    orbit may lie on another branch. A step below `shortest` ends the following. The orbit `behind`,
    if given, belongs to the value 2 start - target, and improves the first prediction.
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
    """Follow a stable orbit while the packed parameter at index `parameter` changes to `target`.

    Following stops where Newton's method fails, as at a fold; where the orbit jumps or becomes
    unstable; or where it repeats after fewer cycles. Return the packed parameters and the
    `StrobeOrbit` at the last value. After success the parameter is exactly `target`. If Newton's
    method fails at every value, the state is the given one, and the multiplier is NaN.
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
    """Follow a stable orbit to a value; return its record there, or None if it is not reached."""
    p, orbit = follow_stable(p, state, periods, parameter, value)
    return measured(p, orbit.state, periods, tolerance) if p[parameter] == value else None
