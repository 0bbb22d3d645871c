"""Follow the branches that leave other branches next to their stable orbits."""

from impact_damper.orbits.switching import LEAVING, met_branch, other_branch

# Longest period, in forcing cycles, of a branch that is followed from another branch.
# WHOLE: of the first branch, if the other one is followed also where it begins unstable.
# STABLE: of a branch whose orbits are stable where it begins.
# MET: of a branch whose end is a branch that is followed too.
WHOLE, STABLE, MET = (1, 3), 9, 4
# Two branches meet at an event if the parameter and max |Z1| at the event and at the end of the
# other branch agree within these tolerances. The end is a fold, located to 1e-7 in branch length.
SAME_VALUE, SAME_SIZE = 1e-6, 1e-4
# Two bifurcations of one kind are the same if their parameters differ by less than NEAR.
NEAR = 1e-9


def follow_others(branches, follow):
    """Append the branches that leave other branches, or at which they end, to the list `branches`.

    A branch that leaves next to stable orbits is followed if its first branch has a period of
    WHOLE, or if it begins stable and its period is at most STABLE. Elsewhere it begins unstable,
    and is followed only where a branch of a period of WHOLE loses its symmetry. `follow` returns
    the `Branch` of an orbit at a value of the parameter.
    """
    for branch in branches:
        for edge in (0, -1):
            point = _more_symmetric(branches, branch, edge)
            if point is not None:
                branches.append(follow(point.orbit, point.value))
        for place, event in branch.events:
            point = _leaving(branches, branch, place, event)
            if point is not None:
                branches.append(follow(point.orbit, point.value))


def _more_symmetric(branches, branch, edge):
    """Return the point of a new branch of more symmetry at which a branch ends, or None."""
    kind = branch.ends[edge]
    if kind not in LEAVING or branch.points[0].orbit.periods > MET:
        return None
    met = met_branch(branch.points[edge], kind)
    return met if met and not any(_passes(each, kind, met) for each in branches) else None


def _leaving(branches, branch, place, event):
    """Return a point of a new branch that leaves at an event, or None.

    `place` is the index of the event's point on its branch.
    """
    if event.kind not in LEAVING or _is_end(branch, place, event):
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
