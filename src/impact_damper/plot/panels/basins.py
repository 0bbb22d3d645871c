"""Basins of attraction in a plane of states (figure kind `basins`).

The basin of a motion is the set of initial states that lead to it. An attractor is a motion to
which states lead, and its share is the fraction of the plane that its basin covers.
"""

import numpy as np
from matplotlib.colors import BoundaryNorm, LinearSegmentedColormap, ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from impact_damper.data.datasets import has_damper, parameters_of
from impact_damper.data.variables import BASIN_LABEL
from impact_damper.plot.panels.style import (
    BLACK,
    GREY,
    ORANGE,
    PALE,
    PURPLE,
    SKY,
    VERMILION,
    WHITE,
    axis_label,
    figure,
    letter_panels,
    parameter_label,
    style,
)

CAPTION = """
Each state of the primary mass has the colour of the motion to which it leads (circles);
percentages are shares of the runs. Crosses: unstable orbits; black lines: their stable manifolds,
computed independently. With the damper the loose mass starts at rest at five places; the shade is
the share of places that lead to the smallest motion.
"""

# Colours of attractors in the order of rising max |Z1|; the largest attractor has the last colour.
COLOURS = (SKY, VERMILION, PURPLE, "#F7E7A6")
# Colours of states that lead to chaos, and of states that lead to no attractor or to several.
CHAOS, NONE = ORANGE, PALE
# A sum of shares that differs from 1 by less is 1.
ROUNDING = 1e-9
AREA = {"edgecolor": BLACK, "linewidth": 0.4}
POINTS = {"linestyle": "none", "marker": "o", "markeredgecolor": BLACK, "markersize": 4.5}
SADDLES = {"linestyle": "none", "marker": "x", "color": BLACK, "markersize": 5}


@style({"axes.titley": None})
def draw_basins(*, basins):
    """Draw the basins of each dataset, with its attractors and unstable orbits.

    Parameters
    ----------
    basins : list of xarray.Dataset
        Datasets of the stage basins.

    Returns
    -------
    matplotlib.figure.Figure
    """
    columns = min(len(basins), 2)
    rows = -(-len(basins) // columns)
    drawn = figure("double", 0.2 + (3.4 if columns == 2 else 4.6) * rows)
    panels = drawn.subplots(rows, columns, squeeze=False).ravel()
    for axes, data in zip(panels, basins, strict=False):
        draw_plane(axes, data)
    for axes in panels[len(basins) :]:
        axes.remove()
    letter_panels(panels[: len(basins)])
    return drawn


def colours_of(data):
    """Return the colour of each attractor of a dataset."""
    number = data.sizes["attractor"]
    return [
        COLOURS[-1] if k == number - 1 and number > 1 else COLOURS[k % 3] for k in range(number)
    ]


def draw_plane(axes, data):
    """Draw the plane of one dataset."""
    colours = colours_of(data)
    labels = data["basin_label"].values
    if "basin_share" in data:
        draw_shares(axes, data)
    else:
        palette = ListedColormap([GREY, GREY, WHITE, CHAOS, WHITE, NONE, *colours])
        # labels from -6 (quasi-periodic) to -1 (unresolved), then the attractors
        norm = BoundaryNorm(np.arange(-6.5, len(colours)), len(colours) + 6)
        fill(axes, data, labels, cmap=palette, norm=norm)
    named = list(zip(colours, attractor_words(data), strict=True))
    areas = named[:1] if "basin_share" in data else named
    handles = [Patch(facecolor=colour, **AREA, label=words) for colour, words in areas]
    handles += [
        Line2D([], [], **POINTS, markerfacecolor=colour, label=words)
        for colour, words in named[len(areas) :]
    ]
    rest = 1 - float(data["attractor_share"].sum())
    if "basin_share" in data and rest > ROUNDING:
        limit = parameters_of(data)["limit"]
        words = f"aperiodic in {limit} cycles: {share_words(rest)}"
        handles.append(Line2D([], [], linestyle="none", label=words))
    if "basin_share" not in data and np.any(labels == BASIN_LABEL["chaotic"]):
        handles.append(Patch(facecolor=CHAOS, **AREA, label="chaotic"))
    for index, colour in enumerate(colours):
        axes.plot(
            data["attractor_point"][index],
            data["attractor_speed"][index],
            **POINTS,
            markerfacecolor=colour,
        )
    if "boundary_displacement" in data:
        x, v = data["boundary_displacement"].values, data["boundary_velocity"].values
        axes.plot(x, v, color=BLACK, linewidth=0.25)
        saddles = data["saddle_displacement"], data["saddle_velocity"]
        handles += axes.plot(*saddles, **SADDLES, label="unstable orbit")
    turn = float(data["basin_phase"]) / np.pi
    axes.set_title(rf"{system_words(data)}, phase ${turn:.3g}\pi$", loc="right", fontsize=7.5)
    axes.set(
        xlabel=axis_label(data["basin_displacement"]),
        ylabel=axis_label(data["basin_velocity"]),
        xlim=data["basin_displacement"].values[[0, -1]],
        ylim=data["basin_velocity"].values[[0, -1]],
    )
    axes.legend(
        handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2, fontsize=7
    )


def fill(axes, data, values, **look):
    """Colour the states of a plane by values, and return the image."""
    plane = data["basin_displacement"], data["basin_velocity"]
    return axes.pcolormesh(*plane, values, rasterized=True, shading="nearest", **look)


def draw_shares(axes, data):
    """Colour states by the share of places of the loose mass that lead to the smallest motion."""
    shades = LinearSegmentedColormap.from_list("shares", [WHITE, SKY])
    drawn = fill(axes, data, data["basin_share"][0], cmap=shades, vmin=0, vmax=1)
    words = "share of places of the loose mass"
    axes.figure.colorbar(drawn, ax=axes, label=words, shrink=0.9, ticks=[0, 0.5, 1])


def system_words(data):
    """Return frequency, mass ratio and clearance as text; for a machine only the frequency."""
    frequency = data["frequency"]
    if frequency.attrs["units"] != "1":
        return f"{float(frequency):.4g} {frequency.attrs['units']}"
    names = ("mass_ratio", "clearance") if has_damper(data) else ()
    return parameter_label(parameters_of(data), "frequency", *names)


def attractor_words(data):
    """Return period, size and share of each attractor as text."""
    units = f" {data['attractor_displacement'].attrs['units']}".removesuffix(" 1")
    return [
        f"period {period:d}, max |$Z_1$| {size:.3g}{units}: {share_words(share)}"
        for period, size, share in zip(
            data["attractor_period"].values,
            data["attractor_displacement"].values,
            data["attractor_share"].values,
            strict=True,
        )
    ]


def share_words(share):
    """Return a share in per cent; "< 1 %" for a positive share that rounds to 0."""
    return "< 1 %" if 0 < share < 0.005 else f"{100 * share:.0f} %"
