"""The equations of an edge, a curve in two parameters on which a symmetric orbit loses stability.

A symmetric orbit is a periodic motion of one forcing cycle that repeats with the opposite sign
after half a cycle. It is a fixed point of the half-period map: integrate a state over half a cycle
and change its sign. The derivative R of this map, shape (4, 4), is called the root of the orbit,
because its square is the derivative over the whole period. With the eigenvalues mu of R, here
called multipliers, the test functions, one of which is zero on an edge, are

    fold                 det(R - 1), zero for mu = 1
    symmetry_breaking    det(R + 1), zero for mu = -1
    neimark_sacker       product of mu_i mu_j - 1 over all pairs i < j, zero for a conjugate pair
                         of modulus 1; it is det(C - 1) with the matrix C of the 2-by-2 minors of R
    grazing              |Z2| - d0 at the turning point of Z2 that is the next to become a contact;
                         zero where this contact appears

Z2 is the displacement between the primary and the loose mass, and d0 the clearance on each side.
All test functions are smooth, also where multipliers coincide. The unknowns are the state of the
orbit and both parameters. The packed parameters, the array of all parameters of the system, are
functions of both. Their derivatives are difference quotients. All other derivatives are exact
(`orbits.variations`).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import CLEARANCE, COUNT, FREQUENCY
from impact_damper.orbits.orbit import TURN
from impact_damper.orbits.paths import Path, follow_path
from impact_damper.orbits.shooting import shoot
from impact_damper.orbits.variations import Variations

FOLD, SYMMETRY, TORUS, GRAZING = "fold", "symmetry_breaking", "neimark_sacker", "grazing"
KINDS = (FOLD, SYMMETRY, TORUS, GRAZING)
# The six pairs i < j of four multipliers, shape (2, 6).
PAIRS = np.array(list(combinations(range(4), 2))).T
# Change of a scaled parameter in a difference quotient, and of a point along a tangent.
NUDGE = 1e-5
# Newton's method in the scaled unknowns.
# NEWTON: largest number of corrections.
# LARGEST: a larger correction ends the method without success.
# CLOSE: the method has converged if a correction is smaller.
# ROUNDING: or if a smaller correction is more than half the correction before, which means that
#     only rounding errors are left.
# SLOW: the derivative is computed again if a correction exceeds this times the correction before.
NEWTON, LARGEST, CLOSE, ROUNDING, SLOW = 14, 0.2, 1e-12, 1e-9, 0.1
# A multiplier counts as complex if its imaginary part exceeds COMPLEX.
COMPLEX = 1e-6
# `concerned` lists the multipliers that are 1 in modulus on an edge of a kind. An edge ends if
# another multiplier exceeds UNSTABLE in modulus, because the orbits on both sides are then
# unstable. Up to UNSTABLE the edge is followed, since the multiplier may fall below 1 again.
UNSTABLE = 3.0


def value(kind, path, contacts):
    """Return the test function of a kind for a motion over half a period.

    Parameters
    ----------
    kind : str
        One of KINDS.
    path : Path
        The motion over half a period.
    contacts : int
        Number of contacts in half a period. For a grazing edge, the number on the side of the edge
        with fewer contacts.
    """
    if kind == GRAZING:
        return _reach(path, contacts)[0]
    return np.linalg.det(_shifted(kind, -path.matrix))


def value_change(kind, variations, first, parameters, contacts):
    """Return the derivatives of a test function along n directions, shape (n,).

    A direction is a simultaneous change of the first state and of the packed parameters. `first`,
    shape (4, n), and `parameters`, shape (COUNT, n), are the arguments of `Variations.changes`.
    `kind` and `contacts` are those of `value`.
    """
    path = variations.path
    if kind == GRAZING:
        _, weights, wall = _reach(path, contacts)
        changes = variations.changes(first, parameters)[2]
        return wall * changes @ weights - parameters[CLEARANCE]
    root, change = -path.matrix, -variations.matrix_changes(first, parameters)
    if kind == TORUS:
        (i, j), (k, m) = PAIRS[:, :, None], PAIRS[:, None]
        change = (
            change[:, i, k] * root[j, m]
            + root[i, k] * change[:, j, m]
            - change[:, i, m] * root[j, k]
            - root[i, m] * change[:, j, k]
        )
    left, sizes, right = np.linalg.svd(_shifted(kind, root))
    # d det(X) = trace(adj(X) dX), and the adjugate adj(X) follows from the singular values of X.
    others = np.array([np.prod(np.delete(sizes, k)) for k in range(len(sizes))])
    turn = np.linalg.det(left) * np.linalg.det(right)
    adjugate = turn * (right.T * others) @ left.T
    return np.einsum("ij,nji->n", adjugate, change)


def _shifted(kind, root):
    """Return R - 1, R + 1 or C - 1, whose determinant is the test function of the kind."""
    if kind == TORUS:
        (i, j), (k, m) = PAIRS[:, :, None], PAIRS[:, None]
        root = root[i, k] * root[j, m] - root[i, m] * root[j, k]
    return root + (1 if kind == SYMMETRY else -1) * np.eye(len(root))


def _reach(path, contacts):
    """Return the test function of grazing, and how it depends on the path.

    The turning points of Z2 are sorted by |Z2| in descending order. The first `contacts` of them
    are contacts, and the one after them is the next to become a contact.

    Returns
    -------
    distance : float
        |Z2| - d0 at this turning point; -d0 if there is none.
    weights : numpy.ndarray, shape (N,)
        Weights with which Z2 at the N points of the path gives Z2 at this turning point.
    wall : float
        Sign of Z2 at this turning point, or 0 if there is none.
    """
    steps, sizes, weights, _ = path.turns(1)
    at_points = np.zeros((len(path.sides), weights.shape[1]))
    if len(sizes) <= contacts:
        return -path.p[CLEARANCE], at_points.ravel(), 0.0
    turn = np.argsort(-np.abs(sizes))[contacts]
    at_points[steps[turn]] = weights[turn]
    wall = np.sign(sizes[turn])
    return wall * sizes[turn] - path.p[CLEARANCE], at_points.ravel(), wall


def concerned(kind, root):
    """Return the multipliers of a root that are 1 in modulus on an edge of a kind, and the others.

    On an edge of the kind GRAZING there are none: the orbit gains or loses a contact.
    """
    values = np.linalg.eigvals(root)
    if kind == GRAZING:
        return values[:0], values
    if kind == TORUS:
        first = np.argmin(np.abs(values[PAIRS[0]] * values[PAIRS[1]] - 1))
        chosen = PAIRS[:, first]
    else:
        chosen = [np.argmin(np.abs(values - (1 if kind == FOLD else -1)))]
    return values[chosen], np.delete(values, chosen)


def scaled_slopes(family, spans, coordinates):
    """Return the derivatives of the packed parameters by both scaled parameters, shape (COUNT, 2).

    Parameters
    ----------
    family : callable
        Maps both parameters to packed parameters.
    spans : array, shape (2, 2)
        Least and greatest value of each parameter, which are scaled to 0 and 1.
    coordinates : array, shape (2,)
        Scaled parameters.
    """
    columns = []
    for k in range(2):
        ends = np.array([coordinates, coordinates])
        ends[:, k] = max(coordinates[k] - NUDGE, 0.0), min(coordinates[k] + NUDGE, 1.0)
        behind, ahead = (family(*(spans[:, 0] + np.ptp(spans, axis=1) * end)) for end in ends)
        columns.append((ahead - behind) / (ends[1, k] - ends[0, k]))
    return np.column_stack(columns)


class Point(NamedTuple):
    """A point of an edge.

    Attributes
    ----------
    x : numpy.ndarray, shape (6,)
        The unknowns of `Problem`.
    tangent : numpy.ndarray, shape (6,)
        Unit tangent of the edge.
    path : Path
        The orbit over half a period.
    phase : float
        Phase W T of the state, radian.
    """

    x: np.ndarray
    tangent: np.ndarray
    path: Path
    phase: float

    @property
    def root(self):
        """Derivative R of the half-period map, shape (4, 4)."""
        return -self.path.matrix


@dataclass(frozen=True)
class Problem:
    """The equations of an edge, whose unknowns are the scaled state and the scaled parameters.

    Attributes
    ----------
    family : callable
        Maps both parameters to packed parameters.
    kind : str
        One of KINDS.
    spans : numpy.ndarray, shape (2, 2)
        Least and greatest value of each parameter.
    scale : float
        Unit of the scaled state: the largest component of the state of the first orbit.
    contacts : int
        Number of contacts in half a period.
    phase : float
        Phase W T of the forcing at which the states are taken, radian.
    """

    family: Callable[[float, float], np.ndarray]
    kind: str
    spans: np.ndarray
    scale: float
    contacts: int
    phase: float

    def unknowns(self, state, values):
        """Return the unknowns, shape (6,): state divided by `scale`, parameters scaled to 0..1."""
        return np.append(state / self.scale, (values - self.spans[:, 0]) / np.ptp(self.spans, 1))

    def values(self, x):
        """Return both parameters of the unknowns x, shape (2,)."""
        return self.spans[:, 0] + np.ptp(self.spans, axis=1) * x[4:]

    def path(self, x):
        """Return the motion over half a period from the state of the unknowns x."""
        p = self.family(*self.values(x))
        begin = self.phase / p[FREQUENCY]
        return follow_path(p, self.scale * x[:4], begin, begin + TURN / 2 / p[FREQUENCY])

    def defects(self, x, path):
        """Return the left sides of the five equations, shape (5,), which are zero on the edge.

        The first four are the half-period map of the state minus the state; they are zero for a
        symmetric orbit. The fifth is the test function.
        """
        defect = -path.states[:, -1] - self.scale * x[:4]
        return np.append(defect / self.scale, value(self.kind, path, self.contacts))

    def rows(self, x, path):
        """Return the derivatives of `defects` with respect to the unknowns, shape (5, 6)."""
        variations = Variations(path)
        first, parameters = np.zeros((4, 6)), np.zeros((COUNT, 6))
        first[:, :4], parameters[:, 4:] = (
            self.scale * np.eye(4),
            scaled_slopes(self.family, self.spans, x[4:]),
        )
        by_test = value_change(self.kind, variations, first, parameters, self.contacts)
        change = -(path.matrix @ first + variations.slopes() @ parameters) - first
        return np.vstack([change / self.scale, by_test])

    def correct(self, x, border=None):
        """Return the point of the edge that Newton's method reaches from x, or None if it fails.

        There are five equations for six unknowns. As a sixth equation, all corrections are
        orthogonal to the vector `border`. Without a border each correction is the shortest that
        solves the linear equations. The derivative is computed again only if the corrections
        shrink slowly.
        """
        rows, last, slow = None, np.inf, False
        for _ in range(NEWTON):
            try:
                path = self.path(x)
                defects = self.defects(x, path)
                if rows is None or slow:
                    rows = self.rows(x, path)
                if border is None:
                    change = np.linalg.lstsq(rows, -defects)[0]
                else:
                    change = np.linalg.solve(np.vstack([rows, border]), -np.append(defects, 0.0))
            except (ArithmeticError, ValueError, np.linalg.LinAlgError):
                return None
            size = np.max(np.abs(change))
            if not size < LARGEST:
                return None
            x = x + change
            if size < CLOSE or last / 2 < size < ROUNDING:
                tangent = np.linalg.svd(rows)[2][-1]
                along = 1.0 if border is None else np.sign(tangent @ border) or 1.0
                return Point(x, along * tangent, path, self.phase)
            slow, last = size > SLOW * last, size
        return None

    def fault(self, point):
        """Return the reason why the edge ends before a point (see `Edge.ends`), or ""."""
        begun = np.count_nonzero(point.path.events[2] > 0)
        if begun != self.contacts and not (self.kind == GRAZING and begun == self.contacts + 1):
            return "contacts_change"
        pair, others = concerned(self.kind, point.root)
        if np.max(np.abs(others)) > UNSTABLE:
            return "too_unstable"
        if self.kind == TORUS and not np.min(np.abs(pair.imag)) > COMPLEX:
            return "resonance"
        return ""

    def rephased(self, point):
        """Return the problem and the same point of the edge, with the state at a new phase.

        The new phase is far from contacts, where the half-period map is smooth. The sign of the
        tangent must be kept: a second point, displaced by NUDGE along the tangent, is integrated
        to the new phase too, and gives the direction there. Return None if Newton's method fails.
        """
        orbit = self.orbit(point)
        phase = orbit.flight_phase()
        if phase == orbit.phase:
            return self, point
        problem = replace(self, phase=phase % TURN)
        x, nudged = point.x.copy(), point.x + NUDGE * point.tangent
        x[:4] = orbit.at(phase) / self.scale
        ahead = replace(orbit, p=self.family(*self.values(nudged)), state=self.scale * nudged[:4])
        nudged[:4] = ahead.at(phase) / self.scale
        border = nudged - x
        moved = problem.correct(x, border / np.linalg.norm(border))
        return None if moved is None else (problem, moved)

    def orbit(self, point):
        """Return the `Orbit` at a point of the edge."""
        p = self.family(*self.values(point.x))
        return shoot(p, self.scale * point.x[:4], 1, point.phase, symmetric=True)[0]
