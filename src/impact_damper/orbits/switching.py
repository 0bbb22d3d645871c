"""Switch to the other branch where an orbit loses its symmetry or doubles its period.

There the derivative of the equations of the longer or less symmetric orbits has two null vectors.
The other branch leaves along the one without a change of the parameter, which changes with the
square of the distance.
"""

import numpy as np

from impact_damper.orbits.continuation import SYMMETRIC, Point, Problem
from impact_damper.orbits.shooting import shoot

# Distances from the bifurcation at which an orbit is looked for, and the largest correction of the
# guess as a share of the distance.
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
        found = problem.correct(guess, leaving)
        if found is None or problem.length(found.x - guess) > ASIDE * distance:
            continue
        if doubled and not found.orbit.repeats_sooner():
            return found
        if not doubled and found.orbit.record["asymmetry"] > SYMMETRIC:
            return found
    return None
