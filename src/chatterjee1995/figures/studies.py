"""Maps of the largest displacement against mass ratio and clearance (figure kind `studies`).

A study runs motions from random starts (initial states) in each cell of a grid of parameters.
"""

from itertools import product

import numpy as np
from matplotlib.colors import LogNorm

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.panels.maps import hatch, mesh, span
from impact_damper.plot.panels.style import BLACK, ROLES, axis_label, figure, legend, style

CAPTION = """
Colour: the largest displacement of all motions to which random starts lead. Hatched: not all
motions settled; some may be long transients. Line: rule (18) for the clearance. Stars: for each
mass ratio the clearance with the smallest displacement.
"""

# Hatching of the cells in which not all motions settled.
UNSETTLED = {"hatch": "////", "edgecolor": BLACK, "linewidth": 0}


@style()
def draw_studies(*, studies):
    """Draw one panel for each restitution (row) and frequency (column).

    Parameters
    ----------
    studies : list of xarray.Dataset
        One dataset of the stage studies.

    Returns
    -------
    matplotlib.figure.Figure
    """
    (data,) = studies
    pairs = list(product(data["restitution"].values, data["frequency"].values))
    rows, columns = data.sizes["restitution"], data.sizes["frequency"]
    drawn = figure("single" if columns == 1 else "double", 3.6 * rows)
    panels = drawn.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    sizes = data["largest_displacement"].values
    sizes = sizes[np.isfinite(sizes)]
    norm = LogNorm(sizes.min(), sizes.max())
    for axes, (e, w) in zip(panels.flat, pairs, strict=True):
        shown = _draw(axes, data.sel(frequency=w, restitution=e), norm)
        if len(pairs) > 1:
            axes.set_title(rf"$\Omega = {w:g}$, $e = {e:g}$")
    for axes in panels[:, 0]:
        axes.set_ylabel(axis_label(data["clearance"]))
    for axes in panels[-1]:
        axes.set_xlabel(axis_label(data["mass_ratio"]))
    drawn.colorbar(shown, ax=panels, label="Largest displacement that starts lead to")
    legend(drawn, 1 if columns == 1 else 3)
    return drawn


def _draw(axes, data, norm):
    """Draw one panel, and return its coloured mesh."""
    grid = data["mass_ratio"].values, data["clearance"].values
    shown = mesh(axes, *grid, data["largest_displacement"].values.T, norm)
    settled = data["outcome_count"].sel(counted_outcome=["settled", "non_colliding"])
    part = settled.sum("counted_outcome").values.T < parameters_of(data)["starts"]
    if part.any():
        hatch(axes, *grid, part, **UNSETTLED)
    axes.fill([], [], facecolor="none", label="not all motions settled", **UNSETTLED)
    axes.plot(grid[0], data["rule_clearance"], color=BLACK, label=r"$r_m \Omega^2 d_0 = 1$")
    best = ROLES["optimum"] | {"label": "smallest at this mass ratio"}
    axes.plot(grid[0], data["best_clearance"], **best)
    axes.set_ylim(*span(grid[1]))
    return shown
