"""The release set: states and phases from which the free motion settles to the goal.

The goal is the non-resonance motion, the smaller of the two motions of period 1 that the oscillator
has without the damper. If the damper is switched off at a state and phase of the release set, the
free motion settles to the goal. The set is computed on a grid of states Z1, Z1' at each of several
phases of the forcing. Each state of the grid has a depth: its distance from the boundary of the
set, positive inside and negative outside. The distance is in units of Z1, with Z1' divided by the
frequency W.

Z1 is the displacement of the primary mass.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.ndimage import distance_transform_edt, maximum_filter, minimum_filter

from impact_damper.kernel.compiling import kernel
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions.labels import label_states

# Half width of the grid in Z1 and in Z1'/W, divided by max |Z1| of the resonance motion, the larger
# of the two free motions. Larger states count as outside the set.
WIDTH = 1.6
# Number of cells of the fine grid in a cell of the coarse grid, along an axis; a power of 2.
REFINED = 4


class ReleaseSet(NamedTuple):
    """Depth of the states of a grid inside the release set, at phases that divide a cycle evenly.

    Attributes
    ----------
    depth : numpy.ndarray, shape (phases, cells, cells)
        Depth for each phase, Z1' and Z1, in this order of axes.
    half : numpy.ndarray, shape (2,)
        Half widths of the grid in Z1 and Z1'.
    """

    depth: np.ndarray
    half: np.ndarray

    @property
    def cell(self):
        """Width of a cell in units of Z1."""
        return 2 * self.half[0] / self.depth.shape[1]


def release_set(p, attractors, goal, phases, cells, settling, workers=1) -> ReleaseSet:
    """Return the release set of a free oscillator.

    A mirrored state half a cycle later leads to the mirrored motion, and the goal is its own mirror
    image. Therefore only half of the phases are computed.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters without a damper.
    attractors : attraction.attractors.Attractors
    goal : int
        Index of the goal among the attractors.
    phases : int
        Even number of phases.
    cells : int
        Number of states on each axis of the coarse grid. Near the boundary of the set the grid is
        REFINED times finer.
    settling : Settling
    workers : int
        Number of threads.
    """
    size = attractors.records["maximum_displacement"][-1]
    half = WIDTH * size * np.array([1.0, p[FREQUENCY]])
    depth = []
    for k in range(phases // 2):

        def reach_goal(states, phase=2 * math.pi * k / phases):
            arguments = attractors, settling.tolerance, settling.limit, workers
            return label_states(p, states, phase, *arguments)[0] == goal

        inside = _refined(reach_goal, half, cells)
        depth.append(signed_distance(inside) * 2 * WIDTH * size / len(inside))
    return ReleaseSet(np.array(depth + [each[::-1, ::-1] for each in depth]), half)


def _refined(inside, half, cells):
    """Return the mask of the cells of the fine grid that lie inside a set, shape (n, n).

    n is REFINED times `cells`. The function `inside` takes states, shape (m, 2), and returns which
    of them lie inside. It is called for all cells of the coarse grid, and on finer grids only for
    cells near the boundary.
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


@kernel
def depth_of(depth, half, phase, x, v):
    """Return the depth of a state inside the release set at a phase.

    `depth` and `half` are the attributes of a `ReleaseSet`, and `phase` is the index of a phase.
    x and v are Z1 and Z1'. All states in a cell have the same depth. Beyond the grid the depth is
    minus infinity.
    """
    if not (abs(x) <= half[0] and abs(v) <= half[1]):
        return -math.inf
    cells = depth.shape[1]
    column = min(int((x / half[0] + 1.0) * 0.5 * cells), cells - 1)
    row = min(int((v / half[1] + 1.0) * 0.5 * cells), cells - 1)
    return depth[phase, row, column]
