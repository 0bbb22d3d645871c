"""Follow a branch through a grazing, at which a contact appears, vanishes, or parts in two.

Beside a grazing the branch turns sharply, often while the parameter changes by less than 1e-8.
There it is followed in steps of the height |Z2| - d0 of the extremum of Z2 that reaches its wall:
as functions of the height the orbits are smooth up to a term of power 3/2.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import CLEARANCE
from impact_damper.motions.segment_runs import slopes_of_ends
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.orbits import segments
from impact_damper.orbits.continuation import NEWTON, Point, recut

# On the side with more contacts the heights of successive points are LEAST, RATIO * LEAST, ... up
# to MOST in modulus.
RATIO, LEAST, MOST = 10.0, 1e-13, 2e-5
# If a step to the next height fails, or leads to another branch, it is divided.
# HALVINGS: largest number of such divisions on the way through a grazing.
# HALVINGS_BETWEEN: the same between two points found before.
HALVINGS, HALVINGS_BETWEEN = 8, 3
# `Orbit.deviation` is 0 for an orbit of more symmetry. The branch was left for a branch of more
# symmetry if the deviation of an orbit is less than FALLEN times that of the orbit before.
FALLEN = 0.01
# Heights of the points on the side with fewer contacts.
BESIDE = 1e-9, 2e-5
# Newton's method.
# LARGEST: largest size of a correction.
# CLOSE, ROUNDING: largest relative and absolute error of the height.
LARGEST, CLOSE, ROUNDING = 0.5, 1e-4, 1e-14


def at_height(problem, x, turn, height, direction):
    """Return the point of a branch at which an extremum has a given height, and the extremum."""
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

    points: In order along the branch. The first point is the one before the grazing, with the orbit
        cut into new segments.
    heights: Heights of the extremum at the points.
    turns: The extremum at the points.
    grazing: Index of the point closest to the grazing, on the side with more contacts.
    kind: "grazing" if a contact appears or vanishes in flight, "merging" if it parts in two or two
        contacts become one.
    """

    points: list
    heights: list
    turns: list
    grazing: int
    kind: str

    def between(self, k):
        """Return a function that returns the point at a height between points k and k + 1."""
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
    """Return the unknowns on the tangent of a point at which an extremum has a given height.

    The height is extrapolated linearly.
    """
    return point.x + (height - turn.height) / (turn.gradient @ point.tangent) * point.tangent


def through_grazing(point, reach):
    """Follow a branch through the next grazing."""
    turn = next_grazing(point, reach)
    if turn is None:
        return None
    point = recut(point, between=(turn.phase,))
    turn = next_grazing(point, 2 * reach)
    if turn is None:
        return None
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
    """Follow a branch from height to height, as far as Newton's method succeeds."""
    points, heights, turns = [point], [turn.height], [turn]
    pending, halvings = targets[::-1], 0
    while pending and halvings <= HALVINGS:
        target = pending.pop()
        ratio = target / heights[-1]
        x = guess(points[-1], turns[-1], target)
        found = at_height(point.problem, x, turns[-1], target, direction)
        stays = found is not None and len(found[0].orbit.sequence) == contacts(target)
        if stays and (ratio < 0 or not _has_left(points[-1].orbit, found[0].orbit)):
            points.append(found[0])
            heights.append(target)
            turns.append(found[1])
        else:
            pending += [target, _before(heights[-1], target)]
            halvings += 1
    return points, heights, turns


def _before(height, target):
    """Return a height between two heights, at which a failed step is divided.

    If both heights have the same sign, it is their geometric mean. Otherwise it is close to the
    grazing.
    """
    if height * target > 0:
        return height * (target / height) ** 0.5
    return height / 2 if abs(height) > abs(target) else target / RATIO


def _has_left(orbit, ahead):
    """Return whether the orbit `ahead` lies on another branch, whose orbits have more symmetry."""
    return np.max(np.abs(ahead.deviation)) < FALLEN * np.max(np.abs(orbit.deviation))


def _targets(height, sharp, direction):
    """Return a list of the heights of the points from one side of a grazing to the other."""
    fine = LEAST * RATIO ** np.arange(1 + int(np.log(MOST / LEAST) / np.log(RATIO)))
    if direction == sharp:
        return list(sharp * fine)
    inside = fine[fine < abs(height) / RATIO**0.5]
    return [*(sharp * inside[::-1]), *(direction * height for height in BESIDE)]


# Distance along the tangent of a branch over which the change of a height is estimated.
SHIFT = 1e-10
# An extremum on another orbit counts as the same if its phase differs by less than MOVED (radian).
MOVED = 0.1


class Turn(NamedTuple):
    """An extremum of Z2.

    segment: Index of the segment of the orbit.
    phase: W T, radian.
    outer: True if |Z2| has a maximum, False if it has a minimum.
    height: |Z2| - d0.
    gradient: Derivative of the height by the unknowns: the states at the beginnings of the m
        segments, and the parameter; shape (4 m + 1,). None if unknown.
    """

    segment: int
    phase: float
    outer: bool
    height: float
    gradient: np.ndarray | None = None


def turns_of(orbit):
    """Return all extrema of an orbit without their gradients."""
    return [Turn(int(row[0]), row[1], bool(row[2]), row[3]) for row in orbit.turns()]


def with_gradient(problem, x, orbit, turn):
    """Return an extremum of the orbit at the unknowns x of a `continuation.Problem`, with gradient.

    The velocity of Z2 is zero there, so the height changes like Z2 at a constant phase.
    """
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
    """Return the extremum in the same segment that corresponds to a given one, or None.

    It is the closest in phase, at a distance of less than MOVED. A maximum of |Z2| is preferred for
    a maximum, a minimum for a minimum.
    """
    near = [each for each in turns if each.segment == turn.segment]
    near = [each for each in near if abs(each.phase - turn.phase) < MOVED]
    near = [each for each in near if each.outer == turn.outer] or near
    return min(near, key=lambda each: abs(each.phase - turn.phase), default=None)


def next_grazing(point, reach):
    """Return the extremum that first reaches its wall along the tangent of a point, or None."""
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
