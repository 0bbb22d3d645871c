"""Points of a branch between two others of the same problem, guessed by a cubic through both."""

import numpy as np
from scipy.optimize import brentq


def at_distance(point, ahead, distance):
    """Return the point of a branch between two others, or None if Newton's method fails.

    Parameters
    ----------
    point, ahead : Point
        Of the same problem.
    distance : float
        Distance from the first one, in the direction of its tangent.
    """
    share = distance / ((point.problem.metric * point.tangent) @ (ahead.x - point.x))
    return point.problem.near(_cubic(point, ahead, share), point.tangent, distance)


def at_value(point, ahead, value):
    """Return the same as `at_distance`, at a value of the parameter between those of both."""
    problem, chord = point.problem, ahead.x - point.x

    def beyond(share):
        return _cubic(point, ahead, share)[-1] - value

    x = _cubic(point, ahead, brentq(beyond, 0.0, 1.0))
    x[-1] = value
    found = problem.near(x, np.eye(len(x))[-1], problem.length(chord))
    if found is None:
        return None
    turned = np.sign((problem.metric * found.tangent) @ chord)
    return found._replace(tangent=found.tangent * turned)


def _cubic(point, ahead, share):
    """Return unknowns on the cubic that passes two points with the tangents of both.

    `share` is the share of the way along the tangent of the first one.
    """
    row = point.problem.metric * point.tangent
    chord = ahead.x - point.x
    length = row @ chord
    aside = chord - length * point.tangent
    slope = length * (ahead.tangent / (row @ ahead.tangent) - point.tangent)
    bent = share**2 * ((3 - 2 * share) * aside + (share - 1) * slope)
    return point.x + share * length * point.tangent + bent
