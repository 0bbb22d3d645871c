"""Figures of the errors of harmonic balance: curves over the highest harmonic, and maps."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D

from impact_damper.data.datasets import decode, has_damper, parameters_of
from impact_damper.plot import style
from impact_damper.plot.maps import edges_of
from impact_damper.plot.maps import hatch as hatch_cells

PANELS = {
    "maximum": r"Error of $\max\,|Z_1|$",
    "retained": "Error of $Z_1$ in harmonics up to $N$",
    "multiplier": "Error of a Floquet multiplier (Hill)",
}
ROUNDING = 1e-12  # smallest error by which `_guide` places its line; smaller errors are rounding
FLOOR = 1e-16  # smallest error drawn
GUIDE = {"color": style.GREY, "linewidth": 0.7, "linestyle": (0, (2, 1.5)), "zorder": 1}
# How Newton's method ends if it starts from the one-harmonic solution -> text, marker.
COLD = {
    "same_motion": ("(d): finds the same motion", {"marker": "o", "markerfacecolor": "none"}),
    "another_motion": ("(d): finds another motion", {"marker": "s", "markersize": 4.4}),
    "stalled": ("(d): Newton's method stalls", {"marker": "x"}),
    "iteration_limit": ("(d): reaches the limit of steps", {"marker": "+", "markersize": 5}),
}
PARAMETERS = {
    "damping": "Damping, $h$",
    "mass_ratio": "Mass ratio, $r_m$",
    "clearance": "Clearance, $d_0$",
    "restitution": "Coefficient of restitution, $e$",
}
# Verdict (what harmonic balance finds, what exists) -> text in the legend, colour, hatching.
QUIET = {
    "stable_stable": ("rightly called stable", style.PALE_SKY, ""),
    "stable_unstable": ("called stable, orbit is unstable", style.VERMILION, "////"),
    "stable_absent": ("called stable, no such orbit", style.ORANGE, ""),
    "unstable_stable": ("called unstable, orbit is stable", style.PURPLE, "...."),
    "unstable_unstable": ("rightly called unstable", style.GREEN, "||||"),
    "unstable_absent": ("called unstable, no such orbit", style.GREY, ""),
    "none_stable": ("not found, orbit is stable", style.BLUE, ""),
    "none_unstable": ("not found, orbit is unstable", style.SKY, "----"),
    "none_absent": ("rightly not found", style.WHITE, ""),
    "unresolved": ("unresolved", style.WHITE, "xxxxxx"),
}
VIOLENT = {
    "stable_near": ("predicted, and found near it", style.BLUE, ""),
    "stable_far": ("predicted, found farther away", style.GREEN, "----"),
    "stable_chaotic": ("predicted, but chaotic", style.ORANGE, ""),
    "stable_low": ("predicted, but becomes small", style.PALE_SKY, "...."),
    "stable_no_contact": ("predicted, but without contact", style.SKY, "||||"),
    "none_settled": ("not predicted, but settles", style.PURPLE, ""),
    "none_chaotic": ("not predicted, but chaotic", style.VERMILION, "////"),
    "none_low": ("not predicted; becomes small", style.WHITE, ""),
    "none_no_contact": ("not predicted; moves without contact", style.GREY, "||||"),
    "not_run": ("not predicted, no free resonance either", style.PALE, ""),
    "unresolved": ("unresolved", style.WHITE, "xxxxxx"),
}


@style.context()
def draw_harmonic_convergence(*, harmonic_convergence):
    """Draw three errors of harmonic balance. Panel (d) shows which motion Newton's method finds."""
    drawn = style.figure("double", 6.4)
    panels = drawn.subplots(2, 2, sharex=True)
    style.letter_panels(panels.flat)
    for axes, (measure, words) in zip(panels.flat, PANELS.items(), strict=False):
        _draw_errors(axes, harmonic_convergence, measure)
        axes.set(xscale="log", yscale="log", ylabel=words, ylim=(FLOOR / 2, 10))
    _draw_cold(panels[1, 1], harmonic_convergence)
    for axes in panels[1]:
        axes.set_xlabel(style.axis_label(harmonic_convergence[0]["highest_harmonic"]))
    style.legend(drawn, 3)
    return drawn


def _draw_errors(axes, harmonics, measure):
    status = "hill_status" if measure == "multiplier" else "series_status"
    for index, data in enumerate(harmonics):
        at = data.sel(error_measure=measure)
        highest, error = data["highest_harmonic"].values, at["series_error"].values
        line = style.points(index) | style.curve(index) | {"linewidth": 0.8}
        axes.plot(highest, np.maximum(error, FLOOR), **line, label=_title(data))
        lost = highest[data[status].values != 0]
        if len(lost):
            place = {"transform": axes.get_xaxis_transform(), "label": "failed"}
            axes.plot(lost, np.full(len(lost), 0.97), **style.ROLES["unresolved"] | place)
    for data in harmonics:
        axes.plot(*_guide(data, data.sel(error_measure=measure)), **GUIDE, label="predicted decay")


