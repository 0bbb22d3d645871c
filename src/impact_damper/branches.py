"""A branch of periodic orbits, followed both ways from one of them to its true ends."""

from typing import NamedTuple

import numpy as np

from impact_damper.bifurcations import Event, events_between
from impact_damper.continuation import (
    FIRST_STEP,
    LONGEST_STEP,
    SHORTEST_STEP,
    STRAIGHT,
    Point,
    Problem,
)

SAME = 1e-5
WEAK = 0.02


class Branch(NamedTuple):
    """A branch of orbits.

    Attributes
    ----------
    points : list of Point
        In order along it.
    events : list of (int, Event)
        Each with the number of the point before it.
    ends : tuple of str
        What ends it before the first point and after the last: range_ends, closed,
        symmetry_breaking, period_doubling, contact_lost, lost or point_limit.
    lost : int
        Events that could not be located.
    """

    points: list[Point]
    events: list[tuple[int, Event]]
    ends: tuple[str, str]
    lost: int


def follow_branch(family, orbit, value, span, *, scale=1.0, limit=2000) -> Branch:
    """Follow a branch from an orbit in both directions of a parameter.

    Parameters
    ----------
    family : callable
        From the parameter to packed parameters.
    orbit : Orbit
        A converged orbit of the branch.
    value : float
        The parameter there.
    span : tuple of float
        Least and greatest value of the parameter.
    scale : float
        Unit of length of the parameter: a step changes it by at most 0.05 of it.
    limit : int
        Most points in a direction.

    Returns
    -------
    Branch

    Raises
    ------
    ArithmeticError
        If the orbit is not one of the family at the value.
    """
    problem = Problem.of(family, scale, orbit)
    walks = []
    for direction in (-1, 1):
        first = problem.begin(orbit, value, direction)
        if first is None:
            raise ArithmeticError(f"no orbit of the family at {value:g} close to the one given")
        walks.append(_walk(problem, first, span, limit))
        if walks[0].ends[1] == "closed":
            return walks[0]._replace(ends=("closed", "closed"))
    down, up = walks
    count = len(down.points) - 1
    events = [(count - 1 - k, _reversed(event)) for k, event in reversed(down.events)]
    events += [(count + k, event) for k, event in up.events]
    points = down.points[:0:-1] + up.points
    return Branch(points, events, (down.ends[1], up.ends[1]), down.lost + up.lost)


def _reversed(event):
    return event._replace(before=event.after, after=event.before)


def _walk(problem, first, span, limit):
    """The part of a branch that begins at a point in the direction of its tangent."""
    points, events, lost, end = [first], [], 0, "point_limit"
    length = FIRST_STEP
    while len(points) < limit:
        here = points[-1]
        there = _next(problem, here, span, length)
        if there is None:
            length /= 2
            if length < SHORTEST_STEP:
                end = _loss(here.orbit)
                break
            continue
        length = (there.x - here.x) @ here.tangent
        news, missed = events_between(problem, here, there, length)
        lost += missed
        for event in news:
            events.append((len(points) - 1, event))
            end = _meeting(here.orbit, event)
            if end:
                events[-1] = (len(points) - 1, event._replace(kind=end))
                return Branch([*points, event.point], events, ("", end), lost)
        points.append(there)
        if there.value in span:
            end = "range_ends"
            break
        if len(points) > 3 and _passes(problem, here, there, first):
            points[-1] = first
            end = "closed"
            break
        moved = problem.rephased(there)
        if moved is None:
            end = "lost"
            break
        problem, points[-1] = moved
        length = min(1.3 * length, LONGEST_STEP)
    return Branch(points, events, ("", end), lost)


def _next(problem, here, span, length):
    """The next point, at the end of the range if the step would leave it, or None."""
    there = problem.step(here, length)
    if there is not None and np.clip(there.value, *span) != there.value:
        there = problem.at_value(here, float(np.clip(there.value, *span)))
    if there is None or there.tangent @ here.tangent < STRAIGHT:
        return None
    return there


def _loss(orbit):
    """What ends a branch at an orbit beyond which Newton's method finds none."""
    weak = orbit.touching and np.max(np.abs(orbit.contacts[:, 3])) < WEAK
    return "contact_lost" if weak else "lost"


def _meeting(orbit, event):
    """What ends the branch of an orbit at an event where it meets one of more symmetry, or ""."""
    if event.kind != "fold":
        return ""
    met = event.point.orbit
    if met.repeats_sooner(SAME) and not orbit.repeats_sooner(SAME):
        return "period_doubling"
    if met.record["asymmetry"] < SAME < orbit.record["asymmetry"]:
        return "symmetry_breaking"
    return ""


def _passes(problem, here, there, first):
    """Whether the first point of a branch lies on the step between two others."""
    if (here.value - first.value) * (there.value - first.value) > 0:
        return False
    again = problem.at_value(here, first.value)
    return again is not None and first.orbit.is_same(again.orbit, SAME)
