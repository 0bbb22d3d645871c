"""The operating range of a design: maps over two parameters, with the edges of the quiet orbit.

A map counts in each cell the starts that lead to quiet motions. On the edges the quiet orbit folds,
loses its symmetry or meets a Neimark-Sacker point. They bound the region in which the orbit is
stable; starts need not lead to it there.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.design.outcomes import Case, are_quiet, run
from impact_damper.design.tolerances import VARIED
from impact_damper.edges.maps import map_edges
from impact_damper.orbits.shooting import shoot
from impact_damper.system.bounds import RESTITUTION_RANGE

# Largest number of cells along each axis of a map (fewer for a task with few candidates), and
# starts in a cell. Largest ratio of a gap to the nominal one; least restitution.
CELLS, CELL_STARTS = 11, 12
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
    share, worst : numpy.ndarray, shape (m, n)
        Share of starts that lead to quiet motions, and largest displacement of all motions, mm.
    """

    first: np.ndarray
    second: np.ndarray
    share: np.ndarray
    worst: np.ndarray


def map_forces(task, gap, limit, shares, **running) -> Map:
    """Return the motions over frequency (Hz) and `shares`, multiples of the nominal force.

    The quiet limit is proportional to the force.
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
    """Return the motions at a frequency over gap (mm) and restitution."""
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
    """Return the nominal factors with one of them replaced."""
    return tuple(factor if k == place else 1.0 for k in range(len(VARIED)))


def _map(task, first, second, cells, stream, running):
    """Return the motions in the cells of a map, each with a quiet limit of its own."""
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
        Points of all edges, one edge after the other, that bound a stable region.
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
    """Return the edges of the branch of an orbit; none if no orbit is found near the given one."""
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
