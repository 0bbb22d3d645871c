"""Parts of maps over two parameters: coloured or hatched cells, contour lines, legend entries."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from impact_damper.plot import style


def mesh(axes, x, y, values, norm, absent=None):
    """Draw and return cells coloured by value. NaN is hatched; the legend calls it `absent`."""
    back = {"facecolor": style.PALE, "hatch": "////", "edgecolor": style.GREY}
    axes.patch.set(linewidth=0, **back)
    if absent:
        axes.fill([], [], label=absent, **back)
    cells = {"shading": "nearest", "rasterized": True, "norm": norm, "cmap": "cividis_r"}
    return axes.pcolormesh(x, y, values, **cells)


def marked(axes, x, y, where, colour, label):
    """Draw the cells of a mask in one colour."""
    cells = {"cmap": ListedColormap([colour]), "shading": "nearest", "rasterized": True}
    axes.pcolormesh(x, y, np.ma.masked_where(~where, where), **cells)
    axes.fill([], [], facecolor=colour, edgecolor=style.GREY, label=label)


def hatch(axes, x, y, where, **look):
    """Hatch the cells of a mask as a single path, because one path per cell is slow."""
    x, y = edges_of(x), edges_of(y)
    cells = [
        Path.unit_rectangle().transformed(
            Affine2D.from_values(x[j + 1] - x[j], 0, 0, y[i + 1] - y[i], x[j], y[i])
        )
        for i, j in zip(*np.nonzero(where), strict=True)
    ]
    path = Path.make_compound_path(*cells)
    axes.add_patch(PathPatch(path, facecolor="none", rasterized=True, **look))


def edges_of(centres):
    """Return the edges of at least two cells, midway between their centres, shape (n + 1,)."""
    middles = (centres[1:] + centres[:-1]) / 2
    return np.concatenate([[2 * centres[0] - middles[0]], middles, [2 * centres[-1] - middles[-1]]])


def edges(values):
    """Return edges of cells, midway on a logarithmic axis. A single cell is a decade wide."""
    if len(values) == 1:
        return np.asarray(values) * np.sqrt([0.1, 10])
    return np.exp(edges_of(np.log(values)))
