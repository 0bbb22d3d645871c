"""Errors of rigid impacts against contact stiffness and frequency (figure kind `rigid_limit`)."""

import numpy as np
from matplotlib.colors import LogNorm

from impact_damper.data.datasets import flag, parameters_of
from impact_damper.figures.maps import contours, key, mesh
from impact_damper.figures.style import (
    BLACK,
    GREY,
    PALE,
    VERMILION,
    WHITE,
    axis_label,
    curve,
    figure,
    legend,
    letter_panels,
    parameter_label,
    style,
)

CAPTION = """
The quiet motion (period 1, two symmetric contacts, stable or unstable), computed by Newton's method
with compliant contact in each cell, and with instantaneous impacts at each frequency W; continued
from the W stated above. Upper row: relative error of the largest displacement with instantaneous
impacts. Lower row: error of the modulus of the dominant Floquet multiplier, that is of the decay in
one period; small in wide areas, where the multipliers are complex pairs whose modulus hardly
depends on r1. Dots: both motions are unstable. Hatched: one of the motions was not reached from the
neighbouring cell, in steps down to 1/32 of their distance. Last panel: errors at the W stated
above. The corrected rigid model (mended) moves the walls outwards by v tc e/(1 + e), with the
approach speed v and the time in contact tc, and corrects the restitution to the same order. Its
error decreases as 1/r1, the error of the plain model as r1^(-1/2); both decrease as r1^(-1/2) where
the displacement is largest during a contact. The paper uses rigid walls for (13) and (14) only.
"""

SMALLEST = 1e-4  # lower end of the colour scale
THRESHOLDS = ("solid", "dotted")
OWN = {"color": BLACK, "linewidth": 0.6, "linestyle": (0, (6, 3))}


@style()
def draw_rigid_limit(*, rigid_limit):
    """Draw maps of the errors of max |Z1| and of the decay, and the order of the former in r1.

    Parameters
    ----------
    rigid_limit : list of xarray.Dataset
        Datasets of the stage rigid_limit.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 7.4)
    grid = drawn.add_gridspec(3, len(rigid_limit), height_ratios=(1, 1, 1.1))
    maps = np.empty((2, len(rigid_limit)), object)
    norm = LogNorm(SMALLEST, 1)
    for column, data in enumerate(rigid_limit):
        for row, name in enumerate(("rigid_error", "decay_error")):
            axes = maps[row, column] = drawn.add_subplot(grid[row, column])
            cells = draw_map(axes, data, data[name], norm)
            axes.tick_params(labelleft=column == 0, labelbottom=row == 1)
        maps[0, column].set_title(title(data).replace(", $e", "\n$e"), fontsize=8)
        maps[1, column].set_xlabel(axis_label(data["frequency"]), fontsize=8)
    for axes in maps[:, 0]:
        axes.set_ylabel(axis_label(data["stiffness"]))
    for row, words in enumerate(("|error of max $|Z_1|$|", "|error of decay|")):
        drawn.colorbar(cells, ax=maps[row], label=words, extend="min")
    for level, line in zip(data["threshold"].values, THRESHOLDS, strict=True):
        maps[0, 0].plot([], [], color=BLACK, linestyle=line, label=f"error of {100 * level:g} %")
    maps[0, 0].plot([], [], label="$r_1$ of the damper", **OWN)
    key(maps[0, 0], "one or both motions not reached", PALE, "////")
    key(maps[0, 0], "both unstable", WHITE, "....")
    key(maps[0, 0], "stability differs", VERMILION)
    axes = drawn.add_subplot(grid[2, :])
    draw_orders(axes, rigid_limit)
    letter_panels([*maps.ravel(), axes])
    legend(drawn, 3)
    return drawn


def draw_map(axes, data, values, norm):
    """Draw one map of an error, with frequency along x and stiffness along y."""
    x, y = data["frequency"].values, data["stiffness"].values
    error = np.abs(values.values.T)
    cells = mesh(axes, x, y, np.where(error < SMALLEST, SMALLEST, error), norm)
    verdict = data["rigid_verdict"].values.T
    unstable = verdict == flag("rigid_verdict", "both_unstable")
    if unstable.any():
        hatch = axes.contourf(x, y, unstable, [0.5, 1.5], colors="none", hatches=["...."])
        hatch.set(edgecolor=GREY, linewidth=0)
    if values.name == "rigid_error":
        for level, line in zip(data["threshold"].values, THRESHOLDS, strict=True):
            contours(axes, x, y, error, level, line)
    differs = np.argwhere(verdict == flag("rigid_verdict", "stability_differs"))
    axes.plot(x[differs[:, 1]], y[differs[:, 0]], "s", color=VERMILION, markersize=1.6)
    axes.axhline(parameters_of(data)["contact_stiffness"], **OWN)
    axes.set_yscale("log")
    axes.set(xlim=x[[0, -1]], ylim=y[[0, -1]])
    return cells


def draw_orders(axes, rigid_limit):
    """Draw errors of max |Z1| against stiffness at the design frequency, with guiding slopes."""
    for index, data in enumerate(rigid_limit):
        row = data.sel(frequency=parameters_of(data)["frequency"], method="nearest")
        x, line = data["stiffness"], curve(index)
        axes.plot(x, np.abs(row["rigid_error"]), **line, label=title(data))
        axes.plot(x, np.abs(row["mended_error"]), **line)
    for name, height in (("rigid_error", 1.6), ("mended_error", 0.3)):
        middle = row.isel(stiffness=row.sizes["stiffness"] // 4)
        place = float(middle["stiffness"]), height * float(np.abs(middle[name]))
        axes.annotate(name.split("_")[0], place, ha="center")
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
