"""A grid over two parameters in whose cells the quiet orbit is known, and where edges lie between.

The orbit is followed from cell to cell by exact tangents.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.edges.curves import point_near
from impact_damper.edges.problem import (
    FOLD,
    GRAZING,
    KINDS,
    SYMMETRY,
    TORUS,
    UNSTABLE,
    concerned,
    scaled_slopes,
    value,
)
from impact_damper.motions.following import Followed
from impact_damper.orbits.grid_following import Grid
from impact_damper.orbits.orbit import TURN, Orbit
from impact_damper.orbits.paths import Path
from impact_damper.orbits.sensitivity import path_of
from impact_damper.orbits.shooting import shoot
from impact_damper.orbits.variations import Variations
from impact_damper.system.packed import CLEARANCE

# Newton's method: number of corrections, and largest distance from the prediction as a share of the
# largest number of the state.
ITERATIONS, REACH = 8, 0.1
# Number of cells near the first orbit that are tried, until it can be followed to one of them.
STARTS = 4
# Shortest step between cells, as a share of their distance.
SHORTEST = 1 / 64
# Bisections between two cells with a change of sign, until Newton's method finds the edge.
BISECTIONS = 6
# If in the last orbit that was reached the loose mass turns closer to a wall than this share of the
# clearance, the orbit ends by a new contact: there the branch turns too sharply to be followed.
TOUCHING = 0.05


class Place(NamedTuple):
    """An orbit at scaled parameters.

    Attributes
    ----------
    orbit : Orbit
    shares : numpy.ndarray, shape (2,)
        Scaled parameters.
    slopes : numpy.ndarray, shape (4, 2)
        Derivative of the state by the scaled parameters.
    path : Path
        Half a period.
    tests : dict
        Test functions, keyed by kind.
    """

    orbit: Orbit
    shares: np.ndarray
    slopes: np.ndarray
    path: Path
    tests: dict


class EdgeGrid(Grid):
    """A grid with a `Place` in each cell; from cell to cell orbits are followed by tangents.

    Attributes
    ----------
    family, spans
        As of `problem.scaled_slopes`.
    contacts : int
        Contacts in half a period.
    failed : list
        One entry for each orbit that ends on the way from a cell to its neighbour: kind of the edge
        that must lie there, cell, neighbour, and last place.
    """

    def __init__(self, family, spans, axes, contacts):
        self.family, self.spans, self.contacts, self.failed = family, spans, contacts, []
        points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        super().__init__(self.scaled(points), None)

    def scaled(self, values):
        """Return parameters scaled to their spans."""
        return (values - self.spans[:, 0]) / np.ptp(self.spans, axis=1)

    def values(self, shares):
        """Return both parameters."""
        return self.spans[:, 0] + np.ptp(self.spans, axis=1) * shares

    def begin(self, orbit, shares):
        """Enter an orbit at a cell near to its scaled parameters."""
        start = self._place(orbit, shares)
        distance = np.max(np.abs(self.points - shares), axis=-1)
        for k in np.argsort(distance, axis=None)[:STARTS]:
            cell = tuple(int(i) for i in np.unravel_index(k, self.shape))
            followed = self.follow_to(start, self.points[cell])
            if followed.arrived:
                self.put(cell, followed.orbit)
                return
        raise ArithmeticError("orbit: could not be followed to a cell near its parameters")

    def follow(self, cell, direction):
        """Follow the orbit of a cell to the neighbour in a direction, by tangents."""
        target = self.beside(cell, direction)
        followed = self.follow_to(self.orbits[cell], self.points[target])
        if not followed.arrived:
            self.failed.append((followed.status, cell, target, followed.orbit))
        return followed

    def ends(self):
        """Return where the orbit ends between cells, as `crossings` does."""
        return [
            (kind, last, self.points[target])
            for kind, _, target, last in self.failed
            if target not in self.orbits
        ]

    def crossings(self):
        """Return changes of sign as kinds, places, and scaled parameters of the place beyond."""
        pairs = [(self.orbits[cell], last) for _, cell, _, last in self.failed]
        pairs += [
            (place, self.orbits[target])
            for cell, place in self.orbits.items()
            for target in (self.beside(cell, (0, 1)), self.beside(cell, (1, 0)))
            if target in self.orbits
        ]
        return [
            (kind, first, second.shares)
            for kind in (FOLD, SYMMETRY, TORUS)
            for first, second in pairs
            if first.tests[kind] * second.tests[kind] < 0
        ]

    def locate(self, kind, first, beyond):
        """Find a point of an edge between a place and the scaled parameters of the next place.

        Returns problem and point, or None, and whether the edge was missed. A torus test that
        changes its sign by two real multipliers is no edge and not missed.
        """
        if np.max(np.abs(concerned(kind, first.orbit.root)[1])) > UNSTABLE:
            return None, False
        sign = first.tests[kind]
        spacing = np.max(np.linalg.norm(self.points[1:, 1:] - self.points[:-1, :-1], axis=-1))
        for _ in range(BISECTIONS):
            way = beyond - first.shares
            border = np.array([0, 0, 0, 0, -way[1], way[0]]) / np.linalg.norm(way)
            near = self.values(first.shares)
            problem, point = point_near(self.family, kind, first.orbit, near, self.spans, border)
            if point is not None and np.linalg.norm(point.x[4:] - first.shares) < 2 * spacing:
                fault = problem.fault(point)
                return (None if fault else (problem, point)), fault == "contacts_change"
            followed = self.follow_to(first, (first.shares + beyond) / 2)
            middle = followed.orbit
            if not followed.arrived:
                break
            if middle.tests[kind] * sign > 0:
                first = middle
            else:
                first, beyond, sign = middle, first.shares, -sign
        return None, True

    def follow_to(self, start, target) -> Followed:
        """Follow an orbit to scaled parameters; the status is the kind of edge where it ends."""
        here, share, length = start, 0.0, 1.0
        while share < 1:
            ahead = min(share + length, 1.0)
            place, end = self._step(here, (1 - ahead) * start.shares + ahead * target)
            if not end:
                here, share, length = place, ahead, 2 * length
            elif length > SHORTEST:
                length /= 2
            else:
                break
        return Followed((0.0, share), (start, here), end, share == 1)

    def _step(self, here, shares):
        """Return the place at scaled parameters near those of `here`, or the kind of edge met."""
        p = self.family(*self.values(shares))
        guess = here.orbit.state + here.slopes @ (shares - here.shares)
        orbit = _corrected(p, guess, here.orbit.phase)
        if orbit is None:
            near_wall = here.tests[GRAZING] > -TOUCHING * p[CLEARANCE]
            return None, GRAZING if near_wall else FOLD
        if len(orbit.contacts) != 2 * self.contacts:
            return None, GRAZING
        phase = orbit.quiet_phase()
        if phase != orbit.phase:
            orbit = _corrected(p, orbit.at(phase), phase % TURN)
        return (None, FOLD) if orbit is None else (self._place(orbit, shares), "")

    def _place(self, orbit, shares):
        path = path_of(orbit)
        slopes = Variations(path).slopes() @ scaled_slopes(self.family, self.spans, shares)
        try:
            slopes = np.linalg.solve(np.eye(4) - orbit.root, -slopes)
        except np.linalg.LinAlgError:  # exactly at a fold
            slopes = np.zeros((4, 2))
        tests = {kind: value(kind, path, self.contacts) for kind in KINDS}
        return Place(orbit, np.asarray(shares), slopes, path, tests)


def _corrected(p, guess, phase):
    """Return the symmetric orbit near a guess of its state, or None."""
    state, reach = guess, REACH * np.max(np.abs(guess))
    for _ in range(ITERATIONS):
        orbit, end = shoot(p, state, 1, phase, symmetric=True)
        if orbit.converged:
            return orbit
        try:
            state = state + np.linalg.solve(np.eye(4) - orbit.root, end - state)
        except np.linalg.LinAlgError:
            return None
        if not np.max(np.abs(state - guess)) < reach:
            return None
    return None
