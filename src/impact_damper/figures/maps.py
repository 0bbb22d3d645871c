"""Cells of maps of where methods fail: edges of logarithmic grids, coloured flags, legends."""

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap


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
            key = {"marker": "s", "linestyle": "none", "markeredgecolor": "#6E6E6E"}
            axes.plot([], [], color=roles[name][0], label=roles[name][1], markersize=7, **key)