def _guide(data, at):
    highest, error = data["highest_harmonic"].values, at["series_error"].values
    used = (highest >= data["asymptotic_harmonic"].item()) & (error > ROUNDING)
    if not used.any():
        return [], []
    highest, error = highest[used], np.log(error[used])
    exponential = decode(data["decay_kind"]) == "exponential"
    decay = -at["decay_predicted"].item() * (highest if exponential else np.log(highest))
    # The predicted decay is fitted to the computed errors, and drawn a factor 3 above them.
    return highest, 3 * np.exp(decay + np.mean(error - decay))


def _draw_cold(axes, harmonics):
    for index, data in enumerate(harmonics):
        highest, status = data["highest_harmonic"].values, decode(data["cold_status"]).values
        for meaning, (words, look) in COLD.items():
            chosen = highest[status == meaning]
            look = look | {"color": style.curve(index)["color"], "linestyle": "none"}
            if len(chosen):
                axes.plot(chosen, np.full(len(chosen), -index), **look, label=words)
    axes.set_yticks(-np.arange(len(harmonics)), [_title(data, short=True) for data in harmonics])
    axes.set_ylim(0.5 - len(harmonics), 0.5)
    axes.tick_params(axis="y", length=0)


def _title(data, short=False):
    parameters = parameters_of(data)
    if not has_damper(data):
        return "free" if short else f"free, {style.parameter_label(parameters, 'frequency')}"
    separator = "\n" if short else ", "
    damper = style.parameter_label(parameters, "mass_ratio", "restitution")
    return damper + separator + style.parameter_label(parameters, "contact_stiffness")


@style.context()
def draw_balance_map(*, balance_map):
    """Draw maps that show where harmonic balance is right about quiet and violent motions."""
    (data,) = balance_map
    drawn = style.figure("double", 5.6)
    quiet, violent = drawn.subplots(1, 2, sharex=True, sharey=True)
    for axes, name, classes in ((quiet, "quiet", QUIET), (violent, "high", VIOLENT)):
        _draw_classes(axes, data, f"{name}_verdict", classes)
        _draw_edge(axes, data[f"balance_{name}"])
        axes.set_xlabel(style.axis_label(data["frequency_ratio"]))
    _draw_ends(quiet, data)
    _draw_chaos(quiet, data)
    quiet.set(
        ylabel=PARAMETERS[parameters_of(data)["parameter"]],
        xlim=edges_of(data["frequency_ratio"].values)[[0, -1]],
        ylim=edges_of(data["map_value"].values)[[0, -1]],
    )
    style.letter_panels([quiet, violent])
    entries = [axes.get_legend_handles_labels() for axes in (quiet, violent)]
    longest = max(len(labels) for _, labels in entries)
    for (handles, labels), words, side in zip(
        entries,
        ("(a) quiet motion by harmonic balance:", "(b) violent motion by harmonic balance:"),
        ("left", "right"),
        strict=True,
    ):
        # Blank entries give both legends the same height.
        blank = [Line2D([], [], linestyle="none")] * (longest - len(labels))
        place = f"outside lower {side}"
        drawn.legend(handles + blank, labels + [""] * len(blank), title=words, loc=place)
    return drawn


def _draw_classes(axes, data, name, classes):
    grid = data["frequency_ratio"].values, data["map_value"].values
    values = decode(data[name]).values
    for meaning, (label, color, hatch) in classes.items():
        chosen = values == meaning
        if chosen.any():
            cells = np.ma.masked_where(~chosen, np.ones(chosen.shape))
            axes.pcolormesh(*grid, cells, cmap=ListedColormap([color]), rasterized=True)
            look = {"hatch": hatch, "edgecolor": style.GREY}
            if hatch:
                hatch_cells(axes, *grid, chosen, linewidth=0, **look)
            axes.fill([], [], facecolor=color, label=label, linewidth=0.4, **look)


def _draw_edge(axes, verdict):
    stable = decode(verdict) == "stable"
    if stable.any() and not stable.all():
        line = {"colors": [style.BLACK], "linewidths": 1.0, "linestyles": "dashed"}
        axes.contour(verdict["frequency_ratio"], verdict["map_value"], stable, [0.5], **line)
    words = "edge of stability by harmonic balance"
    axes.plot([], [], "--", color=style.BLACK, linewidth=1.0, label=words)


def _draw_ends(axes, data):
    inside = decode(data["quiet_end_event"]) != "map_ends"
    for end in data["quiet_end"].where(inside).values.T:
        axes.plot(end, data["map_value"], color=style.BLACK, linewidth=1.6)
    axes.plot([], [], color=style.BLACK, linewidth=1.6, label="end of the exact orbit")
    rigid = data["straight_flight_end"].values
    if np.isfinite(rigid).any():
        look = {"color": style.BLACK, "linestyle": (0, (1, 1.2)), "label": "end for rigid walls"}
        axes.plot(rigid, data["map_value"], **look)


def _draw_chaos(axes, data):
    chaotic = np.isin(decode(data["quiet_run_motion"]), ["low_chaotic", "high_chaotic"])
    row, column = np.nonzero(chaotic)
    place = data["frequency_ratio"].values[column], data["map_value"].values[row]
    look = {"color": style.BLACK, "marker": ".", "markersize": 1.6, "linestyle": "none"}
    axes.plot(*place, markeredgewidth=0, label="a run from the solution becomes chaotic", **look)
