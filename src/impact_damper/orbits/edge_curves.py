"""Follow curves in the plane of two parameters on which a symmetric orbit loses its stability.

Such a curve is called an edge. An orbit is a periodic motion, here of one forcing cycle. It is
symmetric if the motion repeats with the opposite sign after half a cycle. The equations of an edge
are in the module `problem`; their six unknowns are the scaled state of the orbit and both
parameters, scaled to 0 to 1. The edge is followed from one of its points by pseudo-arclength
continuation, so that it may turn back in both parameters.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from impact_damper.model.bounds import shown
from impact_damper.orbits.edge_problem import KINDS, ROUNDING, Problem, concerned
from impact_damper.orbits.orbit import Orbit

# Lengths of a step along an edge, measured in the scaled unknowns.
# FIRST_STEP, LONGEST_STEP: first and longest step.
# SHORTEST_STEP: a failed step is halved; if a step of this length fails, the edge ends.
# GROWTH: factor by which a step is longer than the step before, after a success.
FIRST_STEP, LONGEST_STEP, SHORTEST_STEP, GROWTH = 0.01, 0.05, 1e-5, 1.4
# A step is accepted under two conditions, so that it does not jump to another edge.
# STRAIGHT: smallest cosine of the angle between the tangents at its ends (18 degrees).
# ASIDE: largest correction of its end by Newton's method, divided by the length of the step.
STRAIGHT, ASIDE = 0.95, 0.3
# Largest number of points in each direction from the first point.
MOST_POINTS = 400
# A point lies on an edge if its distance from the edge is below NEAR, in scaled parameters.
NEAR = 2e-3


@dataclass(frozen=True)
class Edge:
    """A curve on which a symmetric orbit loses its stability.

    Attributes
    ----------
    kind : str
        How stability is lost: one of `problem.KINDS`.
    values : numpy.ndarray, shape (n, 2)
        The two parameters, in order along the curve.
    orbits : list of Orbit
        The orbits at these parameters.
    bounding : numpy.ndarray of bool, shape (n,)
        Whether the edge bounds a region of stable orbits at each point. It does if all multipliers
        (Floquet multipliers) are less than 1 in modulus, except those that are 1 in modulus on the
        edge because of its kind.
    ends : tuple of str
        Reasons why the curve ends before its first and after its last point: "range_ends" at a
        bound of a parameter; "closed" if it returns to its first point; "contacts_change" if the
        orbit gains or loses contacts; "resonance" if the complex pair of multipliers of a
        Neimark-Sacker bifurcation becomes real, at 1 or -1; "too_unstable" if another multiplier
        exceeds `problem.UNSTABLE`; "lost" if Newton's method fails; "point_limit" after
        MOST_POINTS.
    spans : numpy.ndarray, shape (2, 2)
        Least and greatest value of each parameter.
    """

    kind: str
    values: np.ndarray
    orbits: list[Orbit]
    bounding: np.ndarray
    ends: tuple[str, str]
    spans: np.ndarray

    @cached_property
    def coordinates(self):
        """Both parameters, scaled so that their spans become 0 to 1, shape (n, 2)."""
        return (self.values - self.spans[:, 0]) / np.ptp(self.spans, axis=1)

    def crosses(self, first, second) -> bool:
        """Return whether the edge crosses the straight line between two points.

        `first` and `second` are pairs of scaled parameters.
        """
        points, way = self.coordinates, second - first
        aside = (points[:, 0] - first[0]) * way[1] - (points[:, 1] - first[1]) * way[0]
        k = np.flatnonzero(aside[:-1] * aside[1:] <= 0)
        fraction = aside[k] / np.where(aside[k] == aside[k + 1], 1.0, aside[k] - aside[k + 1])
        met = points[k] + fraction[:, None] * (points[k + 1] - points[k])
        along = (met - first) @ way / (way @ way)
        return bool(np.any((along >= 0) & (along <= 1)))

    def holds(self, point) -> bool:
        """Return whether a point, a pair of scaled parameters, is closer to the edge than NEAR."""
        begins, steps = self.coordinates[:-1], np.diff(self.coordinates, axis=0)
        sizes = np.sum(steps**2, axis=1)
        along = np.sum((point - begins) * steps, axis=1) / np.where(sizes > 0, sizes, 1.0)
        nearest = begins + np.clip(along, 0, 1)[:, None] * steps
        return bool(np.min(np.linalg.norm(nearest - point, axis=1), initial=np.inf) < NEAR)


def follow_edge(family, kind, orbit, values, spans) -> Edge | None:
    """Return the edge near an orbit, followed both ways from the point nearest to the orbit.

    Parameters
    ----------
    family : callable
        Maps two parameters to the packed parameters of a system, shape (packed.COUNT,).
    kind : str
        One of `problem.KINDS`.
    orbit : Orbit
        A symmetric orbit of the family (`Orbit.root` is not None) close to the edge, such as the
        orbit at a bifurcation on a branch.
    values : sequence of float
        Both parameters of the orbit.
    spans : array, shape (2, 2)
        Least and greatest value of each parameter.

    Returns
    -------
    Edge or None
        None if Newton's method finds no edge near the orbit within the spans.

    Raises
    ------
    ValueError
        If the kind is unknown, the orbit is not symmetric, or the values are not in the spans.
    """
    spans = np.asarray(spans, float)
    values = check_start(orbit, values, spans)
    if kind not in KINDS:
        raise ValueError(f"kind = {shown(kind)}: must be one of {', '.join(KINDS)}")
    problem, first = point_near(family, kind, orbit, values, spans)
    if first is None or problem.fault(first):
        return None
    return edge_through(problem, first)


def check_start(orbit, values, spans):
    """Return both parameters of an orbit as an array, shape (2,).

    Raises
    ------
    ValueError
        If the orbit is not symmetric, or its parameters are not in the spans.
    """
    values = np.asarray(values, float)
    if orbit.root is None or orbit.periods != 1:
        raise ValueError("orbit: must be symmetric, of period 1, with its `root`")
    if not (np.all(spans[:, 0] <= values) and np.all(values <= spans[:, 1])):
        raise ValueError(f"values = {values.tolist()}: must lie in {spans.tolist()}")
    return values


def point_near(family, kind, orbit, values, spans, border=None):
    """Return the `Problem` of an edge and a point of the edge near an orbit.

    The point is None if Newton's method finds no point within the spans. The caller must check the
    point by `Problem.fault`. The arguments are those of `follow_edge`, and `border` is the argument
    of `Problem.correct`. Without a border the point nearest to the orbit is sought.
    """
    scale, contacts = np.max(np.abs(orbit.state)), len(orbit.contacts) // 2
    problem = Problem(family, kind, spans, scale, contacts, orbit.phase)
    first = problem.correct(problem.unknowns(orbit.state, values), border)
    return problem, None if first is None or not _inside(first.x) else first


def _inside(x):
    """Return whether both scaled parameters of the unknowns x are between 0 and 1."""
    return bool(np.all((x[4:] >= 0) & (x[4:] <= 1)))


def edge_through(problem, first) -> Edge:
    """Return the `Edge` through the point `first`, followed in both directions."""
    ahead, end = _walk(problem, first)
    behind, start = [first], "closed"
    if end != "closed":
        behind, start = _walk(problem, first._replace(tangent=-first.tangent))
    points = [*behind[:0:-1], *ahead]
    others = [concerned(problem.kind, point.root)[1] for point in points]
    return Edge(
        problem.kind,
        np.array([problem.values(point.x) for point in points]),
        [problem.orbit(point) for point in points],
        np.array([bool(np.all(np.abs(each) < 1)) for each in others]),
        (start, end),
        problem.spans,
    )


def _walk(problem, first):
    """Return the points of an edge from `first` along its tangent, and why the edge ends."""
    points, length, last = [first], FIRST_STEP, first
    while len(points) < MOST_POINTS:
        ahead, fault = _step(problem, last, length)
        if fault and fault != "range_ends":
            length /= 2
            if length < SHORTEST_STEP:
                return points, fault
            continue
        if fault and np.linalg.norm(ahead.x - last.x) < ROUNDING:
            return points, fault
        points.append(ahead)
        if fault:
            return points, fault
        if len(points) > 3 and _passes(problem, last, ahead, first):
            points[-1] = first
            return points, "closed"
        moved = problem.rephased(ahead)
        if moved is None:
            return points, "lost"
        problem, last = moved
        length = min(GROWTH * length, LONGEST_STEP)
    return points, "point_limit"


def _step(problem, point, length):
    """Return the point one step ahead, or None, and the reason why the edge ends, or ""."""
    x, border = point.x + length * point.tangent, point.tangent
    ahead = problem.correct(x, border) if _inside(x) else None
    reason = ""
    if not _inside(x) or (ahead is not None and not _inside(ahead.x)):
        # Shorten the step so that it ends where it leaves the rectangle of parameters.
        x, border = _to_border(point.x, x if ahead is None else ahead.x)
        ahead, reason = problem.correct(x, border), "range_ends"
        if ahead is not None and not _inside(ahead.x):
            ahead = None
    if ahead is None:
        return None, "lost"
    if fault := problem.fault(ahead):
        return None, fault
    aside = np.linalg.norm(ahead.x - x) > ASIDE * length + ROUNDING
    turned = abs(ahead.tangent @ point.tangent) < STRAIGHT
    return (None, "lost") if aside or turned else (ahead, reason)


def _to_border(inner, outer):
    """Return where the line between two points leaves the rectangle of parameters.

    Also return the unit normal, shape (6,), of the side of the rectangle at which it leaves.
    """
    change = outer - inner
    bounds = np.where(change[4:] > 0, 1.0, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        coordinates = (bounds - inner[4:]) / change[4:]
    coordinates[~(coordinates >= 0)] = np.inf
    k = int(np.argmin(coordinates))
    x = inner + min(coordinates[k], 1.0) * change
    x[4 + k] = bounds[k]
    return x, np.eye(6)[4 + k]


def _passes(problem, last, ahead, first):
    """Return whether the first point of an edge lies on the step from `last` to `ahead`."""
    step, back = ahead.x[4:] - last.x[4:], first.x[4:] - last.x[4:]
    size = step @ step
    fraction = back @ step / size if size > 0 else np.inf
    if not 0 < fraction <= 1 or np.linalg.norm(back - fraction * step) > ASIDE * np.sqrt(size):
        return False
    same = problem.orbit(first).is_same(problem.orbit(ahead), LONGEST_STEP * problem.scale)
    return bool(same and first.tangent[4:] @ step > 0)
