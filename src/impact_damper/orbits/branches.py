"""Follow a branch of periodic orbits from one orbit in both directions of a parameter."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from impact_damper.orbits import between
from impact_damper.orbits.bifurcations import Event, bifurcations_between, events_between
from impact_damper.orbits.continuation import (
    FIRST_STEP,
    LONGEST,
    LONGEST_UNSTABLE,
    SHORTEST_STEP,
    Point,
    Problem,
)
from impact_damper.orbits.grazing import through_grazing
from impact_damper.orbits.orbit import Orbit

# Most orbits in one direction.
MOST_POINTS = 10_000
# Two orbits at the same parameter are the same if their strobe states differ by less.
SAME = 1e-5
# `Branch.holds` compares states only where max |Z1| on the step comes so close to the orbit's.
NEARBY = 0.02
# If contacts slower than this disappear, the branch has come to a motion without contacts.
WEAK = 0.02
# The tangents at both ends of a step differ by at most this angle, and its chord from their mean by
# at most this share of its length: it would if the step led to another branch close by.
TURNED, SKEW = 0.35, 0.02
# A step is followed by one that turns less than the most by this factor, and that is at most so
# much longer, or shorter if the step failed.
AIM, GROWTH, SHRINKAGE = 0.8, 1.5, 0.3
# The step below which a grazing is looked for within so many steps.
CLOSE_STEP, REACH = 2e-3, 8.0
# A step that meets another branch is halved down to this until the place is seen.
CLEAR_STEP = 1e-4


@dataclass(frozen=True)
class Branch:
    """A branch of orbits.

    Attributes
    ----------
    family : callable
        Maps the parameter to packed parameters.
    points : list of Point
        Points in order along the branch, those of events among them.
    events : list of (int, Event)
        Events, each with the index of its point.
    ends : tuple of str
        Reason why the branch ends before the first point and after the last: range_ends, closed,
        symmetry_breaking, period_doubling, contact_lost, lost or point_limit.
    lost : int
        Number of events that could not be located.
    """

    family: Callable[[float], np.ndarray]
    points: list[Point]
    events: list[tuple[int, Event]]
    ends: tuple[str, str]
    lost: int

    @cached_property
    def values(self):
        """Parameter at the points, shape (n,)."""
        return np.array([point.value for point in self.points])

    @cached_property
    def displacements(self):
        """Largest |Z1| at the points, shape (n,)."""
        return np.array([point.orbit.record["maximum_displacement"] for point in self.points])

    def holds(self, orbit, value) -> bool:
        """Return whether an orbit at a value of the parameter lies on the branch.

        On each step of the branch that crosses the value, and on which max |Z1| comes close to
        that of the orbit, the orbit of the branch at the value is computed and compared.
        """
        if orbit.periods != self.points[0].orbit.periods:
            return False
        away = self.values - value
        size = self.displacements
        closeness = np.abs(size[:-1] - orbit.record["maximum_displacement"])
        crossing = (away[:-1] * away[1:] <= 0) & (closeness <= NEARBY + np.abs(np.diff(size)))
        for k in np.flatnonzero(crossing):
            point = self.points[k if abs(away[k]) <= abs(away[k + 1]) else k + 1]
            found = point.problem.at_value(point, value)
            if found is not None and found.orbit.is_same(orbit, SAME):
                return True
        return False


def follow_branch(family, orbit, value, span, most=MOST_POINTS) -> Branch:
    """Follow a branch from an orbit in both directions of a parameter.

    Parameters
    ----------
    family : callable
        Maps the parameter to packed parameters.
    orbit : Orbit
        A converged orbit of the branch.
    value : float
        The parameter of that orbit.
    span : tuple of float
        Least and greatest value of the parameter.
    most : int
        Number of orbits in one direction after which the branch is left ("point_limit").

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
        walks.append(_walk(problem, first, span, most))
        if walks[-1].ends[1] == "closed":
            return replace(walks[-1], ends=("closed", "closed"))
    down, up = walks
    count = len(down.points) - 1
    events = [(count - k, _reversed(event)) for k, event in reversed(down.events)]
    events += [(count + k, event) for k, event in up.events]
    points = down.points[:0:-1] + up.points
    return Branch(family, points, events, (down.ends[1], up.ends[1]), down.lost + up.lost)


def _reversed(event):
    """Return the event as met in the other direction."""
    return event._replace(before=event.after, after=event.before)


