"""Find the branches that begin where an orbit loses its symmetry or doubles its period.

At such a point one of `Orbit.cycle_multipliers` is -1. The new branch begins in the direction of
the eigenvector of this multiplier. Newton's corrections are orthogonal to this direction, so that
they do not lead back to the first branch.
"""

from dataclasses import replace
from itertools import islice

import numpy as np

from impact_damper.motions.records import SYMMETRIC
from impact_damper.orbits import segments
from impact_damper.orbits.continuation import Point, Problem
from impact_damper.orbits.grazing import at_height, through_grazing, turns_of, with_gradient
from impact_damper.orbits.shooting import shoot

# A first guess for a point of the new branch lies at each of DISTANCES from the bifurcation. The
# point found must be at most ASIDE times this distance away from the first guess.
DISTANCES, ASIDE = (2e-2, 4e-3, 8e-4, 1e-4, 1e-5), 0.5
# If no point is found, a grazing may be near. Let H be |Z2| - d0 in an extremum of Z2. The
# extremum is chosen whose H changes by the largest percentage along the new branch. For each s in
# SHARES a point is searched for at which H is 1 + s times its value at the bifurcation.
# REACH: Largest distance from the bifurcation to the first guess.
# MISSED: Largest relative difference between guess and point in distance from the bifurcation.
# PASSAGES: The branch is followed through the grazing from at most this number of points.
SHARES, MISSED, REACH, PASSAGES = (0.5, 0.2, 0.1, 0.05, 0.02), 0.5, 1e-3, 2
# Kinds of events at which another branch begins.
LEAVING = ("symmetry_breaking", "period_doubling")
# Where a branch meets a more symmetric branch, the orbits of both are at most this far apart.
MEETING = 1e-3


def other_branch(event, *, stable=False) -> Point | None:
    """Return a point of the branch that begins at `event`, or None if no point is found.

    If `stable`, only a point with a stable orbit is returned.
    """
    leaving = _leaving(event)
    doubled = event.kind == "period_doubling"

    def fits(point):
        orbit = point.orbit
        other = not orbit.repeats_sooner() if doubled else orbit.record["asymmetry"] > SYMMETRIC
        return other and (orbit.stable or not stable)

    found = filter(None, (_at_distance(leaving, distance) for distance in DISTANCES))
    points = list(found) if stable else list(islice(found, 1))
    if points:
        return next(filter(fits, points), None)
    for point in islice(_at_heights(leaving), PASSAGES):
        passage = through_grazing(point, REACH)
        if passage and fits(passage.points[-1]):
            return passage.points[-1]
    return None


def _leaving(event):
    point, problem = event.point, event.point.problem
    doubled = event.kind == "period_doubling"
    # When W T grows by `problem.cycle`, the state of the old orbit is multiplied by `sign`. A small
    # deviation from the old orbit towards the new branch is multiplied by -`sign`.
    sign, size = (1 if doubled else -1), 4 if problem.damped else 2
    factors = point.orbit.factors[:, :size, :size].copy()
    factors[-1] *= -1
    deviation = np.linalg.svd(segments.cyclic(factors))[2][-1]
    x, phases = point.x, np.append(problem.phases[:-1], problem.phases + problem.cycle)
    if problem.damped:
        x = np.concatenate([x[:-1], sign * x[:-1], x[-1:]])
        deviation = np.concatenate([deviation, -sign * deviation])
    else:
        phases = phases[[0, -1]]
    periods = problem.periods * (2 if doubled else 1)
    whole = replace(problem, periods=periods, phases=phases, symmetric=False)
    direction = np.append(deviation, 0.0)
    return whole, x, direction / whole.length(direction)


def _at_distance(leaving, distance):
    problem, x, direction = leaving
    guess = x + distance * direction
    near = problem.correct(guess, direction)
    close = near is not None and problem.length(near.x - guess) <= ASIDE * distance
    return near if close else None


def _at_heights(leaving):
    problem, x, direction = leaving
    # Search only the first half of the segments. The second half has the same extrema.
    half = (len(problem.phases) - 1) // 2 if problem.damped else 0
    orbit = problem.shoot(x)
    turns = [turn for turn in turns_of(orbit) if turn.segment < half]
    turns = [with_gradient(problem, x, orbit, turn) for turn in turns]
    if not turns:
        return
    turn = max(turns, key=lambda turn: abs(turn.gradient @ direction / turn.height))
    for share in SHARES:
        change = share * turn.height
        away = change / (turn.gradient @ direction or np.finfo(float).tiny)
        if abs(away) > REACH:
            continue
        guess = x + away * direction
        found = at_height(problem, guess, turn, turn.height + change, np.sign(change))
        if found is None:
            continue
        distance = (problem.metric * (found[0].x - x)) @ direction
        if abs(distance / away - 1) < MISSED:
            yield found[0]


