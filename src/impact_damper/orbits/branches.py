"""Follow a branch of periodic orbits from one orbit towards smaller and larger parameters."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from impact_damper.orbits import continuation
from impact_damper.orbits.bifurcations import Event, bifurcations_between, events_between
from impact_damper.orbits.grazing import through_grazing
from impact_damper.orbits.segments import NUDGE

# A branch is followed over at most this number of orbits in each direction from its first orbit.
MOST_POINTS = 10_000
# Two orbits are the same if their states at W T = pi/2 differ by less than SAME.
SAME = 1e-5
# `Branch.holds` searches for an orbit on a step only if max |Z1| at the first point of the step
# differs from max |Z1| of the orbit by at most NEARBY + the change of max |Z1| along the step.
NEARBY = 0.02
# `Branch.family` is extrapolated to parameters at most this far outside the range of the branch.
EXTENDED = 1e-3
# A branch ends as "contact_lost" if each contact of its last orbit begins with |Z2'| below WEAK.
WEAK = 0.02
# A branch meets a more symmetric branch at a fold if max |`Orbit.deviation`| at the fold is below
# VANISHED times its value at the point before the fold.
VANISHED = 0.5
# A grazing is searched for if the sequence of contacts changes on a step, or if a step shorter than
# CLOSE_STEP fails. The search reaches as far as REACH times the length of the step. If no grazing
# is found although the sequence changes, the step is halved, unless it is shorter than CLOSE_STEP.
CLOSE_STEP, REACH = 2e-3, 8.0
# A step longer than CLEAR_STEP is halved if it may contain two folds, or if an event on the step
# was not located.
CLEAR_STEP = 1e-4


@dataclass(frozen=True)
class Branch:
    """A branch of orbits. `family(value)` is the array `p` of all parameters for a point's `value`.

    events: Pairs (k, event), where points[k] is the point of the event.
    lost: Number of events that were not located.
    ends: Two words that say why the branch ends at its first and at its last point. "range_ends":
    The parameter is at the end of its range. "closed": The branch is a closed curve. "unstable":
    Too many orbits are unstable. "lost": Newton's method fails. "point_limit": There are
    MOST_POINTS points. "symmetry_breaking": The branch meets a branch of symmetric orbits.
    "period_doubling": It meets a branch of half the period. "contact_lost": All contacts are slow.
    """

    family: Callable[[float], np.ndarray]
    points: list[continuation.Point]
    events: list[tuple[int, Event]]
    ends: tuple[str, str]
    lost: int

    @cached_property
    def values(self):
        """Value of the parameter at each of the points."""
        return np.array([point.value for point in self.points])

    @cached_property
    def displacements(self):
        """Largest |Z1| at each of the points."""
        return np.array([point.orbit.record["maximum_displacement"] for point in self.points])

    def holds(self, orbit, value) -> bool:
        """Return whether the branch contains `orbit`, where `value` is the orbit's parameter."""
        if orbit.periods != self.points[0].orbit.periods:
            return False
        away = self.values - value
        size = self.displacements
        closeness = np.abs(size[:-1] - orbit.record["maximum_displacement"])
        crossing = (away[:-1] * away[1:] <= 0) & (closeness <= NEARBY + np.abs(np.diff(size)))
        for k in np.flatnonzero(crossing):
            step = self.points[k], self.points[k + 1]
            for start, other in (step, step[::-1]):
                near = between(start, other, value)
                if near is not None and near.orbit.is_same(orbit, SAME):
                    return True
        return False


def between(point, ahead, value):
    """Return the point with the parameter `value` between `point` and `ahead`.

    The two orbits may have different segments. If Newton's method fails, return None.
    """
    if np.array_equal(point.problem.phases, ahead.problem.phases):
        return continuation.point_at_value(point, ahead, value)
    return point.problem.at_value(point, value)


def follow_branch(family, orbit, value, span, beyond=np.inf) -> Branch:
    """Follow the branch of an orbit to smaller and to larger parameters, within the range `span`.

    `value` is the orbit's parameter. `family(value)` returns the array `p` of all parameters. In
    each direction the branch ends as soon as more than `beyond` orbits in a row are unstable.
    """
    family = _extended(family, span)
    problem = continuation.Problem.of(family, orbit)
    x, walks = problem.unknowns(orbit, value), []
    for direction in (-1, 1):
        first = problem.correct(x, direction * np.eye(len(x))[-1])
        if first is None:
            raise ArithmeticError(f"no orbit of the family at {value:g} close to the one given")
        walks.append(_walk(problem, first, span, beyond))
        if walks[-1].ends[1] == "closed":
            return replace(walks[-1], ends=("closed", "closed"))
    down, up = walks
    count = len(down.points) - 1
    events = [
        (count - k, event._replace(before=event.after, after=event.before))
        for k, event in reversed(down.events)
    ]
    events += [(count + k, event) for k, event in up.events]
    points = down.points[:0:-1] + up.points
    return Branch(family, points, events, (down.ends[1], up.ends[1]), down.lost + up.lost)


def _extended(family, span):
    def extended(value):
        try:
            return family(value)
        except ValueError:
            end = float(np.clip(value, *span))
            if not 0 < abs(value - end) <= EXTENDED:
                raise
            inside = np.copysign(NUDGE, value - end)
            last, before = family(end), family(end - inside)
            change = np.subtract(last, before, out=np.zeros(len(last)), where=last < np.inf)
            return last + (value - end) / inside * change

    return extended


