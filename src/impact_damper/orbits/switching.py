"""Switch to the branch that leaves where an orbit loses its symmetry or doubles its period.

A branch is the curve of the periodic orbits over a parameter. At such a bifurcation the first
branch and the other branch meet. The orbits of the other branch have less symmetry: they are not
symmetric, or have twice the period.

A cycle of the first branch is the period or, for symmetric orbits, half the period with a change of
sign. The deviation of an orbit of the other branch from the first branch changes its sign in each
such cycle. At the bifurcation one multiplier (eigenvalue of the derivative over a cycle) is -1, and
the other branch begins in the direction of its eigenvector. The parameter changes with the square
of the distance from the bifurcation. The corrections of Newton's method are orthogonal to the
direction. The method therefore stays away from the first branch, whose orbits have the distance
zero in this direction, and finds an orbit of the other branch.

At a grazing the loose mass reaches a wall with zero speed. Close to a grazing the other branch
turns sharply: two contacts have just appeared, and the orbits of the other branch soon lose one of
them. An orbit close to a grazing is found at a given height |Z2| - d0 of an extremum of Z2
(`grazing`). The branch is then followed past the grazing until its orbits differ clearly from
orbits of more symmetry. Z2 is the displacement of the primary mass relative to the loose mass, and
d0 the clearance.
"""

from dataclasses import replace
from itertools import islice
from typing import NamedTuple

import numpy as np

from impact_damper.orbits import segments
from impact_damper.orbits.continuation import SYMMETRIC, Point, Problem
from impact_damper.orbits.grazing import at_height, through_grazing
from impact_damper.orbits.shooting import shoot
from impact_damper.orbits.turns import turns_of

# Search for an orbit of the other branch at a distance from the bifurcation.
# DISTANCES: distances that are tried, one after the other.
# ASIDE: largest distance of the orbit found from the first guess, divided by its distance from the
#   bifurcation.
DISTANCES, ASIDE = (2e-2, 4e-3, 8e-4, 1e-4, 1e-5), 0.5
# Search for an orbit of the other branch close to a grazing.
# SHARES: changes of the height, divided by the height at the bifurcation, that are tried.
# MISSED: largest relative error of the predicted distance of the orbit from the bifurcation.
# REACH: largest such distance, and largest distance within which the grazing must follow.
# PASSAGES: number of orbits from which the branch is followed past the grazing, until one succeeds.
SHARES, MISSED, REACH, PASSAGES = (0.5, 0.2, 0.1, 0.05, 0.02), 0.5, 1e-3, 2
# Kinds of events at which another branch leaves.
LEAVING = ("symmetry_breaking", "period_doubling")
# A branch meets another one at its end if the last orbit and the orbit of the other branch are at
# most MEETING apart.
MEETING = 1e-3


class _Leaving(NamedTuple):
    """The beginning of the other branch.

    Attributes
    ----------
    problem : Problem
        Equations of the other branch.
    x : numpy.ndarray
        Unknowns of the problem at the bifurcation.
    direction : numpy.ndarray
        Direction in which the other branch begins.
    """

    problem: Problem
    x: np.ndarray
    direction: np.ndarray


def other_branch(event, *, stable=False) -> Point | None:
    """Return a point, close to a bifurcation, from which the branch that leaves can be followed.

    Parameters
    ----------
    event : Event
        A loss of symmetry or a period doubling.
    stable : bool
        Return only a point whose orbit is stable.

    Returns
    -------
    Point or None
        None if Newton's method finds no orbit that is clearly not symmetric or clearly has twice
        the period.

    Raises
    ------
    ValueError
        If the event is of another kind.
    """
    leaving = _leaving(event)
    doubled = event.kind == "period_doubling"

    def fits(point):
        return _is_other(point.orbit, doubled) and (point.orbit.stable or not stable)

    found = filter(None, (_at_distance(leaving, distance) for distance in DISTANCES))
    points = list(found) if stable else list(islice(found, 1))
    if points:
        return next(filter(fits, points), None)
    for point in islice(_at_heights(leaving), PASSAGES):
        passage = through_grazing(point, REACH)
        if passage and fits(passage.points[-1]):
            return passage.points[-1]
    return None


