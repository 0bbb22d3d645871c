"""Parts of maps over two parameters: coloured or hatched cells, contour lines, legend entries."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from impact_damper.plot.style import BLACK, GREY, PALE

COLOURS = "cividis_r"


def mesh(axes, x, y, values, norm):
    """Draw cells coloured by value, and return the mesh; NaN leaves the hatched background."""
    axes.set_facecolor(PALE)
    axes.patch.set(hatch="////", edgecolor=GREY, linewidth=0)
    return axes.pcolormesh(
        x, y, values, norm=norm, cmap=COLOURS, shading="nearest", rasterized=True
    )


def marked(axes, x, y, where, colour):
    """Draw the cells of a mask in one colour."""
    values = np.where(where, 1.0, np.nan)
    cells = ListedColormap([colour])
    axes.pcolormesh(x, y, values, cmap=cells, vmin=0, vmax=2, shading="nearest", rasterized=True)


def hatch(axes, x, y, where, **look):
    """Hatch the cells of a mask, drawn as a single path because one path per cell is slow."""
    x, y = edges_of(x), edges_of(y)
    cells = [
        Path.unit_rectangle().transformed(
            Affine2D.from_values(x[j + 1] - x[j], 0, 0, y[i + 1] - y[i], x[j], y[i])
        )
        for i, j in zip(*np.nonzero(where), strict=True)
    ]
    path = Path.make_compound_path(*cells)
    axes.add_patch(PathPatch(path, facecolor="none", rasterized=True, **look))


def contours(axes, x, y, values, level, line):
    """Draw the contour lines of one level, if there are values above and below it."""
    if np.nanmin(values) < level < np.nanmax(values):
        axes.contour(x, y, values, [level], colors=BLACK, linewidths=0.8, linestyles=line)


def key(axes, label, colour, hatch=None):
    """Add a legend entry for cells of one appearance."""
    axes.add_patch(
        Rectangle(
            (np.nan, np.nan), 0, 0, facecolor=colour, edgecolor=GREY, hatch=hatch, label=label
        )
    )


def edges_of(centres):
    """Return the edges of at least two cells, midway between their centres, shape (n + 1,)."""
    middles = (centres[1:] + centres[:-1]) / 2
    return np.concatenate([[2 * centres[0] - middles[0]], middles, [2 * centres[-1] - middles[-1]]])


def edges(values):
    """Return cell edges midway between logarithmic centres; a single cell is a decade wide."""
    if len(values) == 1:
        return np.asarray(values) * np.sqrt([0.1, 10])
    return np.exp(edges_of(np.log(values)))
