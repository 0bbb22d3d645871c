"""Follow an orbit from one value of a parameter to another, by prediction and correction.

Following stops at folds, unlike `orbits.continuation`.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.motions.records import measured
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, polish, repeats_sooner

# Factor by which a step grows after success.
GROWTH = 1.5
# Largest corrections of a predicted state and of the first state; larger ones could lead to
# another orbit.
REACH, NUDGE = 0.03, 1e-3
# Accuracy, in units of the parameter, of the end of a branch of stable orbits.
RESOLUTION = 1e-8


class Followed(NamedTuple):
    """The last two orbits on the way to a value, and the status of the last correction."""

    values: tuple[float, float]
    orbits: tuple
    status: str
    arrived: bool

    @property
    def value(self):
        """Value of the parameter at the last orbit."""
        return self.values[1]

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
    """Follow an orbit from one value of a parameter to another, or as far as it goes.

    `correct` takes a value and a predicted state (4,), and returns an orbit, or None if it fails,
    and a status. The first step leads to `target`. A step grows by `growth` after success, and is
    halved if the correction fails, or if Z1, Z1' or Z2 changes by `reach` or more, since it may
    have led to another orbit. `behind` is the orbit at 2 start - target, if known.
    """
    value, step, status = start, target - start, ""
    before, last_step = (start, orbit), target - start
    while value != target:
        if abs(step) > abs(target - value):
            step = target - value
        ahead = target if step == target - value else value + step
        state = orbit.state.copy()
        if extrapolating and behind is not None:
            extrapolate(state, behind.state, step / last_step)
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


@kernel
def extrapolate(state, before, ratio):
    """Add to a state, in place, `ratio` times its difference from the state `before`."""
    state += (state - before) * ratio


def follow_stable(p, state, periods, parameter, target) -> tuple:
    """Follow a stable orbit while the parameter of an index changes to a target value, if possible.

    Following stops where the orbit becomes unstable or repeats after fewer cycles. Return the
    packed parameters, with exactly the target if it was reached, and the last `StrobeOrbit`, whose
    multiplier is NaN if there is no orbit near the given state.
    """
    # Records hold periods as two-byte integers; for these numba would compile the kernels again.
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
    p[parameter] = followed.value
    return p, followed.orbit


def record_at(p, state, periods, parameter, value, tolerance=POLISH_TOLERANCE):
    """Return the record of an orbit that `follow_stable` follows to a value, None if it ends."""
    p, orbit = follow_stable(p, state, periods, parameter, value)
    return measured(p, orbit.state, periods, tolerance) if p[parameter] == value else None
