"""A branch of periodic orbits, followed both ways from one of them as far as it goes."""

from typing import NamedTuple

import numpy as np

from impact_damper.orbits.bifurcations import Event, events_between
from impact_damper.orbits.continuation import (
    FIRST_STEP,
    LONGEST_STEP,
    SHORTEST_STEP,
    STRAIGHT,
    Point,
    Problem,
)

SAME = 1e-5
WEAK = 0.02
GLANCE = 1e-4
MOST_POINTS = 2000
# Beyond these an orbit is one of the countless saddles of a chaotic motion, and rounding takes
# the digits that are asked for: its largest multiplier, and how much its map amplifies.
UNSTABLE = 100.0
AMPLIFYING = 300.0


class Branch(NamedTuple):
    """A branch of orbits.

    Attributes
    ----------
    points : list of Point
        In order along it, events among them.
    events : list of (int, Event)
        Each with the number of its point.
    ends : tuple of str
        What ends it before the first point and after the last: range_ends, closed,
        symmetry_breaking, period_doubling, grazing, contact_lost, too_unstable, lost or
        point_limit.
    lost : int
        Events that could not be located.
    """

    points: list[Point]
    events: list[tuple[int, Event]]
    ends: tuple[str, str]
    lost: int


def follow_branch(family, orbit, value, span) -> Branch:
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

    Returns
    -------
    Branch

    Raises
    ------
    ArithmeticError
        If the orbit is not one of the family at the value.
    """
    problem = Problem.of(family, orbit)
    walks = []
    for direction in (-1, 1):
        first = problem.begin(orbit, value, direction)
        if first is None:
            raise ArithmeticError(f"no orbit of the family at {value:g} close to the one given")
        walks.append(_walk(problem, first, span))
        if walks[0].ends[1] == "closed":
            return walks[0]._replace(ends=("closed", "closed"))
    down, up = walks
    count = len(down.points) - 1
    events = [(count - k, _reversed(event)) for k, event in reversed(down.events)]
    events += [(count + k, event) for k, event in up.events]
    points = down.points[:0:-1] + up.points
    return Branch(points, events, (down.ends[1], up.ends[1]), down.lost + up.lost)


def _reversed(event):
    return event._replace(before=event.after, after=event.before)


def _walk(problem, first, span):
    """The part of a branch that begins at a point in the direction of its tangent."""
    points, events, lost, end = [first], [], 0, "point_limit"
    length = FIRST_STEP
    while len(points) < MOST_POINTS:
        here = points[-1]
        there = _next(problem, here, span, length)
        if there is None:
            length /= 2
            if length < SHORTEST_STEP:
                end = _loss(problem, here)
                break
            continue
        length = (there.x - here.x) @ here.tangent
        news, missed = events_between(problem, here, there, length)
        lost += missed
        if _deviation(here.orbit) @ _deviation(there.orbit) < 0:
            end = "symmetry_breaking" if problem.periods % 2 else "period_doubling"
            news, turned = _up_to_fold(news, end)
            lost += not turned and not missed
        for event in news:
            events.append((len(points), event))
            points.append(event.point)
        if end != "point_limit":
            break
        points.append(there)
        if there.value in span:
            end = "range_ends"
            break
        if len(points) > 3 and _passes(problem, here, there, first):
            points[-1] = first
            end = "closed"
            break
        if _is_too_unstable(there.orbit):
            end = "too_unstable"
            break
        moved = problem.rephased(there)
        if moved is None:
            end = "lost"
            break
        problem, points[-1] = moved
        length = min(1.3 * length, LONGEST_STEP)
    return Branch(points, events, ("", end), lost)


def _deviation(orbit):
    """Difference, shape (4,), from an orbit of more symmetry, whose branch is met where it turns.

    For odd n that is the symmetric one, for even n one of half the period; a symmetric orbit
    counts as one that meets none.
    """
    if orbit.root is not None:
        return np.ones(4)
    half = orbit.at(orbit.phase + orbit.periods * np.pi)
    return orbit.state + half if orbit.periods % 2 else orbit.state - half


def _up_to_fold(events, kind):
    """The events up to the fold at which a branch meets another, of a kind in truth; if found."""
    for k, event in enumerate(events):
        if event.kind == "fold":
            return [*events[:k], event._replace(kind=kind)], True
    return events, False


def _next(problem, here, span, length):
    """The next point, at the end of the range if the step would leave it, or None."""
    there = problem.step(here, length)
    if there is not None and np.clip(there.value, *span) != there.value:
        there = problem.at_value(here, float(np.clip(there.value, *span)))
    if there is None or there.tangent @ here.tangent < STRAIGHT:
        return None
    return there


def _loss(problem, last):
    """What ends a branch at a point beyond which Newton's method finds none.

    At a grazing contact the branch turns so sharply that it is not followed further.
    """
    orbit = last.orbit
    if orbit.touching and np.max(np.abs(orbit.contacts[:, 3])) < WEAK:
        return "contact_lost"
    ahead, _ = problem.shoot(last.x + GLANCE * last.tangent)
    return "grazing" if ahead.sequence != orbit.sequence else "lost"


def _is_too_unstable(orbit):
    """Whether an orbit amplifies rounding beyond the digits that are asked for."""
    matrix = orbit.monodromy if orbit.root is None else orbit.root
    return abs(orbit.multipliers[0]) > UNSTABLE or np.linalg.norm(matrix, 2) > AMPLIFYING


def _passes(problem, here, there, first):
    """Whether the first point of a branch lies on the step between two others."""
    if (here.value - first.value) * (there.value - first.value) > 0:
        return False
    again = problem.at_value(here, first.value)
    return again is not None and first.orbit.is_same(again.orbit, SAME)
