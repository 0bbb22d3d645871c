"""One step along a branch: its length, whether it is accepted, and what it may have passed."""

import numpy as np

from impact_damper.orbits import between

# A step is accepted if the tangents at its ends differ by at most the angle TURNED, and if its
# chord differs from the mean of the tangents by at most SKEW times its length. A larger difference
# would indicate that the step led to another branch nearby.
TURNED, SKEW = 0.5, 0.03
# The length of the next step is chosen to turn by AIM times the largest turn. It is at most GROWTH
# times the length before and, after a failure, at least SHRINKAGE times this length.
AIM, GROWTH, SHRINKAGE = 0.65, 1.5, 0.3


def next_point(point, span, length):
    """Return the next point, and the factor for the length of the step after it.

    If the step would leave the range, the point lies at the end of the range. The point is None if
    Newton's method fails, if the branch turns by too much, or if the point seems to lie on another
    branch.
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
    """Return the next point with the bend and twist of the cubic from the point before to it."""
    length = ahead.problem.length(ahead.x - point.x)
    chord = (ahead.x - point.x) / length
    bend = (2 * point.tangent + 4 * ahead.tangent - 6 * chord) / length
    twist = 6 * (point.tangent + ahead.tangent - 2 * chord) / length**2
    return ahead._replace(bend=bend, twist=twist)


def folds_twice(point, ahead):
    """Return whether the parameter, on the cubic through two points, has two folds between them."""
    length = point.problem.length(ahead.x - point.x)
    first, last = length * point.tangent[-1], length * ahead.tangent[-1]
    chord = ahead.value - point.value
    # The derivative of the cubic is first + middle u + bend u^2 for u from 0 to 1.
    bend, middle = 3 * (first + last) - 6 * chord, 6 * chord - 4 * first - 2 * last
    if first * last <= 0 or not 0 < -middle * bend < 2 * bend**2:
        return False
    return first * (first - middle**2 / (4 * bend)) < 0


def passes_unseen(point, ahead, located):
    """Return whether a step crosses a branch of orbits of more symmetry without a located fold.

    Where the two branches meet, the parameter has an extremum along the branch, so the events of
    the step should include a fold. Without it the step may have led to the other branch.
    """
    folds = any(event.kind == "fold" for event in located)
    return not folds and point.orbit.deviation @ ahead.orbit.deviation < 0
