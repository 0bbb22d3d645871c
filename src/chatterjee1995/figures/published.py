"""Differences between published numbers and ours, by publication (figure kind `published`).

Ours are the numbers that this package computes.
"""

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.plot.panels.style import BLACK, BLUE, PALE, VERMILION, figure, legend, style

CAPTION = """
Relative difference between each number computed here and the published one, one band for each
publication. Tick: difference expected from finite contact stiffness or mass ratio, from sampling of
starts, or from a linear spring in place of Hertz's contact. Open: extrapolated to rigid walls.
Differences below 1e-12 stand at the left edge.
"""

# Labels of publications, from the top.
GROUPS = {
    "masri_caughey": "rigid walls\nMasri, Caughey 1966",
    "slow_manifold": "vibro-impact absorber\nGendelman 2012, Gourc 2015",
    "den_hartog": "tuned absorber\nDen Hartog 1956",
    "nishihara_asami": "tuned absorber, exact\nNishihara, Asami 2002",
    "habib": "nonlinear absorber\nHabib et al. 2015",
    "bstab": "basin shares\nStender, Hoffmann 2022",
    "brennan": "jumps\nBrennan et al. 2008",
    "hertz": "elastic impact\nHertz, in Johnson 1985",
}
LEAST = 1e-12  # left edge of the plot
# Fraction of the height of a band in which its points lie.
FILLED = 0.8
OURS = {"color": BLUE, "marker": ".", "markersize": 4, "label": "ours"}
EXPECTED = {"color": VERMILION, "marker": "|", "markersize": 5, "label": "expected"}
LIMIT = {
    "color": BLACK,
    "marker": "o",
    "markersize": 2.6,
    "markerfacecolor": "none",
    "markeredgewidth": 0.5,
    "label": "ours, extrapolated to rigid walls",
}


@style()
def draw_published(*, published):
    """Draw the relative difference of each comparison.

    Parameters
    ----------
    published : list of xarray.Dataset
        One dataset of the stage published.

    Returns
    -------
    matplotlib.figure.Figure
    """
    (data,) = published
    drawn = figure("double", 4.4)
    axes = drawn.subplots()
    theirs = data["published_value"].values
    labels = []
    for band, (name, label) in enumerate(GROUPS.items()):
        chosen = np.flatnonzero(data["publication"].values == flag("publication", name))
        labels.append(f"{label} ({len(chosen)})")
        if band % 2:
            axes.axhspan(band - 0.5, band + 0.5, facecolor=PALE, linewidth=0, zorder=0)
        place = band + FILLED * ((np.arange(len(chosen)) + 0.5) / max(len(chosen), 1) - 0.5)
        for values, role in (
            (data["expected_difference"].values, EXPECTED),
            (data["limit_value"].values / theirs - 1, LIMIT),
            (data["our_value"].values / theirs - 1, OURS),
        ):
            size = np.abs(values[chosen])
            known = np.isfinite(size)
            if known.any():
                size = np.maximum(size[known], LEAST)
                axes.plot(size, place[known], linestyle="none", clip_on=False, **role)
    axes.set(
        xscale="log",
        xlim=(LEAST, 1),
        ylim=(len(GROUPS) - 0.5, -0.5),
        xlabel="Size of the relative difference from the published number or closed form",
    )
    axes.set_yticks(range(len(GROUPS)), labels)
    axes.tick_params(axis="y", length=0)
    legend(drawn, 3)
    return drawn
