"""Maps over two parameters: coloured cells, hatched cells, and the map of migration."""

import numpy as np
from matplotlib.colors import Normalize
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from impact_damper.plot import style


def mesh(axes, x, y, values, norm, absent=None):
    """Draw and return cells coloured by `values`. Hatch NaN cells, with `absent` in the legend."""
    back = {"facecolor": style.PALE, "hatch": "////", "edgecolor": style.GREY}
    axes.patch.set(linewidth=0, **back)
    if absent:
        axes.fill([], [], label=absent, **back)
    cells = {"shading": "nearest", "rasterized": True, "norm": norm, "cmap": "cividis_r"}
    return axes.pcolormesh(x, y, values, **cells)


def hatch(axes, x, y, where, **look):
    """Hatch the cells at which the mask `where` is true."""
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
    """Return the edges of two or more cells. Inner edges are midway between the centres."""
    middles = (centres[1:] + centres[:-1]) / 2
    return np.concatenate([[2 * centres[0] - middles[0]], middles, [2 * centres[-1] - middles[-1]]])


@style.context()
def migration_map(data):
    """Return the figure of the share of releases that succeed, over frequency and gap."""
    drawn = style.figure("single", 3.2)
    axes = drawn.subplots()
    frequencies, gaps = data["released_frequency"].values, data["released_gap"].values
    shares = 100 * data["migration_share"].values
    cells = mesh(axes, frequencies, gaps, shares, Normalize(0, 100), "one motion without damper")
    drawn.colorbar(cells, label="Releases that succeed (%)")
    sure = np.array(data["migration_status"] == 1)
    places = np.argwhere(sure)
    look = {"color": style.BLACK, "marker": "o", "markersize": 3, "linestyle": "", "mfc": "white"}
    label = f"sure ({100 * float(data['migration_required']):g} % at 95 %)"
    axes.plot(frequencies[places[:, 1]], gaps[places[:, 0]], label=label, **look)
    axes.set(xlabel="Forcing frequency (Hz)", ylabel="Gap, full play (mm)", yscale="log")
    style.legend(drawn, 1)
    return drawn
