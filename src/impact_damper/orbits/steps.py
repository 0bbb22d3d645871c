"""One step along a branch: its length, whether it is accepted, and what it may have passed.

A branch is the curve of the periodic orbits over a parameter. A fold is a point at which it turns
back. A step leads from one point of the branch to the next. Its chord is the straight line between
the two points, and its cubic the curve through both points with their tangents.
"""

import numpy as np

from impact_damper.orbits import between

# A step is accepted if both bounds hold. Otherwise it may have led to another branch nearby.
# TURNED: largest angle between the tangents at its ends, radian.
# SKEW: largest difference between the directions of the chord and of the mean tangent.
TURNED, SKEW = 0.5, 0.03
# Length of the next step.
# AIM: the step is chosen to use about this fraction of the bounds TURNED and SKEW.
# GROWTH: largest ratio of its length to the length before.
# SHRINKAGE: least ratio after a step that was not accepted.
AIM, GROWTH, SHRINKAGE = 0.65, 1.5, 0.3


def next_point(point, span, length):
    """Return the next point of a branch, and the factor for the length of the following step.

    If the step would leave the range `span` of the parameter, the point lies at the end of the
    range. The point is None if Newton's method fails, or if the step is not accepted (TURNED,
    SKEW).
    """
    problem = point.problem
    ahead = problem.step(point, length)
    if ahead is not None and np.clip(ahead.value, *span) != ahead.value:
        ahead = between.at_value(point, ahead, float(np.clip(ahead.value, *span)))
    if ahead is None:
        return None, 0.5
    chord = ahead.x - point.x
    mean = (point.tangent + ahead.tangent) / 2
    straight = problem.length(mean)
    turned = 2 * np.arccos(min(straight, 1.0)) / TURNED
    chord /= problem.length(chord) or 1.0
    skew = problem.length(chord - mean / straight) / SKEW
    ease = AIM / max(turned, skew**0.5, AIM / GROWTH)
    if max(turned, skew) > 1:
        return None, max(min(ease, AIM), SHRINKAGE)
    return ahead, ease


def with_bend(point, ahead):
    """Return the point `ahead` with `bend` and `twist` (`Point`) from the cubic of the step."""
    length = ahead.problem.length(ahead.x - point.x)
    chord = (ahead.x - point.x) / length
    bend = (2 * point.tangent + 4 * ahead.tangent - 6 * chord) / length
    twist = 6 * (point.tangent + ahead.tangent - 2 * chord) / length**2
    return ahead._replace(bend=bend, twist=twist)


def folds_twice(point, ahead):
    """Return whether the cubic of the step between two points has two folds."""
    length = point.problem.length(ahead.x - point.x)
    first, last = length * point.tangent[-1], length * ahead.tangent[-1]
    chord = ahead.value - point.value
    # On the cubic the parameter has the derivative first + middle u + bend u^2, for u from 0 to 1.
    bend, middle = 3 * (first + last) - 6 * chord, 6 * chord - 4 * first - 2 * last
    if first * last <= 0 or not 0 < -middle * bend < 2 * bend**2:
        return False
    return first * (first - middle**2 / (4 * bend)) < 0


def passes_unseen(point, ahead, located):
    """Return whether a step crosses a branch of more symmetry without a located fold.

    The orbits of that branch are symmetric or have half the period. Where the two branches meet,
    the parameter has an extremum along the branch, so the events `located` on the step should
    include a fold. Without a fold the step may have led past the meeting.
    """
    folds = any(event.kind == "fold" for event in located)
    return not folds and point.orbit.deviation @ ahead.orbit.deviation < 0
