"""Basins of attraction in a plane of states."""

import numpy as np
from matplotlib.colors import LinearSegmentedColormap, ListedColormap

from impact_damper.data.datasets import has_damper, parameters_of
from impact_damper.data.variables import BASIN_LABEL
from impact_damper.plot import style
from impact_damper.plot.sheets import dataset_in, sheet

# Colours of attractors in the order of displacement. The attractor with the largest displacement
# has the last colour, unless it is the only attractor.
COLOURS = (style.SKY, style.VERMILION, style.PURPLE, "#F7E7A6")
CHAOS = style.ORANGE
# Colours of states that lead to no attractor, for the labels -6 to -1 (`BASIN_LABEL`).
WITHOUT_ATTRACTOR = (style.GREY, style.GREY, style.WHITE, CHAOS, style.WHITE, style.PALE)
AREA = {"edgecolor": style.BLACK, "linewidth": 0.4}
POINTS = {"linestyle": "none", "marker": "o", "markeredgecolor": style.BLACK, "markersize": 4.5}
SADDLES = style.markers("unstable orbit", style.BLACK, "x", markersize=5)


def basins(data, axes=None):
    """Draw basins of attraction: the motion to which each state of a plane leads.

    With a damper the motion also depends on the place of the loose mass. If several places were
    computed, the shade of a state is the share of places that lead to the smallest motion.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `basins`.
    axes : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import impact_damper as idm
    >>> axes = idm.plot.basins(idm.basins(idm.Oscillator(0.215), None, 1.85, cells=40))
    """
    found = dataset_in(data, lambda each: "basin_label" in each, "basins")
    with sheet(axes, height=5.0, columns=0) as (axes,):
        number = found.sizes["attractor"]
        colours = [COLOURS[k % 3] for k in range(number)]
        if number > 1:
            colours[-1] = COLOURS[-1]
        (_draw_shares if "basin_share" in found else _draw_labels)(axes, found, colours)
        attractors = found["attractor_point"].values, found["attractor_speed"].values
        for x, v, colour in zip(*attractors, colours, strict=True):
            axes.plot(x, v, **POINTS, markerfacecolor=colour)
        if "boundary_displacement" in found:
            manifold = found["boundary_displacement"], found["boundary_velocity"]
            axes.plot(*manifold, color=style.BLACK, linewidth=0.25)
            axes.plot(found["saddle_displacement"], found["saddle_velocity"], **SADDLES)
        _name(axes, found)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2, fontsize=7)
    return axes


def _draw_labels(axes, data, colours):
    labels = data["basin_label"].values
    palette = ListedColormap([*WITHOUT_ATTRACTOR, *colours])
    low, high = -len(WITHOUT_ATTRACTOR) - 0.5, len(colours) - 0.5
    _fill(axes, data, labels, cmap=palette, vmin=low, vmax=high)
    for colour, words in zip(colours, _attractor_words(data), strict=True):
        axes.fill([], [], facecolor=colour, label=words, **AREA)
    if np.any(labels == BASIN_LABEL["chaotic"]):
        axes.fill([], [], facecolor=CHAOS, label="chaotic", **AREA)


def _draw_shares(axes, data, colours):
    shades = LinearSegmentedColormap.from_list("shares", [style.WHITE, style.SKY])
    drawn = _fill(axes, data, data["basin_share"][0], cmap=shades, vmin=0, vmax=1)
    words = "share of places of the loose mass"
    axes.figure.colorbar(drawn, ax=axes, label=words, shrink=0.9, ticks=[0, 0.5, 1])
    first, *others = zip(colours, _attractor_words(data), strict=True)
    axes.fill([], [], facecolor=first[0], label=first[1], **AREA)
    for colour, words in others:
        axes.plot([], [], **POINTS, markerfacecolor=colour, label=words)
    rest = 1 - float(data["attractor_share"].sum())
    if rest > 1e-9:  # rounding errors are smaller
        words = f"aperiodic in {parameters_of(data)['limit']} cycles: {_percent(rest)}"
        axes.plot([], [], linestyle="none", label=words)


def _fill(axes, data, values, **look):
    plane = data["basin_displacement"], data["basin_velocity"]
    return axes.pcolormesh(*plane, values, rasterized=True, shading="nearest", **look)


def _name(axes, data):
    frequency = data["frequency"]
    if frequency.attrs["units"] == "1":
        names = ("mass_ratio", "clearance") if has_damper(data) else ()
        words = style.parameter_label(parameters_of(data), "frequency", *names)
    else:
        words = f"{float(frequency):.4g} {frequency.attrs['units']}"
    turn = float(data["basin_phase"]) / np.pi
    axes.set_title(rf"{words}, phase ${turn:.3g}\pi$", loc="right", fontsize=7.5)
    x, v = data["basin_displacement"], data["basin_velocity"]
    axes.set(xlabel=style.axis_label(x), ylabel=style.axis_label(v))
    axes.set(xlim=x.values[[0, -1]], ylim=v.values[[0, -1]])


def _attractor_words(data):
    units = f" {data['attractor_displacement'].attrs['units']}".removesuffix(" 1")
    names = ("attractor_period", "attractor_displacement", "attractor_share")
    return [
        f"period {period:d}, max |$Z_1$| {size:.3g}{units}: {_percent(share)}"
        for period, size, share in zip(*(data[name].values for name in names), strict=True)
    ]


def _percent(share):
    return "< 1 %" if 0 < share < 0.005 else f"{100 * share:.0f} %"
