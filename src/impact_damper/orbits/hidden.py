"""Pairs of bifurcations that a step along a branch of periodic orbits may hide.

A branch is the curve of the orbits over a parameter. A bifurcation on a step shows as a change of
the sign of its test function between the two ends of the step. Two zeros on one step leave the sign
as it is. They show in the multipliers outside the unit circle, or in the slopes of the test
function at the ends.
"""

import numpy as np

from impact_damper.orbits.bifurcations import COMPLEX, TESTS

# A test function is examined for two zeros on a step if its modulus at one end is below LOW.
LOW = 0.5
# Change of the unknowns in the difference quotient of a test function.
SHIFT = 1e-7
# Places on a step, as fractions of its length, at which the cubic of a test function is evaluated.
PLACES = np.linspace(0, 1, 17)


def hides_bifurcations(point, ahead, events):
    """Return whether a step between two points has bifurcations that are not among `events`.

    `events` are the events located on the step, in order. A step on which the sequence of walls
    changes is not examined, because multipliers jump there. A step across a branch of more symmetry
    is not examined either: behind it the same orbits return, and a multiplier touches 1 and turns.
    """
    start, end = point.orbit, ahead.orbit
    if start.sequence != end.sequence or start.deviation @ end.deviation < 0:
        return False
    return _unaccounted(point, ahead, events) or _crosses_twice(point, ahead)


def _unaccounted(point, ahead, events):
    """Return whether the number of multipliers outside the unit circle changes without an event.

    At an event one multiplier crosses the circle, or two cross it at a Neimark-Sacker point. The
    others must be as many outside as just before and after the event.
    """
    count = _outside(point.orbit.multipliers)
    for event in events:
        values, crossing = event.point.orbit.multipliers, 1
        distance = np.abs(values + 1 if event.kind == "period_doubling" else values - 1)
        if event.kind == "neimark_sacker":
            crossing = 2
            distance = np.where(np.abs(values.imag) > COMPLEX, np.abs(np.abs(values) - 1), np.inf)
        others = _outside(values[np.argsort(distance)[crossing:]])
        if count not in (others, others + crossing):
            return True
        count = 2 * others + crossing - count
    return count != _outside(ahead.orbit.multipliers)


def _outside(multipliers):
    """Return the number of multipliers outside the unit circle."""
    return int(np.sum(np.abs(multipliers) > 1))


def _crosses_twice(point, ahead):
    """Return whether the cubic of a test function, by its values and slopes at the ends, has zeros.

    Loss of symmetry and period doubling are examined.
    """
    length = point.problem.length(ahead.x - point.x)
    for kind in ("symmetry_breaking", "period_doubling"):
        test = TESTS[kind][0]
        values = np.array([test(point), test(ahead)])
        if values[0] * values[1] <= 0 or np.min(np.abs(values)) > LOW:
            continue
        beside = [test(_shifted(each)) for each in (point, ahead)]
        slopes = length / SHIFT * (np.array(beside) - values)
        u, v = PLACES, 1 - PLACES
        cubic = v**2 * (1 + 2 * u) * values[0] + u**2 * (1 + 2 * v) * values[1]
        cubic += u * v * (v * slopes[0] - u * slopes[1])
        if np.min(cubic * values[0]) < 0:
            return True
    return False


def _shifted(point):
    """Return a point with the orbit at unknowns that are moved by SHIFT along the tangent."""
    problem = point.problem
    chain = problem.flow(point.x + SHIFT * point.tangent)
    return point._replace(orbit=problem.orbit_of(chain))
