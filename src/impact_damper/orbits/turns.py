"""The extrema of Z2 on an orbit, with their derivatives, and the next one that reaches its wall.

Z2 is the displacement of the primary mass relative to the loose mass, d0 the clearance and W T the
phase of the forcing. The height of an extremum is |Z2| - d0, which is positive in contact. A branch
is the curve of the periodic orbits over a parameter. A grazing is a point of a branch at which an
extremum has the height 0. Strongly unstable orbits are cut into segments (`segments`).
"""

from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import CLEARANCE, FREQUENCY
from impact_damper.orbits.paths import POINTS
from impact_damper.orbits.sensitivity import path_of
from impact_damper.orbits.variations import Variations

# Distance along the tangent of a branch over which the change of a height is estimated.
SHIFT = 1e-10
# An extremum on another orbit counts as the same if its phase differs by less than MOVED (radian).
MOVED = 0.1


class Found(NamedTuple):
    """An extremum of Z2 without its derivatives: the first four attributes of a `Turn`."""

    segment: float
    phase: float
    outer: float
    height: float


class Turn(NamedTuple):
    """An extremum of Z2.

    Attributes
    ----------
    segment : int
        Index of the segment of the orbit.
    phase : float
        W T, radian.
    outer : bool
        True if |Z2| has a maximum, False if it has a minimum.
    height : float
        |Z2| - d0.
    gradient : numpy.ndarray, shape (4 m + 1,)
        Derivative of the height by the unknowns: the states at the beginnings of the m segments,
        and the parameter.
    by_parameter : numpy.ndarray, shape (4,)
        Derivative of the state at the end of the segment by the parameter, without the change of
        sign at the end of a symmetric orbit's half period.
    """

    segment: int
    phase: float
    outer: bool
    height: float
    gradient: np.ndarray
    by_parameter: np.ndarray


def turns_of(problem, x, orbit, segment=None):
    """Return a list of all extrema of an orbit, or of one segment, whose gradients are known.

    `problem` is the `continuation.Problem` of the branch, and x are the unknowns of the orbit. The
    entries are `Turn`.
    """
    rate = problem.rate(x[-1])
    turns = []
    for k in range(len(problem.phases) - 1) if segment is None else [segment]:
        path = path_of(orbit) if orbit.chain is None else orbit.chain.path(k)
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


def moved(problem, x, orbit, turn):
    """Return an extremum with its phase and height on another orbit nearby, or None.

    x are the unknowns of the other orbit. The derivatives of the extremum are kept.
    """
    chain = orbit.chain or problem.flow(x)
    found = nearest([Found(*row) for row in chain.turns(turn.segment)], turn)
    return found and turn._replace(phase=found.phase, outer=bool(found.outer), height=found.height)


def next_grazing(point, reach):
    """Return the extremum that first reaches its wall along the tangent of a point, or None.

    Parameters
    ----------
    point : Point
    reach : float
        Largest distance along the tangent.
    """
    problem, candidates = point.problem, []
    here, ahead = (problem.flow(point.x + shift * point.tangent).turns() for shift in (0.0, SHIFT))
    for row in here:
        turn = Found(*row)
        moved = nearest([Found(*other) for other in ahead[ahead[:, 0] == turn.segment]], turn)
        distance = SHIFT * turn.height / (turn.height - moved.height or np.inf) if moved else 0.0
        if 0 < distance < 2 * reach:
            candidates.append((distance, turn))
    for _, turn in sorted(candidates):
        turn = nearest(turns_of(problem, point.x, point.orbit, int(turn.segment)), turn)
        rate = turn.gradient @ point.tangent if turn else 0.0
        if rate and 0 < -turn.height / rate < reach:
            return turn
    return None
