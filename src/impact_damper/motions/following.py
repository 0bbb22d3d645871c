"""Follow an orbit from one value of a parameter to another, by prediction and correction.

This module steps towards a given value of the parameter and stops at folds; `orbits.continuation`
steps along the branch itself and passes folds. A step predicts the state at the next value and
corrects it by Newton's method, which the caller supplies. A step that fails is halved.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.motions.records import measured
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, polish, repeats_sooner

GROWTH = 1.5
# Stable orbits: largest correction of a predicted state, and of the first state.
REACH, NUDGE = 0.03, 1e-3
# Accuracy to which the end of a branch of stable orbits is located, in units of the parameter.
RESOLUTION = 1e-8


class Followed(NamedTuple):
    """The last two orbits on the way to a value of the parameter.

    Attributes
    ----------
    values : (float, float)
        Values of the parameter at the last orbit but one and at the last. Both are the start if no
        step succeeded.
    orbits : tuple of two
        These orbits.
    status : str
        Status that the correction returned for the last step tried.
    arrived : bool
        Whether the last orbit is at the target.
    """

    values: tuple[float, float]
    orbits: tuple
    status: str
    arrived: bool

    @property
    def value(self):
        """Parameter of the last orbit."""
        return self.values[1]

    @property
    def orbit(self):
        """The last orbit."""
        return self.orbits[1]


class StrobeOrbit(NamedTuple):
    """An orbit, given by its state at the strobe, the phase W T = pi/2 of the forcing.

    Attributes
    ----------
    state : numpy.ndarray, shape (4,)
        Z1, Z1', Z2, Z2' at W T = pi/2.
    multiplier : complex
        Dominant Floquet multiplier, its imaginary part not negative.
    """

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

    Parameters
    ----------
    correct : callable
        Maps a value and a predicted state, shape (4,), to an orbit with the attribute `state`, or
        None, and a status.
    start, target : float
        Values of the parameter. The first step tried leads to the target.
    orbit
        Orbit at the start.
    shortest : float
        Following ends when a step fails whose half is shorter.
    growth : float
        Factor by which a step grows after success.
    reach : float
        A step also fails if Z1, Z1' or Z2 changes by this or more: it may lead to another orbit.
    extrapolating : bool
        Whether predictions extrapolate the last two orbits; otherwise the prediction is the state
        of the last orbit.
    behind : optional
        Orbit at the value 2 start - target, on the other side of the start. Given this orbit, the
        first prediction extrapolates too.

    Returns
    -------
    Followed
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
        found, status = correct(ahead, state)
        if found is not None and np.max(np.abs(found.state - orbit.state)[:3]) < reach:
            before, behind, last_step = (value, orbit), orbit, step
            value, orbit = ahead, found
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


def follow_stable(p, state, periods, parameter, target, resolution=RESOLUTION) -> tuple:
    """Follow a stable orbit while one parameter moves to a target, as far as it goes.

    An orbit that is no longer stable, or repeats after a divisor of its periods, is not followed.

    Parameters
    ----------
    p : array, shape (COUNT,)
        Packed parameters.
    state : array, shape (4,)
        State of the orbit at W T = pi/2.
    periods : int
        Period of the orbit in forcing periods.
    parameter : int
        Place in the packed parameters, as `packed.FREQUENCY`.
    target : float
    resolution : float
        Accuracy to which the value where following ends is located, in units of the parameter.

    Returns
    -------
    p : numpy.ndarray, shape (COUNT,)
        Packed parameters of the last orbit; the parameter is exactly the target if it was reached.
    orbit : StrobeOrbit
        The last orbit. Its multiplier is NaN if no orbit was found at the given state.
    """
    # kernels would be compiled again for an integer of two bytes
    periods = int(periods)
    p, first = p.copy(), np.array(state, float)
    _, _, multiplier = polish(p, first, periods, NUDGE, POLISH_TOLERANCE)

    def correct(value, guess):
        p[parameter] = value
        found, _, multiplier = polish(p, guess, periods, REACH, POLISH_TOLERANCE)
        if not found:
            return None, "not_converged"
        if not abs(multiplier) < 1:
            return None, "unstable"
        if repeats_sooner(p, guess, periods, POLISH_TOLERANCE):
            return None, "repeats_sooner"
        return StrobeOrbit(guess, multiplier), "found"

    start = float(p[parameter])
    orbit = StrobeOrbit(first, multiplier)
    followed = follow(correct, start, target, orbit, shortest=resolution, reach=2 * REACH)
    p[parameter] = followed.value
    return p, followed.orbit


def record_at(p, state, periods, parameter, value, tolerance=POLISH_TOLERANCE):
    """Return the record of a stable orbit followed to a value, or None if it ends before.

    Arguments as in `follow_stable`; `tolerance` is the local error allowed in the measurement.
    """
    p, orbit = follow_stable(p, state, periods, parameter, value)
    return measured(p, orbit.state, periods, tolerance) if p[parameter] == value else None
