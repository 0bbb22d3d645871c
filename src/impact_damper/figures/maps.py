"""What maps of cells share: the mesh on axes that tell apart cells without a result."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import Rectangle

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
