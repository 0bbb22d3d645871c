"""Figure of the error of max |Z1| that is made if walls are taken as rigid."""

import numpy as np
from matplotlib.colors import LogNorm

from impact_damper.data.datasets import parameters_of
from impact_damper.plot import style
from impact_damper.plot.maps import mesh

SMALLEST = 1e-4  # lower end of the colour scale
OWN = style.line("$r_1$ of the damper", style.BLACK, linewidth=0.6, linestyle=(0, (6, 3)))


def contours(axes, x, y, error, levels):
    """Draw the contour lines of an error at two levels, each with an entry in the legend."""
    for level, line in zip(levels, ("solid", "dotted"), strict=True):
        if np.nanmin(error) < level < np.nanmax(error):
            axes.contour(x, y, error, [level], colors=style.BLACK, linewidths=0.8, linestyles=line)
        axes.plot([], [], color=style.BLACK, linestyle=line, label=f"error of {100 * level:g} %")


@style.context()
def draw_rigid_limit(*, rigid_limit):
    """Draw the error of max |Z1| for rigid walls, as maps and as curves over the stiffness r1."""
    drawn = style.figure("double", 5.2)
    grid = drawn.add_gridspec(2, len(rigid_limit), height_ratios=(1, 1.2))
    maps = [drawn.add_subplot(grid[0, column]) for column in range(len(rigid_limit))]
    norm = LogNorm(SMALLEST, 1)
    for axes, data in zip(maps, rigid_limit, strict=True):
        cells = _draw_map(axes, data, norm)
        axes.tick_params(labelleft=axes is maps[0])
        axes.set_title(_title(data).replace(", $e", "\n$e"), fontsize=8)
        axes.set_xlabel(style.axis_label(data["frequency"]), fontsize=8)
    maps[0].set_ylabel(style.axis_label(data["stiffness"]))
    drawn.colorbar(cells, ax=maps, label="|error of max $|Z_1|$|", extend="min")
    axes = drawn.add_subplot(grid[1, :])
    _draw_orders(axes, rigid_limit)
    style.letter_panels([*maps, axes])
    style.legend(drawn, 3)
    return drawn


def _draw_map(axes, data, norm):
    x, y = data["frequency"].values, data["stiffness"].values
    error = np.abs(data["rigid_error"].values.T)
    cells = mesh(axes, x, y, np.maximum(error, SMALLEST), norm, "one or both motions not found")
    contours(axes, x, y, error, data["threshold"].values)
    axes.axhline(parameters_of(data)["contact_stiffness"], **OWN)
    axes.set_yscale("log")
    axes.set(xlim=x[[0, -1]], ylim=y[[0, -1]])
    return cells


def _draw_orders(axes, rigid_limit):
    for index, data in enumerate(rigid_limit):
        row = data.sel(frequency=parameters_of(data)["frequency"], method="nearest")
        x, look = data["stiffness"], style.curve(index)
        axes.plot(x, np.abs(row["rigid_error"]), **look, label=_title(data))
        axes.plot(x, np.abs(row["mended_error"]), **look)
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
        axes.plot(stiffness, guide, color=style.GREY, linewidth=0.6, linestyle=":")
        place, look = (stiffness[-1], guide[-1]), {"color": style.GREY, "ha": "left"}
        axes.annotate(rf"$r_1^{{-{order:g}}}$", place, va="center", **look)
    axes.axvline(parameters_of(data)["contact_stiffness"], **OWN)
    axes.set(
        xscale="log",
        yscale="log",
        xlabel=style.axis_label(data["stiffness"]),
        ylabel="|error of max $|Z_1|$|",
        xlim=(stiffness[0], stiffness[-1] * 2),
    )


def _title(data):
    return style.parameter_label(parameters_of(data), "mass_ratio", "clearance", "restitution")
