"""Release by state: the states at which switching the damper off leads to the small free motion.

The goal is the smaller of the two period-1 motions that the oscillator has without the damper.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.ndimage import distance_transform_edt, maximum_filter, minimum_filter

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.motions.attractors import REACH, Attractors, free_attractors
from impact_damper.motions.ensemble import label_states
from impact_damper.motions.start_states import free_motions

# Number of phases in a forcing cycle at which a controller observes the state; even.
PHASES = 16
# Half width of the grid in Z1 and in Z1'/W, divided by max |Z1| of the resonance motion. Larger
# states count as outside the set.
WIDTH = 1.6
# Number of cells of the fine grid in a cell of the coarse grid, along an axis; a power of 2.
REFINED = 4


class ReleaseSet(NamedTuple):
    """The states of the free oscillator at one frequency that lead to the goal.

    Attributes
    ----------
    p : numpy.ndarray, shape (packed.COUNT,)
        Packed parameters without a damper.
    attractors : attractors.Attractors
        The stable free motions; the last one is the resonance motion.
    goal : int
        Index of the goal among the attractors.
    depth : numpy.ndarray, shape (PHASES, cells, cells)
        Distance of a state from the boundary of the set, positive inside, in units of Z1, with Z1'
        divided by W. Axes: phase, Z1', Z1.
    half : numpy.ndarray, shape (2,)
        Half widths of the grid in Z1 and Z1'.
    """

    p: np.ndarray
    attractors: Attractors
    goal: int
    depth: np.ndarray
    half: np.ndarray


def release_set(oscillator, frequency, settling, *, cells=64, workers=1) -> ReleaseSet:
    """Compute the release set at one frequency on a grid at each of PHASES phases.

    A mirrored state half a cycle later leads to the mirrored motion, and the goal is its own mirror
    image, so only half of the phases are computed. `cells` is the number of states on each axis of
    the coarse grid.

    Raises
    ------
    ValueError
        If the free oscillator does not have both a non-resonance and a resonance motion.
    """
    p = pack(oscillator, None, frequency)
    known = free_motions(oscillator, frequency, settling)
    window = REACH / 2 * np.array([known.displacement, known.speed])
    attractors = free_attractors(p, window, settling)
    ones = np.flatnonzero(attractors.records["period"] == 1)
    if len(ones) < 2 or ones[-1] != len(attractors.records) - 1:
        raise ValueError(
            f"frequency = {frequency:g}: must have a non-resonance and a resonance motion "
            "without the damper"
        )
    goal = int(ones[0])
    size = attractors.records["maximum_displacement"][-1]
    half = WIDTH * size * np.array([1.0, p[FREQUENCY]])
    depth = []
    for k in range(PHASES // 2):

        def reach_goal(states, phase=2 * math.pi * k / PHASES):
            arguments = attractors, settling.tolerance, settling.limit, workers
            return label_states(p, states, phase, *arguments)[0] == goal

        inside = _refined(reach_goal, half, cells)
        depth.append(signed_distance(inside) * 2 * WIDTH * size / len(inside))
    depth = np.array(depth + [each[::-1, ::-1] for each in depth])
    return ReleaseSet(p, attractors, goal, depth, half)


def _refined(inside, half, cells):
    """Return which cells of the fine grid lie inside a set, shape (n, n) with n = REFINED cells.

    The function `inside` takes states, shape (m, 2). It is called for all cells of the coarse grid,
    and on finer grids only for cells near the boundary.
    """
    mask = inside(_centres(half, cells)).reshape(cells, cells)
    for _ in range(int(math.log2(REFINED))):
        # The cells at the boundary: those with a different neighbour, and their neighbours.
        edge = maximum_filter(mask, 3) != minimum_filter(mask, 3)
        fine, edge = (np.kron(each, np.ones((2, 2), bool)) for each in (mask, edge))
        cells *= 2
        fine[edge] = inside(_centres(half, cells)[edge.ravel()])
        mask = fine
    return mask


def _centres(half, cells):
    """Return the centres of the cells of a grid, shape (cells^2, 2), in rows of equal Z1'."""
    middles = (np.arange(cells) + 0.5) * 2 / cells - 1
    return np.stack(np.meshgrid(half[0] * middles, half[1] * middles), axis=-1).reshape(-1, 2)


def signed_distance(inside):
    """Return the distance of each cell from the boundary of a set, in cells, negative outside."""
    if inside.all() or not inside.any():
        return np.where(inside, np.inf, -np.inf)
    # The boundary lies midway between the centres of two cells.
    inward, outward = distance_transform_edt(inside), distance_transform_edt(~inside)
    return np.where(inside, inward - 0.5, 0.5 - outward)
