"""Follow a branch through a grazing, at which a contact appears, vanishes, or parts in two.

A branch is the curve of the periodic orbits over a parameter. Let h be the height |Z2| - d0 of an
extremum of Z2 (displacement relative to the loose mass) close to a wall, with the clearance d0. It
is positive in contact. On the side of h = 0 with more contacts, the force of the wall changes the
orbit by a term of the order |h|^(3/2) with a large factor. The multipliers change with the square
root of |h|, and the branch turns sharply, often while the parameter changes by less than 1e-8. Near
a grazing the branch is therefore followed in steps of h, not of its length. As functions of h the
orbits are smooth except for the term of power 3/2, so Newton's method at fixed h converges.
Derivatives by the parameter are integrated (`variations`), because difference quotients would reach
across the grazing.

Multipliers are Floquet multipliers. A branch may meet a branch of more symmetry, whose orbits are
symmetric or have half the period. In shapes, m is the number of segments of an orbit.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.orbits.continuation import NEWTON, Point
from impact_damper.orbits.cutting import recut
from impact_damper.orbits.turns import moved, nearest, next_grazing, turns_of

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
    """Return the point of a branch at which an extremum has a given height, and the extremum.

    Parameters
    ----------
    problem : Problem
    x : array, shape (4 m + 1,)
        First guess of the unknowns.
    turn : Turn
        The extremum near the guess.
    height : float
    direction : int
        1 if the height increases along the tangent of the point, -1 if it decreases.
    exact : bool
        Whether the derivatives of the extremum are computed, which is expensive. Otherwise those of
        `turn` are kept. Newton's method then converges from close guesses only, and the tangent of
        the point is approximate.
    """
    x = x.copy()
    for _ in range(NEWTON):
        orbit, defect = problem.shoot(x)
        if exact:
            reached = nearest(turns_of(problem, x, orbit, turn.segment), turn)
        else:
            reached = moved(problem, x, orbit, turn)
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
            change = np.linalg.solve(matrix, np.append(-defect, missing))
        except np.linalg.LinAlgError:
            return None
        if not np.max(np.abs(change)) < LARGEST:
            return None
        x += change
    return None


class Passage(NamedTuple):
    """Points of a branch through a grazing.

    Attributes
    ----------
    points : list of Point
        In order along the branch. The first point is the one before the grazing, with the orbit cut
        into new segments.
    heights : list of float
        Heights of the extremum at the points.
    turns : list of Turn
        The extremum at the points.
    grazing : int
        Index of the point closest to the grazing, on the side with more contacts.
    kind : str
        "grazing" if a contact appears or vanishes in flight, "merging" if it parts in two or two
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
    """Follow a branch through the next grazing.

    Parameters
    ----------
    point : Point
        A point of a branch with a damper.
    reach : float
        Distance along the tangent within which an extremum must reach its wall.

    Returns
    -------
    Passage or None
        None if no extremum reaches its wall, or if Newton's method fails at the grazing.
    """
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
    """Follow a branch from height to height, as far as Newton's method succeeds.

    Parameters
    ----------
    point : Point
    turn : Turn
        The extremum at the point.
    targets : list of float
        Heights in order.
    direction : int
        Sign of the change of height.
    contacts : callable
        Function that returns the number of contacts at a height.

    Returns
    -------
    points, heights, turns : list
        As in `Passage`.
    """
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
    """Return a list of the heights of the points from one side of a grazing to the other.

    Parameters
    ----------
    height : float
        Height of the extremum before the passage.
    sharp : int
        Sign of the height on the side with more contacts.
    direction : int
        Sign of the change of the height along the branch.
    """
    fine = LEAST * RATIO ** np.arange(1 + int(np.log(MOST / LEAST) / np.log(RATIO)))
    if direction == sharp:
        return list(sharp * fine)
    inside = fine[fine < abs(height) / RATIO**0.5]
    return [*(sharp * inside[::-1]), *(direction * height for height in BESIDE)]
