"""Switch to the branch that leaves where an orbit loses its symmetry or doubles its period.

The orbits of the other branch are not symmetric, or have twice the period. They solve other
equations than the orbits of the first branch. At the point where the branches meet, the matrix of
derivatives of these equations has two null vectors. On the other branch, the parameter changes with
the square of the distance from the point. This branch therefore begins in the direction of the
combination of the null vectors that does not change the parameter.
"""

import numpy as np

from impact_damper.orbits.continuation import SYMMETRIC, Point, Problem
from impact_damper.orbits.shooting import shoot

# DISTANCES: distances from the bifurcation at which an orbit of the other branch is searched for,
# one after the other. ASIDE: largest distance between the first guess and the orbit found by
# Newton's method, divided by the distance from the bifurcation.
DISTANCES, ASIDE = (2e-2, 4e-3, 8e-4), 0.5
LEAVING = ("symmetry_breaking", "period_doubling")


def other_branch(event) -> Point | None:
    """Return a point, close to a bifurcation, of the branch that leaves there.

    Parameters
    ----------
    event : Event
        A loss of symmetry or a period doubling.

    Returns
    -------
    Point or None
        None if Newton's method finds no orbit of less symmetry or of twice the period.

    Raises
    ------
    ValueError
        If the event is of another kind.
    """
    if event.kind not in LEAVING:
        raise ValueError(f"event = {event.kind!r}: must be one of {', '.join(LEAVING)}")
    point = event.point
    doubled = event.kind == "period_doubling"
    periods = point.orbit.periods * (2 if doubled else 1)
    orbit, _ = shoot(point.orbit.p, point.orbit.state, periods, point.orbit.phase)
    problem = Problem.of(point.problem.family, orbit, symmetric=False)
    x = problem.unknowns(orbit, point.value)
    null = np.linalg.svd(problem.rows(x, orbit))[2][-2:]
    first, second = null[:, -1]
    leaving = null.T @ [-second, first] / np.hypot(first, second)
    for distance in DISTANCES:
        guess = x + distance * leaving
        near = problem.correct(guess, leaving)
        if near is None or problem.length(near.x - guess) > ASIDE * distance:
            continue
        if doubled and not near.orbit.repeats_sooner():
            return near
        if not doubled and near.orbit.record["asymmetry"] > SYMMETRIC:
            return near
    return None
