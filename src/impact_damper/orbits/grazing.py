"""Follow a branch through a grazing, at which an extremum of Z2 reaches a wall.

The height of an extremum is the value of |Z2| - d0 there. Near a grazing a branch turns sharply, so
points of the branch are computed at chosen heights of the extremum. In all functions `direction` is
1 if the heights rise along the branch, and -1 if they fall.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import CLEARANCE
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.orbits import segments
from impact_damper.orbits.continuation import NEWTON, Point, recut
from impact_damper.orbits.segments import list_turns, slopes_of_ends

# On one side of a grazing the orbits of a branch have more contacts than on the other side. On the
# side with more contacts, points are computed at which the extremum of Z2 is LEAST, LEAST x RATIO,
# LEAST x RATIO^2, ... up to MOST away from the wall.
RATIO, LEAST, MOST = 10.0, 1e-13, 2e-5
# If a step between two heights |Z2| - d0 fails, a height between them is tried first. This is done
# at most HALVINGS times in each grazing, and HALVINGS_BETWEEN times in a row in `Passage.between`.
HALVINGS, HALVINGS_BETWEEN = 8, 3
# A step that multiplies max |`Orbit.deviation`| by less than this led to a more symmetric branch.
FALLEN = 0.01
# If contacts vanish in a grazing, the branch is computed at two points on the side without them. At
# these points the extremum of Z2 is BESIDE[0] and BESIDE[1] away from the wall.
BESIDE = 1e-9, 2e-5
# Newton's method fails if it must change an unknown by LARGEST or more. It has converged only if
# the height |Z2| - d0 of the extremum has an error below CLOSE x |height| + ROUNDING.
LARGEST, CLOSE, ROUNDING = 0.5, 1e-4, 1e-14


def at_height(problem, x, turn, height, direction):
    """Find a point near the unknowns x. On its orbit the extremum of Z2 near `turn` has `height`.

    Return the point and the extremum, or None if Newton's method fails. Along the tangent of the
    point, heights rise if `direction` is 1, and fall if it is -1.
    """
    x = x.copy()
    for _ in range(NEWTON):
        orbit = problem.shoot(x)
        turn = nearest(turns_of(orbit), turn)
        if turn is None:
            return None
        turn, missing = with_gradient(problem, x, orbit, turn), height - turn.height
        settled = orbit.converged and abs(missing) < CLOSE * abs(height) + ROUNDING
        matrix, last = np.vstack([problem.rows(x, orbit), turn.gradient]), np.eye(len(x))[-1]
        try:
            if settled:
                tangent = direction * np.linalg.solve(matrix, last)
                tangent /= problem.length(tangent)
                return Point(x[-1], orbit, x, tangent, problem), turn
            change = np.linalg.solve(matrix, np.append(-orbit.defects.ravel(), missing))
        except np.linalg.LinAlgError:
            return None
        if not np.max(np.abs(change)) < LARGEST:
            return None
        x += change
    return None


class Passage(NamedTuple):
    """Points of a branch through a grazing.

    turns[k] is the extremum that grazes, on the orbit of points[k]. heights[k] is its |Z2| - d0.
    Orbits have more contacts on one side of the grazing. On this side points[grazing] is the point
    closest to the grazing. `kind` is as in `bifurcations.Event`.
    """

    points: list
    heights: list
    turns: list
    grazing: int
    kind: str

    def between(self, k):
        """Return a function of the height that finds points between points[k] and points[k + 1]."""
        known = [(self.heights[end], self.points[end], self.turns[end]) for end in (k, k + 1)]
        direction = np.sign(self.heights[k + 1] - self.heights[k])

        def point_at(height, halvings=HALVINGS_BETWEEN):
            near, start, turn = min(known, key=lambda each: abs(each[0] - height))
            x = guess(start, turn, height)
            found = at_height(start.problem, x, turn, height, direction)
            if found is None and halvings == 0:
                raise ArithmeticError
            if found is None:
                point_at((near + height) / 2, halvings - 1)
                return point_at(height, halvings - 1)
            known.append((height, *found))
            return found[0]

        return point_at


def guess(point, turn, height):
    """Return unknowns on the tangent of `point` at which the extremum `turn` has about `height`."""
    return point.x + (height - turn.height) / (turn.gradient @ point.tangent) * point.tangent


def through_grazing(point, reach):
    """Return the `Passage` through the next grazing, at most `reach` ahead of `point`, or None."""
    turn = next_grazing(point, reach)
    if turn is None:
        return None
    point = recut(point, between=(turn.phase,))
    turn = next_grazing(point, 2 * reach)
    if turn is None:
        return None
    # The orbits have more contacts on the side of the grazing where `sharp` x height is positive.
    sharp = 1 if turn.outer else -1
    direction = int(np.sign(turn.gradient @ point.tangent))
    targets = _targets(turn.height, sharp, direction)
    one = 2 if point.problem.symmetric else 1
    fewest = len(point.orbit.sequence) - one * (direction != sharp)

    def contacts(height):
        return fewest + one * (sharp * height > 0)

    points, heights, turns = _along(point, turn, targets, direction, contacts)
    grazing = [k for k, height in enumerate(heights) if abs(height) == LEAST]
    if not grazing:
        return None
    return Passage(points, heights, turns, grazing[0], "grazing" if turn.outer else "merging")


def _along(point, turn, targets, direction, contacts):
    points, heights, turns = [point], [turn.height], [turn]
    pending, halvings = targets[::-1], 0
    while pending and halvings <= HALVINGS:
        target = pending.pop()
        ratio = target / heights[-1]
        x = guess(points[-1], turns[-1], target)
        found = at_height(point.problem, x, turns[-1], target, direction)
        # An orbit without the expected number of contacts lies on another branch.
        stays = found is not None and len(found[0].orbit.sequence) == contacts(target)
        if stays and ratio > 0:
            sizes = [np.max(np.abs(each.orbit.deviation)) for each in (points[-1], found[0])]
            stays = not sizes[1] < FALLEN * sizes[0]
        if stays:
            points.append(found[0])
            heights.append(target)
            turns.append(found[1])
        else:
            pending += [target, _before(heights[-1], target)]
            halvings += 1
    return points, heights, turns


def _before(height, target):
    if height * target > 0:
        return height * (target / height) ** 0.5
    return height / 2 if abs(height) > abs(target) else target / RATIO


def _targets(height, sharp, direction):
    fine = LEAST * RATIO ** np.arange(1 + int(np.log(MOST / LEAST) / np.log(RATIO)))
    if direction == sharp:
        return list(sharp * fine)
    inside = fine[fine < abs(height) / RATIO**0.5]
    return [*(sharp * inside[::-1]), *(direction * height for height in BESIDE)]


# A point is moved by this length along its tangent to estimate how heights of extrema change.
SHIFT = 1e-10
# At first the list of extrema has room for TURNS extrema in each segment.
TURNS = 256
# Extrema of two neighbouring orbits correspond if their phases (radian) differ by less than MOVED.
MOVED = 0.1


class Turn(NamedTuple):
    """An extremum of Z2 on an orbit: index of the segment, phase W T, and height |Z2| - d0.

    `outer` is True for a maximum of |Z2|. `gradient` is the derivative of the height by the
    unknowns `continuation.Point.x`, or None before it is computed.
    """

    segment: int
    phase: float
    outer: bool
    height: float
    gradient: np.ndarray | None = None


def turns_of(orbit):
    """Return all extrema of Z2 on an orbit as a list of `Turn`, without gradients."""
    count = room = TURNS * len(orbit.states)
    while count >= room:
        room = count + 1
        rows = np.empty((room, 4))
        count = list_turns(orbit.p, orbit.states.copy(), orbit.phases, POLISH_TOLERANCE, rows)
    return [Turn(int(row[0]), row[1], bool(row[2]), row[3]) for row in rows[:count]]


def with_gradient(problem, x, orbit, turn):
    """Return the extremum `turn` with its gradient: the derivative of |Z2| - d0 by unknowns x."""
    k, rate = turn.segment, problem.rate(x[-1])
    phases, begin = np.array([orbit.phases[k], turn.phase]), orbit.states[k]
    end, tangents, slopes = begin.copy(), np.eye(4), np.empty((1, 4))
    segments.run(orbit.p, end, tangents, *phases)
    slopes_of_ends(orbit.p, rate, phases, begin[None], end[None], 1, POLISH_TOLERANCE, slopes)
    gradient = np.zeros(len(x))
    gradient[4 * k : 4 * k + 4] = np.sign(end[2]) * tangents[:, 2]
    gradient[-1] = np.sign(end[2]) * slopes[0, 2] - rate[CLEARANCE]
    return turn._replace(gradient=gradient)


def nearest(turns, turn):
    """Return the extremum in `turns` closest in phase to `turn`, or None if all are too far."""
    near = [each for each in turns if each.segment == turn.segment]
    near = [each for each in near if abs(each.phase - turn.phase) < MOVED]
    near = [each for each in near if each.outer == turn.outer] or near
    return min(near, key=lambda each: abs(each.phase - turn.phase), default=None)


def next_grazing(point, reach):
    """Return the extremum of Z2 that grazes first along the tangent of `point`, within `reach`."""
    problem, candidates = point.problem, []
    ahead = turns_of(problem.shoot(point.x + SHIFT * point.tangent))
    for turn in turns_of(point.orbit):
        near = nearest(ahead, turn)
        distance = SHIFT * turn.height / (turn.height - near.height or np.inf) if near else 0.0
        if 0 < distance < 2 * reach:
            candidates.append((distance, turn))
    for _, turn in sorted(candidates, key=lambda pair: pair[0]):
        turn = with_gradient(problem, point.x, point.orbit, turn)
        rate = turn.gradient @ point.tangent
        if rate and 0 < -turn.height / rate < reach:
            return turn
    return None
