"""Looks and helpers that the figures of a machine share: one look for each thing in all of them."""

import numpy as np

from impact_damper.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PALE_SKY,
    PURPLE,
    VERMILION,
)

BARE = {"color": BLACK, "linewidth": 1.2, "label": "without damper"}
DAMPED = {"color": BLUE, "linewidth": 1.2, "label": "with this damper"}
TUNED = {"color": GREEN, "linewidth": 1.2, "label": "tuned absorber", "linestyle": (0, (5, 2))}
NONLINEAR = {
    "color": PURPLE,
    "linewidth": 1.2,
    "label": "nonlinear absorber",
    "linestyle": (0, (5, 1.5, 1, 1.5)),
}
LIMIT = {
    "color": VERMILION,
    "linewidth": 0.9,
    "linestyle": (0, (1, 1.2)),
    "label": "limit of a quiet motion",
}
CHOSEN = {"color": VERMILION, "linewidth": 1.1, "label": "gap to build"}
TOLERATED = {"facecolor": PALE_SKY, "linewidth": 0, "zorder": 0, "label": "its tolerance"}
CLIFF = {"color": ORANGE, "linewidth": 1.1, "linestyle": (0, (4, 2)), "label": "cliff"}
STAR = {
    "color": BLACK,
    "marker": "*",
    "markersize": 7,
    "linestyle": "none",
    "zorder": 4,
}
ESCAPED = {
    "color": GREY,
    "marker": "^",
    "markersize": 5,
    "linestyle": "none",
    "label": "escapes",
    "clip_on": False,
}


def finite(values):
    """Return values with NaN in place of infinity, the size of a motion that escapes."""
    values = np.asarray(values, float)
    return np.where(np.isfinite(values), values, np.nan)


def plot_sizes(axes, x, sizes, **look):
    """Plot sizes of motions; one that escapes has no size and is marked at the upper edge."""
    sizes = np.asarray(sizes, float)
    axes.plot(x, finite(sizes), **look)
    escaped = np.isposinf(sizes)
    if escaped.any():
        across = axes.get_xaxis_transform()
        axes.plot(np.asarray(x)[escaped], np.ones(escaped.sum()), transform=across, **ESCAPED)


def limit_line(axes, data):
    """Draw the largest displacement of a quiet motion as a horizontal line."""
    axes.axhline(float(data["displacement_limit"]), **LIMIT)


def decades(axes):
    """Set a logarithmic scale of displacements whose labels are plain numbers."""
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter("{x:g}")
    low, high = axes.get_ylim()
    if high < 20 * low:  # a decade at most: name numbers between the powers of ten too
        axes.yaxis.set_minor_formatter(lambda x, _: f"{x:g}" if f"{x:.0e}"[0] in "25" else "")
    else:
        axes.yaxis.set_minor_formatter(lambda x, _: "")
