"""Maps that compare harmonic balance with the exact motions (figure kind `balance_map`).

A cell is a pair of forcing frequency and another parameter. In each cell a verdict, stored as a
flag (an integer for each meaning), says whether harmonic balance is right about the quiet motion,
which is small, and about the violent motion, which is at least half as large as the resonance
without damper. The numbers in the caption are equations of the paper: (7) harmonic balance, (17)
its slow flow.
"""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D

from impact_damper.data.datasets import flag, parameters_of
from impact_damper.plot.panels.maps import hatch as hatch_cells
from impact_damper.plot.panels.maps import span
from impact_damper.plot.panels.style import (
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
(a) Smallest solution of harmonic balance (7): stability by the slow flow (17) against stability of
the exact quiet orbit. Dots: a run from this solution becomes chaotic. (b) Largest stable solution
of harmonic balance against the motion to which a run from it leads. Near: within 20 % in amplitude.
"""

PARAMETERS = {
    "damping": "Damping, $h$",
    "mass_ratio": "Mass ratio, $r_m$",
    "clearance": "Clearance, $d_0$",
    "restitution": "Coefficient of restitution, $e$",
}
# Legend text, colour and hatching of each verdict.
QUIET = {
    "stable_stable": ("rightly called stable", PALE_SKY, ""),
    "stable_unstable": ("called stable, orbit is unstable", VERMILION, "////"),
    "stable_absent": ("called stable, no such orbit", ORANGE, ""),
    "unstable_stable": ("called unstable, orbit is stable", PURPLE, "...."),
    "unstable_unstable": ("rightly called unstable", GREEN, "||||"),
    "unstable_absent": ("called unstable, no such orbit", GREY, ""),
    "none_stable": ("not found, orbit is stable", BLUE, ""),
    "none_unstable": ("not found, orbit is unstable", SKY, "----"),
    "none_absent": ("rightly not found", WHITE, ""),
    "unresolved": ("unresolved", WHITE, "xxxxxx"),
}
VIOLENT = {
    "stable_near": ("predicted, and found near it", BLUE, ""),
    "stable_far": ("predicted, found farther away", GREEN, "----"),
    "stable_chaotic": ("predicted, but chaotic", ORANGE, ""),
    "stable_low": ("predicted, but becomes small", PALE_SKY, "...."),
    "stable_no_contact": ("predicted, but without contact", SKY, "||||"),
    "none_settled": ("not predicted, but settles", PURPLE, ""),
    "none_chaotic": ("not predicted, but chaotic", VERMILION, "////"),
    "none_low": ("not predicted; becomes small", WHITE, ""),
    "none_no_contact": ("not predicted; moves without contact", GREY, "||||"),
    "not_run": ("not predicted, no free resonance either", PALE, ""),
    "unresolved": ("unresolved", WHITE, "xxxxxx"),
}


@style()
def draw_balance_map(*, balance_map):
    """Draw the verdicts on the quiet motion (a) and on the violent motion (b).

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
    quiet, violent = drawn.subplots(1, 2, sharex=True, sharey=True)
    _draw_classes(quiet, data, "quiet_verdict", QUIET)
    _draw_classes(violent, data, "high_verdict", VIOLENT)
    _draw_edge(quiet, data["balance_quiet"])
    _draw_edge(violent, data["balance_high"])
    _draw_ends(quiet, data)
    _draw_chaos(quiet, data)
    for axes in (quiet, violent):
        axes.set_xlabel(axis_label(data["frequency_ratio"]))
    quiet.set(
        ylabel=PARAMETERS[parameters_of(data)["parameter"]],
        xlim=span(data["frequency_ratio"].values),
        ylim=span(data["map_value"].values),
    )
    letter_panels([quiet, violent])
    entries = [axes.get_legend_handles_labels() for axes in (quiet, violent)]
    longest = max(len(labels) for _, labels in entries)
    for (handles, labels), words, side in zip(
        entries,
        ("(a) quiet motion by harmonic balance:", "(b) violent motion by harmonic balance:"),
        ("left", "right"),
        strict=True,
    ):
        # Blank entries, so that both legends begin at the same height.
        blank = [Line2D([], [], linestyle="none")] * (longest - len(labels))
        place = f"outside lower {side}"
        drawn.legend(handles + blank, labels + [""] * len(blank), title=words, loc=place)
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
    axes.plot(
        [], [], "--", color=BLACK, linewidth=1.0, label="edge of stability by harmonic balance"
    )


def _draw_ends(axes, data):
    """Draw where exact quiet orbits end, for walls of finite stiffness and for rigid walls."""
    inside = data["quiet_end_event"] != flag("quiet_end_event", "map_ends")
    for end in data["quiet_end"].where(inside).values.T:
        axes.plot(end, data["map_value"], color=BLACK, linewidth=1.6)
    axes.plot([], [], color=BLACK, linewidth=1.6, label="end of the exact orbit")
    rigid = data["straight_flight_end"].values
    if np.isfinite(rigid).any():
        look = {"color": BLACK, "linestyle": (0, (1, 1.2)), "label": "end for rigid walls"}
        axes.plot(rigid, data["map_value"], **look)


def _draw_chaos(axes, data):
    """Dot the cells in which a run from the quiet solution of harmonic balance becomes chaotic."""
    kinds = [flag("quiet_run_motion", name) for name in ("low_chaotic", "high_chaotic")]
    row, column = np.nonzero(np.isin(data["quiet_run_motion"], kinds))
    place = data["frequency_ratio"].values[column], data["map_value"].values[row]
    look = {"color": BLACK, "marker": ".", "markersize": 1.6, "linestyle": "none"}
    axes.plot(*place, markeredgewidth=0, label="a run from the solution becomes chaotic", **look)
