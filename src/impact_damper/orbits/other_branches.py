"""The branches that leave at the bifurcations of other branches: found, followed, and counted.

At every loss of symmetry and every period doubling another branch leaves. Its orbit closest to the
bifurcation is always searched for. The branch is followed if its period is short or its orbits are
stable: period doublings form infinite cascades, and unstable branches of long periods wind through
chaos.
"""

from typing import NamedTuple

from impact_damper.orbits.switching import LEAVING, Departure, departure, met_branch, other_branch

# Longest periods of branches that are followed: all; those that begin beside a stable orbit; and
# those whose own orbits are stable where they begin, which are followed only as far as they are
# stable.
ALWAYS, BESIDE_STABLE, STABLE = 3, 4, 9
# Two branches meet at an event if its parameter and max |Z1| on both agree within these tolerances.
SAME_VALUE, SAME_SIZE = 1e-7, 1e-4
# Bifurcations of one kind at frequencies that differ by less are the same.
NEAR = 1e-9


class Other(NamedTuple):
    """The other branch at a bifurcation.

    Attributes
    ----------
    outcome : str
        followed: the branch `number` begins here. ended: the branch on which the event lies ends
        here, at the branch `number` of more symmetry (-1: not followed). not_followed: its period
        is too long. not_passed: it is short enough, but Newton's method found no way past a
        grazing close by. not_found: no orbit of it was found.
    departure : Departure or None
        Its beginning; None if the outcome is ended or not_found.
    number : int
        Number of the branch in the list of branches, -1 if it was not followed.
    """

    outcome: str
    departure: Departure | None = None
    number: int = -1


def follow_others(branches, follow):
    """Follow the branches that leave at bifurcations, and say of each what became of it.

    The branches of more symmetry at which a branch ends are followed too. New branches are
    appended to the list, and the branches that leave from them are followed too.

    Parameters
    ----------
    branches : list of Branch
    follow : callable
        Maps an orbit, its value of the parameter, and whether to follow the branch only as far as
        it is stable, to a Branch.

    Returns
    -------
    list of list of (Other or None)
        For each branch and each of its events; None at events of other kinds.
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
    """Follow the branches at which a branch ends, up to the period BESIDE_STABLE."""
    for edge, kind in zip((0, -1), branch.ends, strict=True):
        if kind in LEAVING and branch.points[0].orbit.periods <= BESIDE_STABLE:
            met = met_branch(branch.points[edge], kind)
            if met and not any(_passes(each, kind, met) for each in branches):
                branches.append(follow(met.orbit, met.value, False))


def _follow_at(branches, branch, place, event, follow):
    """Find and, if it is wanted, follow the branch that leaves at an event of a branch.

    Return an `Other`, whose outcome is not yet "followed" if the branch was followed from its other
    end; or None for an event of another kind.
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
    branches.append(follow(start.orbit, start.value, not whole))
    return Other("followed", begun, len(branches) - 1)


def _is_end(branch, place, event):
    """Return whether a branch ends at one of its events."""
    edges = {0: branch.ends[0], len(branch.points) - 1: branch.ends[1]}
    return edges.get(place) == event.kind


def ends_at(branches, number, edge, event):
    """Return whether a branch ends, at one edge, at an event of a branch of more symmetry.

    Parameters
    ----------
    branches : list of Branch
    number, edge : int
        Number of the branch, and 0 for its first end or 1 for its last.
    event : Event
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
    """Return the number of the branch that a branch meets at one edge, -1 if there is none."""
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
    """Return whether a branch holds the orbit of a point, or has an event of a kind there."""
    periods = point.orbit.periods
    there = [each.point for _, each in branch.events if each.kind == kind]
    near = any(abs(each.value - point.value) < NEAR for each in there)
    same = branch.points[0].orbit.periods == periods
    return same and (near or branch.holds(point.orbit, point.value))
