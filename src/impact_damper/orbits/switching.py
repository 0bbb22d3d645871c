"""Switch to the branch that leaves where an orbit loses its symmetry or doubles its period.

The orbits of the other branch are not symmetric, or have twice the period. They solve other
equations than the orbits of the first branch. At the point where the branches meet, the matrix of
derivatives of these equations has two null vectors. On the other branch, the parameter changes with
the square of the distance from the point. This branch therefore begins in the direction of the
combination of the null vectors that does not change the parameter.

Close to a grazing the other branch turns sharply: two contacts have just appeared, and the orbits
of the other branch soon lose one of them. There the branch is followed in the height of an extremum
(`grazing`) until its orbits differ clearly from the orbits of more symmetry.
"""

import numpy as np

from impact_damper.orbits.continuation import SYMMETRIC, Point, Problem
from impact_damper.orbits.grazing import at_height, through_grazing, turns_of
from impact_damper.orbits.shooting import shoot

# DISTANCES: distances from the bifurcation at which an orbit of the other branch is searched for,
# one after the other. ASIDE: largest distance between the first guess and the orbit found by
# Newton's method, divided by the distance from the bifurcation.
DISTANCES, ASIDE = (2e-2, 4e-3, 8e-4, 1e-4), 0.5
# Close to a grazing. SHARES: changes of the height at which an orbit is searched for, one after the
# other, as shares of the height. REACH: distance within which the other contact must vanish.
SHARES, REACH = (0.5, 0.2, 0.1, 0.05, 0.02), 1e-3
LEAVING = ("symmetry_breaking", "period_doubling")
# Largest distance of the orbit at which a branch ends from that of the branch that it meets there.
MEETING = 1e-3


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
        if _is_other(near.orbit, doubled):
            return near
    return _beside_grazing(problem, x, orbit, leaving, doubled) if problem.damped else None


def met_branch(point, kind) -> Point | None:
    """Return the point of the branch at which another one ends.

    Parameters
    ----------
    point : Point
        The last point of the branch that ends.
    kind : str
        symmetry_breaking or period_doubling.

    Returns
    -------
    Point or None
        A symmetric orbit, or one of half the period; None if Newton's method finds none there.
    """
    orbit, symmetric = point.orbit, kind == "symmetry_breaking"
    periods = orbit.periods // (1 if symmetric else 2)
    orbit, _ = shoot(orbit.p, orbit.state, periods, orbit.phase, symmetric=symmetric)
    problem = Problem.of(point.problem.family, orbit, symmetric=symmetric)
    x = problem.unknowns(orbit, point.value)
    found = problem.correct(x, np.eye(len(x))[-1])
    return None if found is None or problem.length(found.x - x) > MEETING else found


def _is_other(orbit, doubled):
    """Return whether an orbit clearly has the longer period, or is clearly not symmetric."""
    return not orbit.repeats_sooner() if doubled else orbit.record["asymmetry"] > SYMMETRIC


def _beside_grazing(problem, x, orbit, leaving, doubled):
    """Return a point of the other branch beyond the next grazing, or None.

    Parameters
    ----------
    problem : Problem
    x : array, shape (n + 1,)
        Unknowns at the bifurcation.
    orbit : Orbit
        The orbit there.
    leaving : array, shape (n + 1,)
        Direction in which the other branch leaves.
    doubled : bool
        Whether it has orbits of twice the period.
    """
    turn = min(turns_of(problem, x, orbit), key=lambda turn: abs(turn.height))
    for share in SHARES:
        change = share * turn.height
        guess = x + change / (turn.gradient @ leaving) * leaving
        found = at_height(problem, guess, turn, turn.height + change, np.sign(change))
        passage = found and through_grazing(found[0], REACH)
        if passage and _is_other(passage.points[-1].orbit, doubled):
            return passage.points[-1]
    return None
