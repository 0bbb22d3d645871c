"""Find points of a branch between two known points.

A branch is the curve of the periodic orbits over a parameter, in the space of the unknowns: the
state of the orbit and the parameter. The first guess of Newton's method lies on a cubic that passes
through both points with their tangents.
"""

import numpy as np
from scipy.optimize import brentq


def at_distance(origin, point, ahead, distance):
    """Return the point of a branch at a distance from `origin`, or None if Newton's method fails.

    Parameters
    ----------
    origin, point, ahead : continuation.Point
        Points with the same `Problem`. The one that is sought lies between `point` and `ahead`.
    distance : float
        Distance from `origin` in the direction of its tangent, in the metric of the problem.
    """
    row = origin.problem.metric * origin.tangent
    first, last = (row @ (end.x - origin.x) for end in (point, ahead))
    x = _cubic(point, ahead, (distance - first) / (last - first))
    x += (distance - row @ (x - origin.x)) / (last - first) * (ahead.x - point.x)
    return origin.problem.near(x, origin.tangent, distance)


def at_value(point, ahead, value):
    """Return the point of a branch at a value of the parameter between those of two points.

    Both points have the same problem. The result is None if Newton's method fails.
    """
    problem, chord = point.problem, ahead.x - point.x

    def beyond(fraction):
        return _cubic(point, ahead, fraction)[-1] - value

    # At an end of the step the value may lie beyond it by a rounding error.
    ends = beyond(0.0), beyond(1.0)
    inside = ends[0] * ends[1] < 0
    fraction = brentq(beyond, 0.0, 1.0) if inside else float(np.argmin(np.abs(ends)))
    x = _cubic(point, ahead, fraction)
    x[-1] = value
    near = problem.near(x, np.eye(len(x))[-1], problem.length(chord))
    if near is None:
        return None
    turned = np.sign((problem.metric * near.tangent) @ chord)
    return near._replace(tangent=near.tangent * turned)


def _cubic(point, ahead, fraction):
    """Return the unknowns on the cubic that passes through two points with their tangents.

    `fraction` goes from 0 at the first to 1 at the second point, along the tangent at the first.
    """
    row = point.problem.metric * point.tangent
    chord = ahead.x - point.x
    length = row @ chord
    aside = chord - length * point.tangent
    slope = length * (ahead.tangent / (row @ ahead.tangent) - point.tangent)
    bent = fraction**2 * ((3 - 2 * fraction) * aside + (fraction - 1) * slope)
    return point.x + fraction * length * point.tangent + bent
