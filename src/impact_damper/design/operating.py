"""The operating range of a design: maps over two parameters, with the edges of the quiet orbit.

A start is a random initial state, and a motion is quiet if its largest displacement is at most the
quiet limit. In each cell of a map the starts that lead to quiet motions are counted. The quiet
orbit is the symmetric periodic motion for which a damper is designed. The edges are curves on which
it loses its stability: at a fold, by a loss of symmetry or at a Neimark-Sacker point. They bound
the region in which the orbit is stable. Within the region many starts may still lead to other
motions.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.design.outcomes import Case, are_quiet, run
from impact_damper.design.tolerances import VARIED
from impact_damper.model.bounds import RESTITUTION_RANGE
from impact_damper.orbits.edge_maps import map_edges
from impact_damper.orbits.shooting import shoot

# CELLS: largest number of cells along each axis of a map; fewer for a task with few candidates.
# CELL_STARTS: starts in a cell.
CELLS, CELL_STARTS = 11, 12
# Ends of the map over gap and restitution.
# GAPS: least and greatest gap, divided by the nominal gap.
# LEAST_RESTITUTION: least restitution; the greatest is 1.
GAPS, LEAST_RESTITUTION = (0.5, 1.6), 0.3
# Largest number of cells along each axis of the grid on which edges are found.
EDGE_CELLS = 14
# Edges that are kept, in the words of `edges.curves.Edge.kind`.
KINDS = ("fold", "symmetry_breaking", "neimark_sacker")


class Map(NamedTuple):
    """Motions over two parameters.

    Attributes
    ----------
    first, second : numpy.ndarray, shapes (m,), (n,)
        Values of the two parameters.
    share, worst : numpy.ndarray, shape (m, n)
        Share of starts that lead to quiet motions, and largest displacement of all motions, mm.
    """

    first: np.ndarray
    second: np.ndarray
    share: np.ndarray
    worst: np.ndarray


def map_forces(task, gap, limit, shares, **running) -> Map:
    """Return the `Map` over frequency (Hz) and force, given as multiples of the nominal force.

    `shares` are these multiples. The quiet limit is proportional to the force.
    """
    frequencies, shares = task.few(CELLS), np.asarray(shares)
    place = VARIED.index("force")
    cells = [
        (Case(1e-3 * gap, f, _with(place, share)), limit * share)
        for f in frequencies
        for share in shares
    ]
    return _map(task, frequencies, shares, cells, "force_map", running)


def map_dampers(task, gap, frequency, limit, **running) -> Map:
    """Return the `Map` over gap (mm) and restitution at a frequency (Hz)."""
    count = min(CELLS, task.candidates + 3)
    gaps = gap * np.geomspace(*GAPS, count)
    restitutions = np.linspace(LEAST_RESTITUTION, RESTITUTION_RANGE["most"], count)
    place = VARIED.index("restitution")
    cells = [
        (Case(1e-3 * each, frequency, _with(place, e / task.restitution)), limit)
        for each in gaps
        for e in restitutions
    ]
    return _map(task, gaps, restitutions, cells, "damper_map", running)


def _with(place, factor):
    """Return the factors of the values in VARIED: 1, except `factor` at the index `place`."""
    return tuple(factor if k == place else 1.0 for k in range(len(VARIED)))


def _map(task, first, second, cells, stream, running):
    """Return the `Map` over `first` and `second`.

    `cells` are pairs of a `Case` and its quiet limit (mm), sorted by `first`, then by `second`.
    """
    cases, limits = zip(*cells, strict=True)
    running = {"settling": task.hurried} | running
    records = run(task, cases, CELL_STARTS, stream, **running)
    sizes = task.millimetres(records["maximum_displacement"])
    quiet = are_quiet(sizes, records["outcome"], np.array(limits)[:, None]).mean(axis=1)
    shape = len(first), len(second)
    return Map(first, second, quiet.reshape(shape), sizes.max(axis=1).reshape(shape))


class Curves(NamedTuple):
    """Edges of the quiet orbit over two parameters.

    Attributes
    ----------
    values : numpy.ndarray, shape (n, 2)
        Both parameters at the points of all edges, one edge after the other. Points at which the
        orbit is unstable on both sides are left out.
    kind : numpy.ndarray of int, shape (n,)
        Flag of `edge_kind`.
    number : numpy.ndarray of int, shape (n,)
        Number of the edge of each point.
    lost : int
        Number of changes of stability between cells of the grid for which no edge was found.
    """

    values: np.ndarray
    kind: np.ndarray
    number: np.ndarray
    lost: int


NO_CURVES = Curves(np.empty((0, 2)), np.empty(0, int), np.empty(0, int), 0)


def force_curves(task, gap, frequency, orbit, shares) -> Curves:
    """Return the edges over frequency (Hz) and the multiple of the nominal force.

    Parameters
    ----------
    task : Task
    gap, frequency : float
        mm and Hz, of the orbit.
    orbit : Orbit or None
        Quiet orbit at the nominal values.
    shares : sequence of float
        Multiples of the force; the edges are searched for between the least and the greatest.
    """
    place = VARIED.index("force")
    count = min(EDGE_CELLS, 2 * task.candidates - 2)
    axes = (
        np.linspace(*task.band, count),
        np.geomspace(shares[0], shares[-1], count),
    )

    def family(f, share):
        return task.packed(1e-3 * gap, f, _with(place, share))

    return _curves(family, orbit, (frequency, 1.0), axes)


def damper_curves(task, gap, frequency, orbit) -> Curves:
    """Return the edges over gap (mm) and restitution at a frequency (Hz)."""
    place = VARIED.index("restitution")
    count = min(EDGE_CELLS, 2 * task.candidates - 2)
    axes = (
        gap * np.geomspace(*GAPS, count),
        np.linspace(LEAST_RESTITUTION, RESTITUTION_RANGE["most"], count),
    )

    def family(each, e):
        return task.packed(1e-3 * each, frequency, _with(place, e / task.restitution))

    return _curves(family, orbit, (gap, task.restitution), axes)


def _curves(family, orbit, values, axes):
    """Return the edges of a symmetric orbit over two parameters.

    `family` maps both parameters to packed parameters, and `values` are the parameters of the
    orbit. `axes` are the values of each parameter on a grid over which the orbit is followed. If it
    cannot be followed, no edges are returned, and `lost` is 1.
    """
    if orbit is None:
        return NO_CURVES
    symmetric, _ = shoot(family(*values), orbit.state, 1, orbit.phase, symmetric=True)
    try:
        found = map_edges(family, symmetric, values, axes)
    except (ArithmeticError, ValueError):
        return NO_CURVES._replace(lost=1)
    kept = [edge for edge in found.edges if edge.kind in KINDS]
    if not kept:
        return NO_CURVES._replace(lost=found.lost)
    counts = [int(edge.bounding.sum()) for edge in kept]
    return Curves(
        np.concatenate([edge.values[edge.bounding] for edge in kept]),
        np.repeat([flag("force_edge_kind", edge.kind) for edge in kept], counts),
        np.repeat(np.arange(len(kept)), counts),
        found.lost,
    )