def _walk(problem, first, span, most) -> Branch:
    """Follow a branch from a point along its tangent; the start has the end reason ""."""
    points, events, lost, end = [first], [], 0, ""
    if (first.value - span[0]) * (first.value - span[1]) >= 0:
        outward = np.sign(first.value - sum(span) / 2) * first.tangent[-1] > 0
        end = "range_ends" if outward else ""
    if not problem.holds_still(first):
        points[0] = first = problem.recut(first)
    length, tried = FIRST_STEP, None
    while not end and len(points) < most:
        point = points[-1]
        ahead, factor = _next(point, span, length)
        changes = ahead is not None and ahead.orbit.sequence != point.orbit.sequence
        pieces = []
        close = ahead is None and length < CLOSE_STEP and problem.damped
        if (changes or close) and tried is not point:
            tried = point
            pieces = _through_grazing(point, max(length, SHORTEST_STEP * 1e3) * REACH)
        if not pieces:
            if ahead is None or (changes and length > CLOSE_STEP):
                length *= factor if ahead is None else 0.5
                if length < SHORTEST_STEP:
                    end = _loss(point)
                continue
            along = (point.problem.metric * (ahead.x - point.x)) @ point.tangent
            pieces = [(point, ahead, *events_between(point, ahead, along))]
            if length > CLEAR_STEP and _passes_unseen(*pieces[0][:3]):
                length /= 2
                continue
        for start, ahead, located, missed in pieces:
            lost += missed
            again = _passes(start, ahead, first) if len(points) > 2 else None
            if _deviation(start.orbit) @ _deviation(ahead.orbit) < 0:
                end = "symmetry_breaking" if problem.periods % 2 else "period_doubling"
                located, met = _up_to_fold(located, end)
                lost += not met and not missed
            elif again is not None:
                end = "closed"
                located = [event for event in located if _is_between(start, event.point, again)]
            elif ahead.value in span or np.clip(ahead.value, *span) != ahead.value:
                end = "range_ends"
            for event in located:
                events.append((len(points), event))
                if event.point is not ahead:
                    points.append(event.point)
            if end in ("", "range_ends", "closed"):
                points.append(first if end == "closed" else ahead)
            if end:
                break
        if not end:
            last, ahead = pieces[-1][:2]
            coarse = not (problem.symmetric or ahead.orbit.stable)
            longest = ahead.problem.length(ahead.x) * (LONGEST_UNSTABLE if coarse else LONGEST)
            length = min(factor * ahead.problem.length(ahead.x - last.x), longest)
            if not ahead.problem.holds_still(ahead):
                points[-1] = ahead.problem.recut(ahead)
            elif len(pieces) == 1:
                bend = (ahead.tangent - last.tangent) / ahead.problem.length(ahead.x - last.x)
                points[-1] = ahead._replace(bend=bend)
    return Branch(problem.family, points, events, ("", end or "point_limit"), lost)


def _passes_unseen(point, ahead, located):
    """Return whether a step passes an orbit of more symmetry without the fold that belongs there.

    The step has then led from one branch to the other.
    """
    folds = any(event.kind == "fold" for event in located)
    return not folds and _deviation(point.orbit) @ _deviation(ahead.orbit) < 0


def _through_grazing(point, reach):
    """Return the pieces of a branch through a grazing within reach, [] if there is none.

    Each piece is a point, the next one, the events between, and the number of those not located.
    """
    passage = through_grazing(point, reach)
    if passage is None:
        return []
    pieces, at = [], passage.points
    before, after = point.orbit.sequence, at[-1].orbit.sequence
    for k, (start, ahead) in enumerate(zip(at, at[1:], strict=False)):
        places = passage.heights[k], passage.heights[k + 1]
        located, missed = bifurcations_between(passage.between(k), start, ahead, *places)
        located = [event for _, event in located]
        if k + 1 == passage.grazing:
            located.append(Event(passage.kind, ahead, before, after))
        pieces.append((start, ahead, located, missed))
    return pieces


def _deviation(orbit: Orbit):
    """Return the difference, shape (4,), of an orbit from one of more symmetry.

    The branches of both orbits meet where the difference changes sign. The other orbit is the
    symmetric one if the period n is odd, and one of half the period if n is even. A symmetric orbit
    has no such branch to meet; the difference is then replaced by ones.
    """
    if orbit.root is not None:
        return np.ones(4)
    half = orbit.at(orbit.phase + orbit.periods * np.pi)
    return orbit.state + half if orbit.periods % 2 else orbit.state - half


def _up_to_fold(events, kind):
    """Drop events after the first fold and relabel that fold as `kind`.

    Returns the events, and whether there was a fold.
    """
    for k, event in enumerate(events):
        if event.kind == "fold":
            return [*events[:k], event._replace(kind=kind)], True
    return events, False


def _next(point, span, length):
    """Return the next point and the factor by which the length of the step after it may change.

    The point lies at the end of the range if the step would leave it. It is None if Newton's
    method fails, if the branch turns by too much, or if the point lies on another branch.
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


def _loss(last):
    """Return why a branch ends at a point beyond which Newton's method finds no other."""
    orbit = last.orbit
    if orbit.touching and np.max(np.abs(orbit.contacts[:, 3])) < WEAK:
        return "contact_lost"
    return "lost"


def _passes(point, ahead, first):
    """Return the place on the step between two points at which the branch began, or None.

    The parameter changes there in the same direction as at the beginning.
    """
    forward = (ahead.value - point.value) * first.tangent[-1] > 0
    if not forward or (point.value - first.value) * (ahead.value - first.value) > 0:
        return None
    again = between.at_value(point, ahead, first.value)
    return again if again is not None and first.orbit.is_same(again.orbit, SAME) else None


def _is_between(start, point, ahead):
    """Return whether a point of a step lies before another one."""
    row = start.problem.metric * start.tangent
    return bool(row @ (point.x - start.x) < row @ (ahead.x - start.x))