# A branch that begins at an event of another branch A is followed if one of these is true:
# - A has a period in WHOLE and loses its symmetry.
# - A has a period in WHOLE, doubles its period, and has a stable orbit beside the event.
# - A has a stable orbit beside the event. The new branch begins with a stable orbit and has a
#   period up to STABLE.
# A more symmetric branch is followed if a branch with a period up to MET ends at it.
WHOLE, STABLE, MET = (1, 3), 9, 4
# The end of a branch and an event of another branch are the same point if they differ by less than
# SAME_VALUE in the parameter and by less than SAME_SIZE in max |Z1|.
SAME_VALUE, SAME_SIZE = 1e-6, 1e-4
# Two bifurcations are the same if their parameters differ by less than NEAR.
NEAR = 1e-9


def follow_others(branches, follow):
    """Append to the list `branches` each branch that meets a branch in the list.

    Do this for the appended branches too. The comment at WHOLE says which branches are followed.
    `follow(orbit, value)` returns the branch through an orbit whose parameter is `value`.
    """
    for branch in branches:
        for edge in (0, -1):
            point = _more_symmetric(branches, branch, edge)
            if point is not None:
                branches.append(follow(point.orbit, point.value))
        for place, event in branch.events:
            point = _new_branch(branches, branch, place, event)
            if point is not None:
                branches.append(follow(point.orbit, point.value))


def _more_symmetric(branches, branch, edge):
    kind, point = branch.ends[edge], branch.points[edge]
    orbit, symmetric = point.orbit, kind == "symmetry_breaking"
    if kind not in LEAVING or orbit.periods > MET:
        return None
    periods = orbit.periods // (1 if symmetric else 2)
    orbit = shoot(orbit.p, orbit.state, periods, orbit.phase, symmetric=symmetric)
    problem = Problem.of(point.problem.family, orbit, symmetric=symmetric)
    x = problem.unknowns(orbit, point.value)
    met = problem.correct(x, np.eye(len(x))[-1])
    if met is None or problem.length(met.x - x) > MEETING:
        return None
    return None if any(_passes(each, kind, met) for each in branches) else met


def _new_branch(branches, branch, place, event):
    ends = {0: branch.ends[0], len(branch.points) - 1: branch.ends[1]}
    if event.kind not in LEAVING or ends.get(place) == event.kind:
        return None
    if any(ends_at(branches, k, edge, event) for k in range(len(branches)) for edge in (0, 1)):
        return None
    first, doubled = branch.points[0].orbit.periods, event.kind == "period_doubling"
    beside = branch.points[max(place - 1, 0) : place + 2]
    if not any(point.orbit.stable for point in beside) and (doubled or first not in WHOLE):
        return None
    if first not in WHOLE and first * (1 + doubled) > STABLE:
        return None
    start = other_branch(event, stable=first not in WHOLE)
    others = (each for each in branches if each is not branch)
    if start is None or any(each.holds(start.orbit, start.value) for each in others):
        return None
    return start


def ends_at(branches, number, edge, event):
    """Return whether branches[number] begins (`edge` 0) or ends (`edge` 1) at `event`."""
    branch = branches[number]
    if branch.ends[edge] != event.kind or event.kind not in LEAVING:
        return False
    end, orbit = branch.points[-1 if edge else 0], event.point.orbit
    factor = 2 if event.kind == "period_doubling" else 1
    if end.orbit.periods != factor * orbit.periods or factor == 1 and orbit.sign > 0:
        return False
    sizes = [each.record["maximum_displacement"] for each in (orbit, end.orbit)]
    near = abs(event.point.value - end.value) < SAME_VALUE
    return near and abs(sizes[0] - sizes[1]) < SAME_SIZE


def met_by(branches, number, edge):
    """Return the index of the more symmetric branch at which branches[number] ends, or -1.

    `edge` is 0 for the end at the first point of branches[number], 1 for the end at the last point.
    """
    for other, candidate in enumerate(branches):
        if other == number:
            continue
        if any(ends_at(branches, number, edge, event) for _, event in candidate.events):
            return other
    return -1


def _passes(branch, kind, point):
    periods = point.orbit.periods
    there = [each.point for _, each in branch.events if each.kind == kind]
    near = any(abs(each.value - point.value) < NEAR for each in there)
    first = branch.points[0]
    same = first.orbit.periods == periods and first.problem.symmetric == point.problem.symmetric
    return same and (near or branch.holds(point.orbit, point.value))
