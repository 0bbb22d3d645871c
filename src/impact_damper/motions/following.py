"""Follow an orbit from one value of a parameter to another, by prediction and correction.

Following stops at a fold of the branch. The module `orbits.continuation` also passes folds.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from impact_damper.motions.records import measured
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, polish, repeats_sooner

# Factor by which the step of the parameter grows after a successful step.
GROWTH = 1.5
# `follow_stable` uses Newton's method. It may move a predicted state by at most REACH, and the
# state given at the start by at most NUDGE.
REACH, NUDGE = 0.03, 1e-3
# Smallest step of the parameter. The end of a branch is found to this accuracy.
RESOLUTION = 1e-8


class Followed(NamedTuple):
    """The last two values of the parameter that `follow` has reached, and the orbits there.

    `status` is the last status from `correct` in `follow`. `arrived`: the last value is the target.
    """

    values: tuple[float, float]
    orbits: tuple
    status: str
    arrived: bool

    @property
    def orbit(self):
        """The orbit at the last value of the parameter."""
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

    `orbit` is the orbit at `start`. `correct(value, predicted state)` returns an orbit (None on
    failure) and a word, the status. The first step goes to `target`. A step fails if `correct`
    fails, or if Z1, Z1' or Z2 changes by `reach` or more. A failure halves the step, a success
    multiplies it by `growth`. Following stops if a step is below `shortest`. If `extrapolating`,
    the predicted state lies on the line through the states of the last two orbits, otherwise it is
    the last orbit's state. At the first step `behind` is the orbit before, at 2 start - target.
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

    Following stops where Newton's method fails (for example at a fold), or where the orbit jumps,
    becomes unstable or repeats after fewer than `periods` cycles. Return the packed parameters and
    the `StrobeOrbit` at the last value, which is exactly `target` if the target is reached.
    If the method fails from the start, return the given parameters and state, with multiplier NaN.
    """
    # A period from a record is a two-byte integer. For that type numba would compile kernels again.
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
    """Follow a stable orbit to `value`; return its record, or None if the branch ends before."""
    p, orbit = follow_stable(p, state, periods, parameter, value)
    return measured(p, orbit.state, periods, tolerance) if p[parameter] == value else None
