"""Switch to the branch that leaves where an orbit loses its symmetry or doubles its period.

The orbits of the other branch are not symmetric, or have twice the period. In both cases their
states in the second half of a cycle deviate from the pattern of the first branch: after a cycle the
deviation returns with the opposite sign. At the point where the branches meet, a multiplier of the
cycle is -1, and the other branch begins in the direction of its eigenvector. The parameter changes
with the square of the distance from the point. Newton's method orthogonal to the direction finds an
orbit of the other branch, because all orbits of the first branch lie at distance zero.

Close to a grazing the other branch turns sharply: two contacts have just appeared, and the orbits
of the other branch soon lose one of them. There an orbit is found at a given height of an extremum
(`grazing`), and the branch is followed past the grazing until its orbits differ clearly from the
orbits of more symmetry.
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

# DISTANCES: distances from the bifurcation at which an orbit of the other branch is searched for,
# one after the other. CLOSE: the same where the orbit closest to the bifurcation is wanted. ASIDE:
# largest distance between the first guess and the orbit found by Newton's method, divided by the
# distance from the bifurcation.
DISTANCES, CLOSE, ASIDE = (2e-2, 4e-3, 8e-4, 1e-4), (1e-4, 1e-5, 1e-6), 0.5
# Close to a grazing. SHARES: changes of the height at which an orbit is searched for, one after the
# other, as shares of the height. MISSED: largest relative error of its distance from the
# bifurcation. REACH: largest such distance, within which also the other contact must vanish.
# PASSAGES: number of orbits from which a way past the grazing is tried.
SHARES, MISSED, REACH, PASSAGES = (0.5, 0.2, 0.1, 0.05, 0.02), 0.5, 1e-3, 2
LEAVING = ("symmetry_breaking", "period_doubling")
# Largest distance of the orbit at which a branch ends from that of the branch that it meets there.
MEETING = 1e-3


class Departure(NamedTuple):
    """The beginning of the branch that leaves at a bifurcation.

    Attributes
    ----------
    point : Point
        The orbit found closest to the bifurcation.
    side : str
        supercritical: the orbit has as many unstable multipliers as the orbits of the first branch
        on their more stable side. subcritical: one more. beside_grazing: the orbit is so close to a
        grazing that its multipliers change by more than this difference. undecided: it has another
        number of them.
    """

    point: Point
    side: str


class _Leaving(NamedTuple):
    """Equations of the other branch, the unknowns at the bifurcation, and the direction there."""

    problem: Problem
    x: np.ndarray
    direction: np.ndarray


def departure(event) -> Departure | None:
    """Return the beginning of the branch that leaves at a bifurcation.

    Parameters
    ----------
    event : Event
        A loss of symmetry or a period doubling.

    Returns
    -------
    Departure or None
        None if Newton's method finds no orbit.

    Raises
    ------
    ValueError
        If the event is of another kind.
    """
    leaving = _leaving(event)
    point = _at_distance(leaving, CLOSE)
    if point is None:
        point = next(_at_heights(leaving), None)
        return point and Departure(point, "beside_grazing")
    first = event.point.orbit.cycle_multipliers
    others = np.delete(first, np.argmin(np.abs(first + 1)))
    more = np.sum(np.abs(point.orbit.cycle_multipliers) > 1) - np.sum(np.abs(others) > 1)
    return Departure(point, {0: "supercritical", 1: "subcritical"}.get(int(more), "undecided"))


def other_branch(event) -> Point | None:
    """Return a point, close to a bifurcation, from which the branch that leaves can be followed.

    Parameters
    ----------
    event : Event
        A loss of symmetry or a period doubling.

    Returns
    -------
    Point or None
        None if Newton's method finds no orbit that is clearly of less symmetry or of twice the
        period.

    Raises
    ------
    ValueError
        If the event is of another kind.
    """
    leaving = _leaving(event)
    doubled = event.kind == "period_doubling"
    point = _at_distance(leaving, DISTANCES)
    if point is not None:
        return point if _is_other(point.orbit, doubled) else None
    for point in islice(_at_heights(leaving), PASSAGES):
        passage = through_grazing(point, REACH)
        if passage and _is_other(passage.points[-1].orbit, doubled):
            return passage.points[-1]
    return None


def met_branch(point, kind) -> Point | None:
    """Return the point of the branch at which another one ends.

    Parameters
    ----------
    point : Point
        The last point of the branch that ends.
    kind : str
        symmetry_breaking or period_doubling.

    Returns
    -------
    Point or None
        A symmetric orbit, or one of half the period; None if Newton's method finds none there.
    """
    orbit, symmetric = point.orbit, kind == "symmetry_breaking"
    periods = orbit.periods // (1 if symmetric else 2)
    orbit, _ = shoot(orbit.p, orbit.state, periods, orbit.phase, symmetric=symmetric)
    problem = Problem.of(point.problem.family, orbit, symmetric=symmetric)
    x = problem.unknowns(orbit, point.value)
    found = problem.correct(x, np.eye(len(x))[-1])
    return None if found is None or problem.length(found.x - x) > MEETING else found


def _leaving(event):
    """Return the `_Leaving` of an event."""
    if event.kind not in LEAVING:
        raise ValueError(f"event = {event.kind!r}: must be one of {', '.join(LEAVING)}")
    point, problem = event.point, event.point.problem
    doubled = event.kind == "period_doubling"
    # the deviation returns with the opposite sign of the states
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


def _at_distance(leaving, distances):
    """Return the first point of the other branch found at one of several distances, or None."""
    problem, x, direction = leaving
    for distance in distances:
        guess = x + distance * direction
        near = problem.correct(guess, direction)
        if near is not None and problem.length(near.x - guess) <= ASIDE * distance:
            return near
    return None


def _at_heights(leaving):
    """Yield points of the other branch at heights of the extremum that is closest to a wall.

    At the bifurcation the extremum occurs twice. On the other branch one of both rises and the
    other one falls.
    """
    problem, x, direction = leaving
    # the second half of the segments has the same extrema as the first
    half = (len(problem.phases) - 1) // 2 if problem.damped else 0
    orbit = problem.shoot(x)[0]
    turns = [turn for k in range(half) for turn in turns_of(problem, x, orbit, k)]
    if not turns:
        return
    turn = min(turns, key=lambda turn: abs(turn.height))
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
    """Return whether an orbit clearly has the longer period, or is clearly not symmetric."""
    return not orbit.repeats_sooner() if doubled else orbit.record["asymmetry"] > SYMMETRIC
