"""Looks of curves and helpers common to the figures of a machine."""

import numpy as np

from impact_damper.plot.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PALE_SKY,
    VERMILION,
)

BARE = {"color": BLACK, "linewidth": 1.2, "label": "without damper"}
DAMPED = {"color": BLUE, "linewidth": 1.2, "label": "with this damper"}
TUNED = {"color": GREEN, "linewidth": 1.2, "label": "tuned absorber", "linestyle": (0, (5, 2))}
LIMIT = {
    "color": VERMILION,
    "linewidth": 0.9,
    "linestyle": (0, (1, 1.2)),
    "label": "quiet limit",
}
CHOSEN = {"color": VERMILION, "linewidth": 1.1, "label": "gap to build"}
TOLERATED = {"facecolor": PALE_SKY, "linewidth": 0, "zorder": 0, "label": "tolerance of the gap"}
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
    """Plot sizes of motions; mark a motion that escapes, which has no size, at the upper edge."""
    sizes = np.asarray(sizes, float)
    plot_if_any(axes, x, finite(sizes), **look)
    escaped = np.isposinf(sizes)
    if escaped.any():
        across = axes.get_xaxis_transform()
        axes.plot(np.asarray(x)[escaped], np.ones(escaped.sum()), transform=across, **ESCAPED)


def limit_line(axes, data):
    """Draw the quiet limit, the largest displacement of a quiet motion, as a horizontal line."""
    axes.axhline(float(data["displacement_limit"]), **LIMIT)


def decades(axes):
    """Make the axis of displacements logarithmic, with plain numbers as labels."""
    axes.set_yscale("log")
    name_numbers(axes.yaxis, *axes.get_ylim())


def name_numbers(axis, low, high):
    """Label a logarithmic axis from `low` to `high` with plain numbers."""
    ratio = high / low
    digits = "123456789" if ratio < 3 else "1235" if ratio < 15 else "125" if ratio < 100 else "1"
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(lambda x, _: f"{x:g}" if f"{x:.0e}"[0] in digits else "")


def plot_if_any(axes, x, y, **look):
    """Plot points, with an entry in the legend only if there are any."""
    if np.isfinite(np.asarray(y, float)).any():
        axes.plot(x, y, **look)
