"""Parts that all maps use: coloured or hatched cells, contour lines, legend entries."""

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from impact_damper.plot.panels.style import BLACK, GREY, PALE

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


def span(centres):
    """Return the outer edges of the first and last cell, from evenly spaced cell centres."""
    return centres[0] - np.diff(centres)[0] / 2, centres[-1] + np.diff(centres)[-1] / 2


def hatch(axes, x, y, where, **look):
    """Hatch the cells of a mask, drawn as a single path because one path per cell is slow."""
    x, y = (np.linspace(*span(centres), len(centres) + 1) for centres in (x, y))
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


def edges(values):
    """Return cell edges from logarithmically spaced centres; a single cell is a decade wide."""
    logarithms = np.log(values)
    if len(logarithms) == 1:
        return np.exp(logarithms[0] + np.log(10) * np.array([-0.5, 0.5]))
    middles = (logarithms[1:] + logarithms[:-1]) / 2
    ends = 2 * logarithms[[0, -1]] - middles[[0, -1]]
    return np.exp(np.concatenate([ends[:1], middles, ends[1:]]))


def flags(axes, x, y, values, meanings, roles):
    """Draw cells coloured by a flag, an integer that codes a meaning, and add legend entries.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    x, y : array
        Edges of the cells.
    values : array, shape (len(y) - 1, len(x) - 1)
        Values of the flag.
    meanings : dict of int
        Value of the flag, keyed by its meaning.
    roles : dict
        Colour and legend text, keyed by meaning.
    """
    shown = sorted(meanings, key=meanings.get)
    bounds = np.append([meanings[name] for name in shown], meanings[shown[-1]] + 1) - 0.5
    colors = ListedColormap([roles[name][0] for name in shown])
    axes.pcolormesh(x, y, values, cmap=colors, norm=BoundaryNorm(bounds, len(shown)))
    for name in shown:
        if np.isin(meanings[name], values):
            key = {"marker": "s", "linestyle": "none", "markeredgecolor": GREY}
            axes.plot([], [], color=roles[name][0], label=roles[name][1], markersize=7, **key)
