"""Errors of rigid impacts against contact stiffness and frequency (figure kind `rigid_limit`)."""

import numpy as np
from matplotlib.colors import LogNorm

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.maps import contours, key, mesh
from impact_damper.plot.style import (
    BLACK,
    GREY,
    PALE,
    axis_label,
    curve,
    figure,
    legend,
    letter_panels,
    parameter_label,
    style,
)

SMALLEST = 1e-4  # lower end of the colour scale
THRESHOLDS = ("solid", "dotted")  # lines of the contours at the thresholds of the dataset
# Line at the stiffness r1 of the damper.
OWN = {"color": BLACK, "linewidth": 0.6, "linestyle": (0, (6, 3))}


@style()
def draw_rigid_limit(*, rigid_limit):
    """Draw maps of the error of max |Z1|, and the power of r1 with which the error falls."""
    drawn = figure("double", 5.2)
    grid = drawn.add_gridspec(2, len(rigid_limit), height_ratios=(1, 1.2))
    maps = [drawn.add_subplot(grid[0, column]) for column in range(len(rigid_limit))]
    norm = LogNorm(SMALLEST, 1)
    for axes, data in zip(maps, rigid_limit, strict=True):
        cells = draw_map(axes, data, norm)
        axes.tick_params(labelleft=axes is maps[0])
        axes.set_title(title(data).replace(", $e", "\n$e"), fontsize=8)
        axes.set_xlabel(axis_label(data["frequency"]), fontsize=8)
    first = maps[0]
    first.set_ylabel(axis_label(data["stiffness"]))
    drawn.colorbar(cells, ax=maps, label="|error of max $|Z_1|$|", extend="min")
    for level, line in zip(data["threshold"].values, THRESHOLDS, strict=True):
        first.plot([], [], color=BLACK, linestyle=line, label=f"error of {100 * level:g} %")
    first.plot([], [], label="$r_1$ of the damper", **OWN)
    key(first, "one or both motions not found", PALE, "////")
    axes = drawn.add_subplot(grid[1, :])
    draw_orders(axes, rigid_limit)
    letter_panels([*maps, axes])
    legend(drawn, 3)
    return drawn


def draw_map(axes, data, norm):
    """Draw one map of an error, with frequency along x and stiffness along y."""
    x, y = data["frequency"].values, data["stiffness"].values
    error = np.abs(data["rigid_error"].values.T)
    cells = mesh(axes, x, y, np.where(error < SMALLEST, SMALLEST, error), norm)
    for level, line in zip(data["threshold"].values, THRESHOLDS, strict=True):
        contours(axes, x, y, error, level, line)
    axes.axhline(parameters_of(data)["contact_stiffness"], **OWN)
    axes.set_yscale("log")
    axes.set(xlim=x[[0, -1]], ylim=y[[0, -1]])
    return cells


def draw_orders(axes, rigid_limit):
    """Draw errors of max |Z1| against stiffness at the design frequency, with lines of powers."""
    for index, data in enumerate(rigid_limit):
        row = data.sel(frequency=parameters_of(data)["frequency"], method="nearest")
        x, line = data["stiffness"], curve(index)
        axes.plot(x, np.abs(row["rigid_error"]), **line, label=title(data))
        axes.plot(x, np.abs(row["mended_error"]), **line)
    for name, height, words in (
        ("rigid_error", 2.6, "rigid walls"),
        ("mended_error", 0.1, "rigid walls, corrected"),
    ):
        middle = row.isel(stiffness=row.sizes["stiffness"] // 4)
        place = float(middle["stiffness"]), height * float(np.abs(middle[name]))
        axes.annotate(words, place, ha="center")
    stiffness = data["stiffness"].values
    for level, order in ((0.6, 0.5), (0.06, 1)):
        guide = level * (stiffness / stiffness[0]) ** -order
        axes.plot(stiffness, guide, color=GREY, linewidth=0.6, linestyle=":")
        axes.annotate(
            rf"$r_1^{{-{order:g}}}$", (stiffness[-1], guide[-1]), color=GREY, ha="left", va="center"
        )
    axes.axvline(parameters_of(data)["contact_stiffness"], **OWN)
    axes.set(
        xscale="log",
        yscale="log",
        xlabel=axis_label(data["stiffness"]),
        ylabel="|error of max $|Z_1|$|",
        xlim=(stiffness[0], stiffness[-1] * 2),
    )


def title(data):
    """Return the parameters of a damper as text."""
    return parameter_label(parameters_of(data), "mass_ratio", "clearance", "restitution")