def met_branch(point, kind) -> Point | None:
    """Return the point of the branch of more symmetry at which another branch ends.

    Parameters
    ----------
    point : Point
        The last point of the branch that ends.
    kind : str
        Kind of the bifurcation: "symmetry_breaking" or "period_doubling".

    Returns
    -------
    Point or None
        Its orbit is symmetric, or has half the period. None if Newton's method finds no such orbit
        close to the last point.
    """
    orbit, symmetric = point.orbit, kind == "symmetry_breaking"
    periods = orbit.periods // (1 if symmetric else 2)
    orbit, _ = shoot(orbit.p, orbit.state, periods, orbit.phase, symmetric=symmetric)
    problem = Problem.of(point.problem.family, orbit, symmetric=symmetric)
    x = problem.unknowns(orbit, point.value)
    found = problem.correct(x, np.eye(len(x))[-1])
    return None if found is None or problem.length(found.x - x) > MEETING else found


def _leaving(event):
    """Return the beginning of the other branch at an event, a `_Leaving`."""
    if event.kind not in LEAVING:
        raise ValueError(f"event = {event.kind!r}: must be one of {', '.join(LEAVING)}")
    point, problem = event.point, event.point.problem
    doubled = event.kind == "period_doubling"
    # Over a cycle the deviation changes its sign relative to the state.
    sign, size = (1 if doubled else -1), 4 if problem.damped else 2
    factors = point.orbit.factors[:, :size, :size].copy()
    factors[-1] *= -1
    deviation = np.linalg.svd(segments.cyclic(factors))[2][-1]
    x, phases = point.x, np.append(problem.phases[:-1], problem.phases + problem.cycle)
    if problem.damped:
        x = np.concatenate([x[:-1], sign * x[:-1], x[-1:]])
        deviation = np.concatenate([deviation, -sign * deviation])
    else:
        phases = phases[[0, -1]]
    periods = problem.periods * (2 if doubled else 1)
    whole = replace(problem, periods=periods, phases=phases, symmetric=False)
    direction = np.append(deviation, 0.0)
    return _Leaving(whole, x, direction / whole.length(direction))


def _at_distance(leaving, distance):
    """Return the point of the other branch at a distance from the bifurcation, or None."""
    problem, x, direction = leaving
    guess = x + distance * direction
    near = problem.correct(guess, direction)
    close = near is not None and problem.length(near.x - guess) <= ASIDE * distance
    return near if close else None


def _at_heights(leaving):
    """Yield points of the other branch at several heights of an extremum of Z2.

    Of all extrema it is the one that first reaches its wall along the other branch. At the
    bifurcation the motion has this extremum twice, once in each cycle of the first branch. On the
    other branch one of both rises and the other one falls.
    """
    problem, x, direction = leaving
    # Only the first half of the segments is searched, because the second half has the same extrema.
    half = (len(problem.phases) - 1) // 2 if problem.damped else 0
    orbit = problem.shoot(x)[0]
    turns = [turn for k in range(half) for turn in turns_of(problem, x, orbit, k)]
    if not turns:
        return
    turn = max(turns, key=lambda turn: abs(turn.gradient @ direction / turn.height))
    for share in SHARES:
        change = share * turn.height
        away = change / (turn.gradient @ direction or np.finfo(float).tiny)
        if abs(away) > REACH:
            continue
        found = at_height(
            problem, x + away * direction, turn, turn.height + change, np.sign(change)
        )
        if found is None:
            continue
        distance = (problem.metric * (found[0].x - x)) @ direction
        if abs(distance / away - 1) < MISSED:
            yield found[0]


def _is_other(orbit, doubled):
    """Return whether an orbit clearly has twice the period or, if not `doubled`, is asymmetric."""
    return not orbit.repeats_sooner() if doubled else orbit.record["asymmetry"] > SYMMETRIC
