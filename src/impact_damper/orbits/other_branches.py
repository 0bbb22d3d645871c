"""The branches that leave other branches at bifurcations: all searched for, and some followed.

A branch is the curve of the periodic orbits over a parameter. At every loss of symmetry and every
period doubling another branch leaves. The orbits of this other branch have less symmetry: they are
not symmetric, or repeat only after twice the period. An orbit of the other branch close to the
bifurcation is always searched for. The branch is followed only if its period is short or its orbits
are stable where it begins. Otherwise the search would not end, because period doublings form
infinite cascades, and unstable branches of long periods wind through chaos.

An end of a branch is its first or its last point. Z1 is the displacement of the primary mass.
Multipliers are Floquet multipliers.
"""

from typing import NamedTuple

from impact_damper.orbits.switching import LEAVING, Departure, departure, met_branch, other_branch

# Longest period, in forcing cycles, of the branches that are followed.
# ALWAYS: of any branch.
# BESIDE_STABLE: of a branch that leaves beside a stable orbit.
# STABLE: of a branch whose orbits are stable where it begins.
ALWAYS, BESIDE_STABLE, STABLE = 3, 4, 9
# Two branches meet at an event if the parameter and max |Z1| at the event and at the end of the
# other branch agree within these tolerances. The end is a fold, located to 1e-7 in branch length.
SAME_VALUE, SAME_SIZE = 1e-6, 1e-4
# Two bifurcations of one kind are the same if their parameters differ by less than NEAR.
NEAR = 1e-9


class Other(NamedTuple):
    """What was found of the other branch at a bifurcation.

    Attributes
    ----------
    outcome : str
        "followed": the other branch begins at the bifurcation and is in the list of branches.
        "ended": the other branch is the one of more symmetry, and the branch on which the
        bifurcation lies ends at it. "not_followed": the period of the other branch is too long.
        "not_passed": its period is short enough, but a grazing is close, and Newton's method found
        no orbit beyond it. "not_found": no orbit of the other branch was found.
    departure : Departure or None
        Beginning of the other branch; None if the outcome is "ended" or "not_found".
    number : int
        Index of the other branch in the list of branches, -1 if it is not in the list.
    """

    outcome: str
    departure: Departure | None = None
    number: int = -1


def follow_others(branches, follow):
    """Follow the branches that leave at bifurcations, and return the outcome at each bifurcation.

    The branches of more symmetry at which a branch ends are followed too. New branches are
    appended to the list, and the branches that leave them are followed in turn.

    Parameters
    ----------
    branches : list of Branch
    follow : callable
        Function that returns the `Branch` of an orbit. Its arguments are the orbit and the value of
        the parameter.

    Returns
    -------
    list of list of (Other or None)
        An entry for each branch, with an entry for each of its events; None for an event that is
        not a loss of symmetry or a period doubling.
    """
    found = []
    for branch in branches:
        _follow_ends(branches, branch, follow)
        found.append([_follow_at(branches, branch, *each, follow) for each in branch.events])
    ends = [
        (number, edge)
        for number, branch in enumerate(branches)
        for edge in (0, 1)
        if branch.ends[edge] in LEAVING
    ]
    for number, others in enumerate(found):
        for k, other in enumerate(others):
            if other is None:
                continue
            event = branches[number].events[k][1]
            if other.outcome == "ended":
                edge = 1 if branches[number].events[k][0] else 0
                others[k] = other._replace(number=met_by(branches, number, edge))
            elif other.number < 0:
                met = [end for end in ends if end[0] != number and ends_at(branches, *end, event)]
                if met:
                    others[k] = other._replace(outcome="followed", number=met[0][0])
    return found


def _follow_ends(branches, branch, follow):
    """Follow the branches of more symmetry at which a branch ends.

    This is done only for branches of periods up to BESIDE_STABLE.
    """
    for edge, kind in zip((0, -1), branch.ends, strict=True):
        if kind in LEAVING and branch.points[0].orbit.periods <= BESIDE_STABLE:
            met = met_branch(branch.points[edge], kind)
            if met and not any(_passes(each, kind, met) for each in branches):
                branches.append(follow(met.orbit, met.value))


def _follow_at(branches, branch, place, event, follow):
    """Find the branch that leaves at an event of a branch, and follow it if its period allows it.

    `place` is the index of the event's point. Return an `Other`, or None for an event that is not a
    loss of symmetry or a period doubling. `follow_others` changes the outcome later if the branch
    that leaves is reached from its other end.
    """
    if event.kind not in LEAVING:
        return None
    if _is_end(branch, place, event):
        return Other("ended")
    begun = departure(event)
    if begun is None:
        return Other("not_found")
    periods = begun.point.orbit.periods
    beside = branch.points[max(place - 1, 0) : place + 2]
    near_stable = any(point.orbit.stable for point in beside)
    whole = periods <= ALWAYS or (near_stable and periods <= BESIDE_STABLE)
    if not (whole or (begun.point.orbit.stable and periods <= STABLE)):
        return Other("not_followed", begun)
    for number in range(len(branches)):
        if any(ends_at(branches, number, edge, event) for edge in (0, 1)):
            return Other("followed", begun, number)
    start = other_branch(event)
    if not whole and not (start and start.orbit.stable) and begun.side != "beside_grazing":
        start = begun.point
    if start is None:
        return Other("not_passed", begun)
    for number, each in enumerate(branches):
        if each is not branch and each.holds(start.orbit, start.value):
            return Other("followed", begun, number)
    branches.append(follow(start.orbit, start.value))
    return Other("followed", begun, len(branches) - 1)


def _is_end(branch, place, event):
    """Return whether a branch ends at one of its events, whose point has the index `place`."""
    edges = {0: branch.ends[0], len(branch.points) - 1: branch.ends[1]}
    return edges.get(place) == event.kind


def ends_at(branches, number, edge, event):
    """Return whether one end of a branch lies at an event of a branch of more symmetry.

    Parameters
    ----------
    branches : list of Branch
    number, edge : int
        Index of the branch, and its end: 0 for the first, 1 for the last point.
    event : Event
        The event of the branch of more symmetry.
    """
    branch = branches[number]
    if branch.ends[edge] != event.kind or event.kind not in LEAVING:
        return False
    end, orbit = branch.points[-1 if edge else 0], event.point.orbit
    factor = 2 if event.kind == "period_doubling" else 1
    if end.orbit.periods != factor * orbit.periods or factor == 1 and orbit.root is None:
        return False
    near = abs(event.point.value - end.value) < SAME_VALUE
    return near and abs(_size(orbit) - _size(end.orbit)) < SAME_SIZE


def met_by(branches, number, edge):
    """Return the index of the branch that a branch meets at one end, or -1 if there is none.

    The arguments are those of `ends_at`.
    """
    for other, candidate in enumerate(branches):
        if other == number:
            continue
        if any(ends_at(branches, number, edge, event) for _, event in candidate.events):
            return other
    return -1


def _size(orbit):
    """Return max |Z1| of an orbit."""
    return orbit.record["maximum_displacement"]


def _passes(branch, kind, point):
    """Return whether a branch passes through a point.

    It does if it holds the orbit of the point, or if it has an event of the given kind at the value
    of the point and orbits of the same period.
    """
    periods = point.orbit.periods
    there = [each.point for _, each in branch.events if each.kind == kind]
    near = any(abs(each.value - point.value) < NEAR for each in there)
    first = branch.points[0]
    same = first.orbit.periods == periods and first.problem.symmetric == point.problem.symmetric
    return same and (near or branch.holds(point.orbit, point.value))
