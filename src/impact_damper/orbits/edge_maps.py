"""Find all edges of the quiet orbit in a rectangle of two parameters.

The quiet orbit is the symmetric periodic motion for which a damper is designed. An edge is a curve
in the plane of the parameters on which this orbit loses its stability (`curves`). The orbit is
followed to the cells of a grid. For each kind of edge a test function is zero on the edge
(`problem`). If a test function changes its sign between neighbouring cells, or the orbit ends
between them, a point of an edge lies between the cells. The edge is followed from this point.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.orbits.edge_curves import Edge, check_start, edge_through
from impact_damper.orbits.edge_grid import EdgeGrid


class EdgeMap(NamedTuple):
    """Quiet orbits on a grid of n by m values of two parameters, and their edges.

    Attributes
    ----------
    axes : tuple of numpy.ndarray, shapes (n,) and (m,)
        Values of both parameters.
    orbits : dict
        Orbits, keyed by (row, column), of the cells that were reached.
    modulus : numpy.ndarray, shape (n, m)
        Modulus of the largest Floquet multiplier; NaN in cells that were not reached.
    displacement : numpy.ndarray, shape (n, m)
        Largest displacement |Z1| of the primary mass; NaN in cells that were not reached.
    edges : list of Edge
    lost : int
        Number of pairs of neighbouring cells between which an edge was expected and none was found.
        Either Newton's method failed, or the cells hold orbits of different branches.
    """

    axes: tuple[np.ndarray, np.ndarray]
    orbits: dict
    modulus: np.ndarray
    displacement: np.ndarray
    edges: list[Edge]
    lost: int


def map_edges(family, orbit, values, axes) -> EdgeMap:
    """Find the edges of a symmetric orbit of period 1 in a rectangle of two parameters.

    An edge is found only if two neighbouring cells of the grid lie on different sides of it.

    Parameters
    ----------
    family : callable
        Maps two parameters to the packed parameters of a system, shape (packed.COUNT,).
    orbit : Orbit
        A converged symmetric orbit (`Orbit.root` is not None).
    values : sequence of float
        Both parameters of the orbit.
    axes : sequence of two arrays
        Two or more increasing values of each parameter.

    Returns
    -------
    EdgeMap

    Raises
    ------
    ValueError
        If the orbit has no root or lies outside the axes, or if an axis does not increase.
    ArithmeticError
        If the orbit cannot be followed to any of the cells nearest to its parameters.
    """
    axes = tuple(np.asarray(axis, float) for axis in axes)
    for axis in axes:
        if len(axis) < 2 or not np.all(np.diff(axis) > 0):
            raise ValueError(f"axes: must increase, two values or more, {axis.tolist()} given")
    spans = np.array([[axis[0], axis[-1]] for axis in axes])
    values = check_start(orbit, values, spans)
    grid = EdgeGrid(family, spans, axes, len(orbit.contacts) // 2)
    grid.begin(orbit, grid.scaled(values))
    grid.spread()
    edges, missed = [], []
    for kind, first, beyond in [*grid.crossings(), *grid.ends()]:
        if _crossed(edges, kind, first, beyond):
            continue
        start, lost = grid.locate(kind, first, beyond)
        if lost:
            missed.append((kind, first, beyond))
        if start and not any(edge.holds(start[1].x[4:]) for edge in edges if edge.kind == kind):
            edges.append(edge_through(*start))
    lost = sum(not _crossed(edges, kind, *way) for kind, *way in missed)
    modulus, displacement = np.full((2, *map(len, axes)), np.nan)
    for cell, place in grid.orbits.items():
        modulus[cell] = abs(place.orbit.multipliers[0])
        displacement[cell] = np.max(np.abs(place.path.turns(0)[1]))
    orbits = {cell: place.orbit for cell, place in grid.orbits.items()}
    return EdgeMap(axes, orbits, modulus, displacement, edges, lost)


def _crossed(edges, kind, first, beyond):
    """Return whether one of the edges has this kind and crosses the line from `first` to `beyond`.

    `first` is a `grid.Place`, and `beyond` are scaled parameters, shape (2,).
    """
    return any(edge.crosses(first.coordinates, beyond) for edge in edges if edge.kind == kind)
