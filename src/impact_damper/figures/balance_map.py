"""Maps of where harmonic balance agrees with the exact motions (figure kind `balance_map`)."""

import numpy as np
from matplotlib.colors import ListedColormap

from impact_damper.data.datasets import flag, parameters_of
from impact_damper.figures.maps import hatch as hatch_cells
from impact_damper.figures.maps import span
from impact_damper.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PALE,
    PALE_SKY,
    PURPLE,
    SKY,
    VERMILION,
    WHITE,
    axis_label,
    figure,
    letter_panels,
    style,
)

CAPTION = """
(a) The quiet motion. Balance: the solution of (7) with the smallest amplitude, if below half that
of the free resonance, with its stability by the slow flow (17). Orbit: the exact periodic orbit
with two symmetric contacts, stable or unstable by its Floquet multipliers, continued from motions
that settled. Beyond the solid line the orbit does not exist: it ends there in a fold. Dots: a start
at the solution of (7) leads to chaos, small or violent, even if a stable orbit exists. (b) The high
motion. Balance: the stable solution of (7) with the largest amplitude, if above that half. After
the comma in the legend: the motion to which a start at this solution leads or, without such a
solution, a start on the free resonance branch. Chaotic: the largest Lyapunov exponent exceeds zero
by four standard errors after the configured number of periods; the motion may be a long transient.
Near: within 20 per cent of the amplitude of (7). Free resonance: the upper branch of the free
response. Harmonic balance assumes elastic contact, so its verdict does not depend on e. The paper
has no such figure.
"""

PARAMETERS = {
    "damping": "Damping, $h$",
    "mass_ratio": "Mass ratio, $r_m$",
    "clearance": "Clearance, $d_0$",
    "restitution": "Coefficient of restitution, $e$",
}
# Legend text, colour and hatching of each verdict.
QUIET = {
    "stable_stable": ("balance stable, orbit stable", PALE_SKY, ""),
    "stable_unstable": ("balance stable, orbit unstable", VERMILION, "////"),
    "stable_absent": ("balance stable, no orbit", ORANGE, ""),
    "unstable_stable": ("balance unstable, orbit stable", PURPLE, "...."),
    "unstable_unstable": ("balance unstable, orbit unstable", GREEN, "||||"),
    "unstable_absent": ("balance unstable, no orbit", GREY, ""),
    "none_stable": ("balance none, orbit stable", BLUE, ""),
    "none_unstable": ("balance none, orbit unstable", SKY, "----"),
    "none_absent": ("balance none, no orbit", WHITE, ""),
    "unresolved": ("unresolved", WHITE, "xxxxxx"),
}
HIGH = {
    "stable_near": ("balance stable, settled near it", BLUE, ""),
    "stable_far": ("balance stable, settled further off", GREEN, "----"),
    "stable_chaotic": ("balance stable, chaotic", ORANGE, ""),
    "stable_low": ("balance stable, becomes low", PALE_SKY, "...."),
    "stable_no_contact": ("balance stable, without contact", SKY, "||||"),
    "none_settled": ("balance none, settled", PURPLE, ""),
    "none_chaotic": ("balance none, chaotic", VERMILION, "////"),
    "none_low": ("balance none, becomes low", WHITE, ""),
    "none_no_contact": ("balance none, without contact", GREY, "||||"),
    "not_run": ("balance none, nor free resonance", PALE, ""),
    "unresolved": ("unresolved", WHITE, "xxxxxx"),
}


@style()
def draw_balance_map(*, balance_map):
    """Draw the verdicts on the quiet motion (a) and on the high motion (b).

    Parameters
    ----------
    balance_map : list of xarray.Dataset
        One dataset of the stage balance_map.

    Returns
    -------
    matplotlib.figure.Figure
    """
    (data,) = balance_map
    drawn = figure("double", 5.6)
    quiet, high = drawn.subplots(1, 2, sharex=True, sharey=True)
    _draw_classes(quiet, data, "quiet_verdict", QUIET)
    _draw_classes(high, data, "high_verdict", HIGH)
    _draw_edge(quiet, data["balance_quiet"])
    _draw_edge(high, data["balance_high"])
    _draw_ends(quiet, data)
    _draw_chaos(quiet, data)
    for axes in (quiet, high):
        axes.set_xlabel(axis_label(data["frequency_ratio"]))
    quiet.set(
        ylabel=PARAMETERS[parameters_of(data)["parameter"]],
        xlim=span(data["frequency_ratio"].values),
        ylim=span(data["map_value"].values),
    )
    letter_panels([quiet, high])
    for axes, words, side in (
        (quiet, "(a) quiet motion", "left"),
        (high, "(b) high motion", "right"),
    ):
        drawn.legend(*axes.get_legend_handles_labels(), title=words, loc=f"outside lower {side}")
    return drawn


def _draw_classes(axes, data, name, classes):
    """Draw the cells in the colours and hatchings of their verdicts."""
    grid = data["frequency_ratio"].values, data["map_value"].values
    values = data[name].values
    for meaning, (label, color, hatch) in classes.items():
        chosen = values == flag(name, meaning)
        if chosen.any():
            cells = np.ma.masked_where(~chosen, values)
            axes.pcolormesh(*grid, cells, cmap=ListedColormap([color]), rasterized=True)
            look = {"hatch": hatch, "edgecolor": GREY}
            if hatch:
                hatch_cells(axes, *grid, chosen, linewidth=0, **look)
            axes.fill([], [], facecolor=color, label=label, linewidth=0.4, **look)


def _draw_edge(axes, verdict):
    """Draw the boundary of the cells with a stable solution of harmonic balance."""
    stable = verdict == flag(verdict.name, "stable")
    if stable.any() and not stable.all():
        line = {"colors": [BLACK], "linewidths": 1.0, "linestyles": "dashed"}
        axes.contour(verdict["frequency_ratio"], verdict["map_value"], stable, [0.5], **line)
    axes.plot([], [], "--", color=BLACK, linewidth=1.0, label="edge of balance stable")


def _draw_ends(axes, data):
    """Draw the ends of the exact quiet orbits within the map, and their ends for rigid walls."""
    inside = data["quiet_end_event"] != flag("quiet_end_event", "map_ends")
    for end in data["quiet_end"].where(inside).values.T:
        axes.plot(end, data["map_value"], color=BLACK, linewidth=1.6)
    axes.plot([], [], color=BLACK, linewidth=1.6, label="end of the orbit")
    rigid = data["straight_flight_end"].values
    if np.isfinite(rigid).any():
        look = {"color": BLACK, "linestyle": (0, (1, 1.2)), "label": "its end for rigid walls"}
        axes.plot(rigid, data["map_value"], **look)


def _draw_chaos(axes, data):
    """Dot the cells in which a start at the quiet solution of the balance leads to chaos."""
    kinds = [flag("quiet_run_motion", name) for name in ("low_chaotic", "high_chaotic")]
    row, column = np.nonzero(np.isin(data["quiet_run_motion"], kinds))
    place = data["frequency_ratio"].values[column], data["map_value"].values[row]
    look = {"color": BLACK, "marker": ".", "markersize": 1.6, "linestyle": "none"}
    axes.plot(
        *place, markeredgewidth=0, label="chaos from a start at the balance's solution", **look
    )