def _walk(problem, first, span, beyond) -> Branch:
    """Return the part of a branch from the point `first` on, in the direction of its tangent."""
    points, events, lost, end, idle = [first], [], 0, "", 0
    if (first.value - span[0]) * (first.value - span[1]) >= 0:
        outward = np.sign(first.value - sum(span) / 2) * first.tangent[-1] > 0
        end = "range_ends" if outward else ""
    if not continuation.holds_still(first):
        points[0] = first = continuation.recut(first)
    length, tried = continuation.FIRST_STEP, None
    while not end and len(points) < MOST_POINTS:
        point = points[-1]
        pieces, factor, searched = _next_pieces(point, span, length, tried is not point)
        tried = point if searched else tried
        if not pieces:
            length *= factor
            if length < continuation.SHORTEST_STEP:
                slow = np.max(np.abs(point.orbit.contacts[:, 3]), initial=0.0) < WEAK
                end = "contact_lost" if point.orbit.touching and slow else "lost"
            continue
        for piece in pieces:
            start, ahead, _, missed = piece
            end, located, unmet = _ending(piece, first if len(points) > 2 else None, span)
            lost += missed + unmet
            for event in located:
                events.append((len(points), event))
                if event.point is not ahead:
                    points.append(event.point)
            if end in ("", "range_ends", "closed"):
                points.append(first if end == "closed" else ahead)
            idle = 0 if ahead.orbit.stable else idle + 1
            if not end and idle > beyond:
                end = "unstable"
            if end:
                break
        if not end:
            coarse = not (problem.symmetric or ahead.orbit.stable)
            size = max(ahead.problem.length(ahead.x), continuation.SMALLEST)
            longest = size * (continuation.LONGEST_UNSTABLE if coarse else continuation.LONGEST)
            length = min(factor * ahead.problem.length(ahead.x - start.x), longest)
            if not continuation.holds_still(ahead):
                points[-1] = continuation.recut(ahead)
            elif len(pieces) == 1:
                points[-1] = continuation.with_bend(start, ahead)
    return Branch(problem.family, points, events, ("", end or "point_limit"), lost)


def _next_pieces(point, span, length, search):
    """Make a step of about `length` from `point`. Return three results.

    1. A list of pieces (see `_through_grazing`), or [] if a shorter step must be tried.
    2. The factor by which to multiply `length` for the next step.
    3. Whether a grazing was searched for. This is done only if `search` is True.
    """
    ahead, factor = continuation.next_point(point, span, length)
    changes = ahead is not None and ahead.orbit.sequence != point.orbit.sequence
    close = ahead is None and length < CLOSE_STEP and point.problem.damped
    search = search and (changes or close)
    if search:
        pieces = _through_grazing(point, max(length, continuation.SHORTEST_STEP * 1e3) * REACH)
        if pieces:
            return pieces, factor, search
    if ahead is None:
        return [], factor, search
    if changes and length > CLOSE_STEP:
        return [], 0.5, search
    if length > CLEAR_STEP and continuation.folds_twice(point, ahead):
        return [], 0.5, search
    along = (point.problem.metric * (ahead.x - point.x)) @ point.tangent
    located, missed = events_between(point, ahead, along)
    # If `Orbit.deviation` reverses on the step, the branch met a more symmetric branch at a fold.
    crosses = point.orbit.deviation @ ahead.orbit.deviation < 0
    unseen = crosses and not any(event.kind == "fold" for event in located)
    if length > CLEAR_STEP and (missed or unseen):
        return [], 0.5, search
    return [(point, ahead, located, missed)], factor, search


def _ending(piece, first, span):
    """Find out whether a branch ends on a piece (see `_through_grazing`). Return three results.

    1. The kind of the end, as in `Branch.ends`, or "" if the branch does not end on this piece.
    2. The events on the piece. If the branch ends on it, only the events up to the end.
    3. What the caller must add to the number of events that were not located: 0 or 1.

    `first` is the branch's first point, or None if the branch has too few points to be closed.
    `span` is the range of the parameter.
    """
    start, ahead, located, missed = piece
    met = None
    if start.orbit.deviation @ ahead.orbit.deviation < 0:
        met = _meeting(located, start.orbit)
    if met is not None:
        end = "symmetry_breaking" if start.problem.periods % 2 else "period_doubling"
        last = [event._replace(kind=end) for event in located[met : met + 1]]
        return end, located[:met] + last, not last and not missed
    again = None if first is None else _passes(start, ahead, first)
    if again is not None:
        row = start.problem.metric * start.tangent
        return "closed", [each for each in located if row @ (each.point.x - again.x) < 0], 0
    beyond = ahead.value in span or np.clip(ahead.value, *span) != ahead.value
    return "range_ends" if beyond else "", located, 0


def _through_grazing(point, reach):
    """Follow a branch from `point` to shortly beyond the next grazing. Return a list of pieces.

    A piece is a tuple: a point, the next point, the events between these two points, and the number
    of events that were not located. Return [] if there is no grazing within `reach` from `point`.
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


def _meeting(events, orbit):
    folds = [k for k, event in enumerate(events) if event.kind == "fold"]
    least = VANISHED * np.max(np.abs(orbit.deviation))
    for k in folds:
        if np.max(np.abs(events[k].point.orbit.deviation)) < least:
            return k
    # If `events` has no fold, the branch meets another branch at a fold that was not located.
    return None if folds else len(events)


def _passes(point, ahead, first):
    forward = (ahead.value - point.value) * first.tangent[-1] > 0
    if not forward or (point.value - first.value) * (ahead.value - first.value) > 0:
        return None
    again = continuation.point_at_value(point, ahead, first.value)
    return again if again is not None and first.orbit.is_same(again.orbit, SAME) else None
