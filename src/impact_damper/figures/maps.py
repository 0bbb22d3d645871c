"""What maps of cells share: values and flags in colour, cells without a result told apart."""

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from impact_damper.figures.style import BLACK, GREY, PALE

COLOURS = "cividis_r"


def mesh(axes, x, y, values, norm):
    """Cells in colour, over a hatched ground that shows where a value is NaN."""
    axes.set_facecolor(PALE)
    axes.patch.set(hatch="////", edgecolor=GREY, linewidth=0)
    return axes.pcolormesh(
        x, y, values, norm=norm, cmap=COLOURS, shading="nearest", rasterized=True
    )


def marked(axes, x, y, where, colour):
    """Cells of one plain colour."""
    values = np.where(where, 1.0, np.nan)
    cells = ListedColormap([colour])
    axes.pcolormesh(x, y, values, cmap=cells, vmin=0, vmax=2, shading="nearest", rasterized=True)


def span(centres):
    """Outer edges of the first and the last cell of an even grid."""
    return centres[0] - np.diff(centres)[0] / 2, centres[-1] + np.diff(centres)[-1] / 2


def hatch(axes, x, y, where, **look):
    """Hatching over cells as one path; cell by cell it would take longer than all the rest."""
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
    """Contour lines of one level, where there are any."""
    if np.nanmin(values) < level < np.nanmax(values):
        axes.contour(x, y, values, [level], colors=BLACK, linewidths=0.8, linestyles=line)


def key(axes, label, colour, hatch=None):
    """Entry of the legend for cells of one look."""
    axes.add_patch(
        Rectangle(
            (np.nan, np.nan), 0, 0, facecolor=colour, edgecolor=GREY, hatch=hatch, label=label
        )
    )


def edges(values):
    """Edges of the cells around the values of a logarithmic grid; a lone cell is a decade wide."""
    logarithms = np.log(values)
    if len(logarithms) == 1:
        return np.exp(logarithms[0] + np.log(10) * np.array([-0.5, 0.5]))
    middles = (logarithms[1:] + logarithms[:-1]) / 2
    ends = 2 * logarithms[[0, -1]] - middles[[0, -1]]
    return np.exp(np.concatenate([ends[:1], middles, ends[1:]]))


def flags(axes, x, y, values, meanings, roles):
    """Cells of flags in the colours of their roles.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    x, y : array
        Edges of the cells.
    values : array
    meanings : dict
        Value of each flag by its meaning.
    roles : dict
        Colour and words of each meaning.
    """
    shown = sorted(meanings, key=meanings.get)
    bounds = np.append([meanings[name] for name in shown], meanings[shown[-1]] + 1) - 0.5
    colors = ListedColormap([roles[name][0] for name in shown])
    axes.pcolormesh(x, y, values, cmap=colors, norm=BoundaryNorm(bounds, len(shown)))
    for name in shown:
        if np.isin(meanings[name], values):
            key = {"marker": "s", "linestyle": "none", "markeredgecolor": GREY}
            axes.plot([], [], color=roles[name][0], label=roles[name][1], markersize=7, **key)
