"""The quiet orbit on a grid of two parameters, and the pairs of cells between which edges lie.

The quiet orbit is the symmetric periodic motion for which a damper is designed. The orbit is
followed from cell to cell, with exact derivatives of its state by the parameters. An edge is a
curve in the plane of the parameters on which the orbit loses its stability (`curves`). A test
function is zero on an edge, and its sign differs on the two sides (`problem`).

Multipliers are Floquet multipliers.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import CLEARANCE
from impact_damper.motions.following import Followed
from impact_damper.orbits.edge_curves import point_near
from impact_damper.orbits.edge_problem import (
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
from impact_damper.orbits.grid_following import Grid
from impact_damper.orbits.orbit import TURN, Orbit
from impact_damper.orbits.paths import Path
from impact_damper.orbits.sensitivity import path_of
from impact_damper.orbits.shooting import shoot
from impact_damper.orbits.variations import Variations

# Limits of Newton's method for an orbit.
# ITERATIONS: largest number of corrections.
# REACH: largest distance from the predicted state, divided by the largest component of the state.
ITERATIONS, REACH = 8, 0.1
# The first orbit, whose parameters are in general between cells, is followed to one of the STARTS
# nearest cells. If this fails, the next nearest cell is tried.
STARTS = 4
# Shortest step between cells, divided by the distance of the cells.
SHORTEST = 1 / 64
# Largest number of bisections in the search for an edge between two cells.
BISECTIONS = 6
# If Newton's method fails, the orbit has ended by a new contact (grazing) or by a fold. The reason
# is grazing if, in the last orbit, the loose mass turns back at a distance from a wall below
# TOUCHING times the clearance.
TOUCHING = 0.05


class Place(NamedTuple):
    """An orbit at a point of the rectangle of parameters.

    Attributes
    ----------
    orbit : Orbit
    coordinates : numpy.ndarray, shape (2,)
        Both parameters, scaled so that their spans become 0 to 1.
    slopes : numpy.ndarray, shape (4, 2)
        Derivatives of the state with respect to the scaled parameters.
    path : Path
        The orbit over half a period.
    tests : dict
        Values of the test functions, keyed by the kind of edge (`problem.KINDS`).
    """

    orbit: Orbit
    coordinates: np.ndarray
    slopes: np.ndarray
    path: Path
    tests: dict


class EdgeGrid(Grid):
    """A grid with a `Place` in each cell that is reached.

    An orbit is followed from cell to cell: its state is predicted with the derivatives
    `Place.slopes` and corrected by Newton's method.

    Attributes
    ----------
    family : callable
        Maps both parameters to the array of all (packed) parameters of the system.
    spans : numpy.ndarray, shape (2, 2)
        Least and greatest value of each parameter.
    contacts : int
        Number of contacts in half a period.
    failed : list
        One entry for each orbit that ends between a cell and its neighbour: the kind of edge that
        must lie there, the cell, the neighbour, and the last `Place` that was reached.
    """

    def __init__(self, family, spans, axes, contacts):
        self.family, self.spans, self.contacts, self.failed = family, spans, contacts, []
        points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        super().__init__(self.scaled(points), None)

    def scaled(self, values):
        """Return parameters scaled so that their spans become 0 to 1."""
        return (values - self.spans[:, 0]) / np.ptp(self.spans, axis=1)

    def values(self, coordinates):
        """Return the unscaled parameters: the inverse of `scaled`."""
        return self.spans[:, 0] + np.ptp(self.spans, axis=1) * coordinates

    def begin(self, orbit, coordinates):
        """Follow an orbit to one of the cells nearest to it, and enter the result in this cell.

        `coordinates` are the scaled parameters of the orbit.

        Raises
        ------
        ArithmeticError
            If none of the STARTS nearest cells is reached.
        """
        start = self._place(orbit, coordinates)
        distance = np.max(np.abs(self.points - coordinates), axis=-1)
        for k in np.argsort(distance, axis=None)[:STARTS]:
            cell = tuple(int(i) for i in np.unravel_index(k, self.shape))
            followed = self.follow_to(start, self.points[cell])
            if followed.arrived:
                self.put(cell, followed.orbit)
                return
        raise ArithmeticError("orbit: could not be followed to a cell near its parameters")

    def follow(self, cell, direction):
        """Follow the orbit of a cell to the neighbouring cell in a direction."""
        target = self.beside(cell, direction)
        followed = self.follow_to(self.orbits[cell], self.points[target])
        if not followed.arrived:
            self.failed.append((followed.status, cell, target, followed.orbit))
        return followed

    def ends(self):
        """Return the pairs of cells between which the orbit ends, in the form of `crossings`."""
        return [
            (kind, last, self.points[target])
            for kind, _, target, last in self.failed
            if target not in self.orbits
        ]

    def crossings(self):
        """Return a list of the pairs of neighbours between which a test function changes sign.

        Each entry consists of the kind of edge, the `Place` on one side, and the scaled parameters
        on the other side. If the orbit ends between two cells, the pair consists of the first cell
        and the last place that was reached.
        """
        pairs = [(self.orbits[cell], last) for _, cell, _, last in self.failed]
        pairs += [
            (place, self.orbits[target])
            for cell, place in self.orbits.items()
            for target in (self.beside(cell, (0, 1)), self.beside(cell, (1, 0)))
            if target in self.orbits
        ]
        return [
            (kind, first, second.coordinates)
            for kind in (FOLD, SYMMETRY, TORUS)
            for first, second in pairs
            if first.tests[kind] * second.tests[kind] < 0
        ]

    def locate(self, kind, first, beyond):
        """Find a point of an edge between two points on both sides of it.

        Parameters
        ----------
        kind : str
            One of `problem.KINDS`.
        first : Place
            Place on one side of the edge.
        beyond : array, shape (2,)
            Scaled parameters on the other side.

        Returns
        -------
        found : tuple or None
            `Problem` and `Point`; None if no point was found.
        missed : bool
            Whether an edge exists that was not found. It is False if stability is not lost at the
            zero of the test function. An example is the test function of a Neimark-Sacker
            bifurcation, which also vanishes if the product of two real multipliers is 1.
        """
        if np.max(np.abs(concerned(kind, first.orbit.root)[1])) > UNSTABLE:
            return None, False
        sign = first.tests[kind]
        spacing = np.max(np.linalg.norm(self.points[1:, 1:] - self.points[:-1, :-1], axis=-1))
        for _ in range(BISECTIONS):
            way = beyond - first.coordinates
            border = np.array([0, 0, 0, 0, -way[1], way[0]]) / np.linalg.norm(way)
            near = self.values(first.coordinates)
            problem, point = point_near(self.family, kind, first.orbit, near, self.spans, border)
            if point is not None and np.linalg.norm(point.x[4:] - first.coordinates) < 2 * spacing:
                fault = problem.fault(point)
                return (None if fault else (problem, point)), fault == "contacts_change"
            followed = self.follow_to(first, (first.coordinates + beyond) / 2)
            middle = followed.orbit
            if not followed.arrived:
                break
            if middle.tests[kind] * sign > 0:
                first = middle
            else:
                first, beyond, sign = middle, first.coordinates, -sign
        return None, True

    def follow_to(self, start, target) -> Followed:
        """Follow an orbit to the scaled parameters `target`.

        Steps are halved where Newton's method fails. The status of the result is the kind of edge
        at which the orbit ends, or "".
        """
        last, fraction, length = start, 0.0, 1.0
        while fraction < 1:
            ahead = min(fraction + length, 1.0)
            place, end = self._step(last, (1 - ahead) * start.coordinates + ahead * target)
            if not end:
                last, fraction, length = place, ahead, 2 * length
            elif length > SHORTEST:
                length /= 2
            else:
                break
        return Followed((0.0, fraction), (start, last), end, fraction == 1)

    def _step(self, last, coordinates):
        """Follow an orbit from the place `last` to nearby scaled parameters, in one step.

        Return the new place and "". If the orbit ends before, return None and the kind of edge at
        which it ends.
        """
        p = self.family(*self.values(coordinates))
        guess = last.orbit.state + last.slopes @ (coordinates - last.coordinates)
        orbit = _corrected(p, guess, last.orbit.phase)
        if orbit is None:
            near_wall = last.tests[GRAZING] > -TOUCHING * p[CLEARANCE]
            return None, GRAZING if near_wall else FOLD
        if len(orbit.contacts) != 2 * self.contacts:
            return None, GRAZING
        phase = orbit.flight_phase()
        if phase != orbit.phase:
            orbit = _corrected(p, orbit.at(phase), phase % TURN)
        return (None, FOLD) if orbit is None else (self._place(orbit, coordinates), "")

    def _place(self, orbit, coordinates):
        """Return the `Place` of an orbit."""
        path = path_of(orbit)
        slopes = Variations(path).slopes() @ scaled_slopes(self.family, self.spans, coordinates)
        try:
            slopes = np.linalg.solve(np.eye(4) - orbit.root, -slopes)
        except np.linalg.LinAlgError:  # exactly at a fold
            slopes = np.zeros((4, 2))
        tests = {kind: value(kind, path, self.contacts) for kind in KINDS}
        return Place(orbit, np.asarray(coordinates), slopes, path, tests)


def _corrected(p, guess, phase):
    """Return the symmetric orbit that Newton's method finds near a guessed state, or None."""
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
