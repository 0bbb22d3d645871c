"""Follow a branch through a grazing, at which a contact appears, vanishes, or parts in two.

Beside a grazing the branch turns sharply, often while the parameter changes by less than 1e-8.
There it is followed in steps of the height |Z2| - d0 of the extremum of Z2 that reaches its wall:
as functions of the height the orbits are smooth up to a term of power 3/2.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import CLEARANCE, FREQUENCY
from impact_damper.orbits.continuation import NEWTON, Point, recut
from impact_damper.orbits.paths import POINTS
from impact_damper.orbits.sensitivity import Variations, path_of

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


def at_height(problem, x, turn, height, direction, exact=True):
    """Return the point of a branch at which an extremum has a given height, and the extremum."""
    x = x.copy()
    for _ in range(NEWTON):
        orbit = problem.shoot(x)
        if exact:
            reached = nearest(turns_of(problem, x, orbit, turn.segment), turn)
        else:
            reached = moved(orbit, turn)
        if reached is None:
            return None
        turn, missing = reached, height - reached.height
        settled = orbit.converged and abs(missing) < CLOSE * abs(height) + ROUNDING
        rows = problem.rows(x, orbit, known=(turn.segment, turn.by_parameter))
        matrix, last = np.vstack([rows, turn.gradient]), np.eye(len(x))[-1]
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
            where = start.problem, x, turn, height, direction
            found = at_height(*where, exact=False) or at_height(*where)
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
        segments, and the parameter; shape (4 m + 1,). It may be unknown.
    by_parameter: Derivative of the state at the end of the segment by the parameter, without the
        change of sign at the end of a symmetric orbit's half period; shape (4,).
    """

    segment: int
    phase: float
    outer: bool
    height: float
    gradient: np.ndarray | None = None
    by_parameter: np.ndarray | None = None


def _listed(orbit):
    """Return all extrema of an orbit without their derivatives."""
    return [Turn(int(row[0]), row[1], bool(row[2]), row[3]) for row in orbit.turns()]


def turns_of(problem, x, orbit, segment=None):
    """Return a list of all extrema of an orbit, or of one segment, whose gradients are known.

    `problem` is the `continuation.Problem` of the branch, and x are the unknowns of the orbit. The
    entries are `Turn`.
    """
    rate = problem.rate(x[-1])
    turns = []
    for k in range(len(problem.phases) - 1) if segment is None else [segment]:
        path = path_of(orbit, k)
        steps, sizes, weights, times = path.turns(1)
        if not len(steps):
            continue
        variations = Variations(path, rate[:, None])
        try:
            change = variations.changes(np.zeros((4, 1)), np.eye(1))[2, 0]
        except np.linalg.LinAlgError:
            # After many inelastic contacts the derivative of the motion by its first state is
            # singular up to rounding errors. The gradients of the segment are then not known.
            continue
        by_parameter = variations.slopes()[:, 0]
        for step, size, weight, time in zip(steps, sizes, weights, times, strict=True):
            wall, part = np.sign(size), slice(step * POINTS, (step + 1) * POINTS)
            gradient = np.zeros(len(x))
            gradient[4 * k : 4 * k + 4] = wall * (path.tangents[2, :, part] @ weight)
            gradient[-1] = wall * (change[part] @ weight) - rate[CLEARANCE]
            before = path.times[part] < time
            speed = wall * path.states[3, part]
            outer = (speed[before][-1] if before.any() else -speed[~before][0]) > 0
            height = wall * size - orbit.p[CLEARANCE]
            phase = orbit.p[FREQUENCY] * time
            turns.append(Turn(k, phase, bool(outer), height, gradient, by_parameter))
    return turns


def nearest(turns, turn):
    """Return the extremum that corresponds to a given one, or None.

    It is the closest in phase, at a distance of less than MOVED. A maximum of |Z2| is preferred for
    a maximum, a minimum for a minimum.
    """
    near = [each for each in turns if abs(each.phase - turn.phase) < MOVED]
    near = [each for each in near if each.outer == turn.outer] or near
    return min(near, key=lambda each: abs(each.phase - turn.phase), default=None)


def moved(orbit, turn):
    """Return an extremum with its phase and height on another orbit nearby, or None."""
    found = nearest([each for each in _listed(orbit) if each.segment == turn.segment], turn)
    return found and turn._replace(phase=found.phase, outer=found.outer, height=found.height)


def next_grazing(point, reach):
    """Return the extremum that first reaches its wall along the tangent of a point, or None."""
    problem, candidates = point.problem, []
    ahead = problem.shoot(point.x + SHIFT * point.tangent)
    for turn in _listed(point.orbit):
        near = moved(ahead, turn)
        distance = SHIFT * turn.height / (turn.height - near.height or np.inf) if near else 0.0
        if 0 < distance < 2 * reach:
            candidates.append((distance, turn))
    for _, turn in sorted(candidates):
        turn = nearest(turns_of(problem, point.x, point.orbit, turn.segment), turn)
        rate = turn.gradient @ point.tangent if turn else 0.0
        if rate and 0 < -turn.height / rate < reach:
            return turn
    return None
