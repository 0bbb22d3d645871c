"""Figures of one machine and its damper, and an overview of several machines."""

import json
from string import ascii_lowercase

import numpy as np
from matplotlib.ticker import NullLocator

from impact_damper.data.datasets import decode, is_settled, parameters_of
from impact_damper.plot import style
from impact_damper.plot.branches import parts_by_stability

# A displacement of this size (mm) or more stands for a motion that escapes.
ENDLESS = 1e9
BARE = style.line("without damper", style.BLACK, linewidth=1.2)
TUNED = style.line("tuned absorber", style.GREEN, linewidth=1.1, linestyle=style.DASHED)
DETUNED = {"label": "its spring 10 % off", "color": style.GREEN, "alpha": 0.2, "linewidth": 0}
NOMINAL = style.line("values as given", style.BLUE, linewidth=0.9)
WORST = style.line("worst within tolerances", style.BLUE, linewidth=1.8)
PERIODIC = style.ROLES["period_1"] | {"label": "periodic motion", "markersize": 2.2}
OTHERS = style.ROLES["chaotic"] | {"label": "other motion", "markersize": 2.6}
LIMIT = style.line("limit given", style.VERMILION, linewidth=0.9, linestyle=style.DOTTED)
PROMISED = style.markers(
    "promise", style.VERMILION, "*", markersize=9, zorder=5, markerfacecolor=style.VERMILION
)
CHOSEN = style.line("gap of the damper", style.VERMILION, linewidth=0.9)
TOLERATED = style.shading("tolerance of the gap", style.PALE_SKY)
CLIFF = style.line("cliff", style.ORANGE, linewidth=1.1, linestyle=style.DASHED)
ORBIT = style.line("quiet orbit", style.SKY, linewidth=1.8)
LOST_ORBIT = style.line("quiet orbit, unstable", style.SKY, linewidth=1.0, linestyle=style.DOTTED)
SMALLEST = style.markers("smallest quiet orbit", style.BLACK, "*", markersize=7, zorder=4)
DOTS = {"marker": ".", "markersize": 3.0}
ESCAPED = style.markers("escapes", style.GREY, "^", markersize=5, clip_on=False)


@style.context()
def draw_answer(data):
    """Return the figure of displacements in a design, against frequency and against the gap."""
    drawn = style.figure("double", 2.9)
    left, right = drawn.subplots(1, 2)
    frequency_panel(left, data)
    gap_panel(right, data)
    style.legend(drawn, 4)
    return drawn


def frequency_panel(axes, data):
    """Draw promised displacements against the forcing frequency as lines, and motions as points."""
    frequency = data["promise_frequency"].values
    plot_sizes(axes, frequency, data["promise_bare_displacement"].values, **BARE)
    if "competitor_displacement" in data:
        tuned = data["competitor_displacement"].sel(competitor="tuned", detuning=0.0)
        plot_sizes(axes, data["frequency"].values, tuned.sel(force_share=1.0).values, **TUNED)
    nominal, worst = over_frequency(data)
    plot_sizes(axes, frequency, nominal, **NOMINAL)
    plot_sizes(axes, frequency, worst, **WORST)
    if "maximum_displacement" in data:
        size, settled = data["maximum_displacement"].values, is_settled(data)
        shown = np.isfinite(size) & (data["motion_starts"].values > 0)
        for chosen, look in ((shown & settled, PERIODIC), (shown & ~settled, OTHERS)):
            row, column = chosen.nonzero()
            plot_sizes(axes, data["frequency"].values[row], size[row, column], **look)
    place = float(data["promised_frequency"]), float(data["promised_displacement"])
    plot_sizes(axes, [place[0]], [place[1]], **PROMISED)
    limit_line(axes, data)
    axes.set(xlabel="Forcing frequency (Hz)", ylabel="Largest displacement (mm)")
    decades(axes)


def over_frequency(data) -> tuple:
    """Return two curves of the promised displacement over the frequency.

    The first curve is for nominal values, the second for the worst values within the tolerances.
    Missing values (NaN) are interpolated.
    """
    frequency, table = data["promise_frequency"].values, data["promise_displacement"].values
    rows = []
    for row in table:
        known = ~np.isnan(row)
        rows.append(np.interp(frequency, frequency[known], row[known]))
    return rows[0], np.max(rows, axis=0)


def gap_panel(axes, data):
    """Draw displacements against the gap: results of the search for a gap, and quiet orbits."""
    gap = float(data["design_gap"])
    tolerance = parameters_of(data)["tolerances"].get("gap", 0.0)
    axes.axvspan(gap * (1 - tolerance), gap * (1 + tolerance), **TOLERATED)
    axes.axvline(gap, **CHOSEN)
    kinds = decode(data["lost_kind"]).values
    for end, kind in zip(data["lost_gap"].values, kinds, strict=True):
        if kind == "jump":
            axes.axvline(end, **CLIFF)
    axes.axhline(float(data["largest_bare_displacement"]), **BARE)
    if np.isfinite(data["tuned_displacement"]):
        axes.axhline(float(data["tuned_displacement"]), **TUNED)
    searched = data["searched_gap"].values
    plot_sizes(axes, searched, data["searched_displacement"].values, **NOMINAL | DOTS)
    plot_sizes(axes, searched, data["searched_tolerated"].values, **WORST)
    if "gap_of_orbit" in data:
        names = ("gap_of_orbit", "displacement_by_gap", "modulus_by_gap")
        places, sizes, modulus = (data[name].values for name in names)
        for place, size, stable in parts_by_stability(places, sizes, modulus < 1):
            inside = (place >= searched[0]) & (place <= searched[-1])
            look = ORBIT if stable else LOST_ORBIT
            plot_sizes(axes, place[inside], size[inside], **look)
        best = data["best_orbit_gap"].values, data["best_orbit_displacement"].values
        plot_sizes(axes, *np.atleast_1d(*best), **SMALLEST)
    plot_sizes(axes, [gap], [float(data["promised_displacement"])], **PROMISED)
    limit_line(axes, data)
    axes.set(xscale="log", xlabel="Gap, full play (mm)", ylabel="Largest displacement (mm)")
    name_numbers(axes.xaxis, *axes.get_xlim())
    decades(axes)


@style.context()
def draw_forces(data):
    """Return the figure of displacements against excitation, or None if data are missing."""
    if not {"force_map_displacement", "competitor_displacement"} <= set(data):
        return None
    drawn = style.figure("double", 2.8)
    axes, force = drawn.subplots(), data["force_share"].values
    sizes = data["competitor_displacement"].max("frequency", skipna=False)
    plot_sizes(axes, force, sizes.sel(competitor="bare", detuning=0.0).values, **BARE)
    tuned = sizes.sel(competitor="tuned")
    if np.isfinite(tuned).any():
        least, most = finite(tuned.min("detuning")), finite(tuned.max("detuning"))
        axes.fill_between(force, least, most, **DETUNED)
        plot_sizes(axes, force, tuned.sel(detuning=0.0).values, **TUNED)
    ours = data["force_map_displacement"].max("operating_frequency").values
    plot_sizes(axes, force, ours, **NOMINAL | {"marker": "s", "markersize": 3.0})
    axes.axvline(1.0, **style.line("excitation given", style.VERMILION, linewidth=0.9))
    limit_line(axes, data)
    axes.set(xscale="log", xlabel="Excitation divided by the one given", xticks=force[::2])
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_ylabel("Largest displacement (mm)")
    decades(axes)
    style.legend(drawn, 3)
    return drawn


@style.context()
def draw_transients(data):
    """Return the figure of frequency sweeps and an unforced decay, or None if data are missing."""
    if "sweep_envelope" not in data:
        return None
    drawn = style.figure("double", 2.8)
    panels, band = drawn.subplots(1, 3), parameters_of(data)["band"]
    looks = {"bare": BARE, "damped": NOMINAL | {"label": "with damper"}}
    for axes, direction in zip(panels, ("up", "down"), strict=False):
        swept = data.sel(direction=direction)
        for equipment, look in looks.items():
            size = finite(swept["sweep_envelope"].sel(equipment=equipment))
            axes.plot(swept["sweep_frequency"], size, **look | {"linewidth": 0.8})
        lowest, highest = swept["sweep_frequency"].min(), swept["sweep_frequency"].max()
        for low, high in ((lowest, band[0]), (band[1], highest)):
            if low < high:
                axes.axvspan(low, high, facecolor=style.PALE, linewidth=0, zorder=0)
        axes.set(xlabel=f"Frequency, swept {direction} (Hz)")
        if direction == "down":
            axes.invert_xaxis()
    for equipment, look in looks.items():
        rung = data.sel(equipment=equipment)
        panels[2].plot(rung["ring_time"], rung["ring_envelope"], **look)
    panels[2].set(xlabel="Time without excitation (s)")
    panels[2].set_ylim(bottom=0.5 * float(data["ring_envelope"].sel(equipment="bare").min()))
    panels[0].set_ylabel("Displacement (mm)")
    for axes in panels:
        decades(axes)
    style.legend(drawn, 2)
    return drawn


@style.context({"axes.labelsize": 8.0, "lines.markersize": 2.6})
def draw_machines(*, machines):
    """Return a figure with a row for each machine: displacements over frequency and over gap."""
    drawn = style.figure("double", 1.0 + 1.75 * len(machines))
    panels = drawn.subplots(len(machines), 2, squeeze=False)
    for (left, right), data, letter in zip(panels, machines, ascii_lowercase, strict=False):
        frequency_panel(left, data)
        gap_panel(right, data)
        name = data.attrs["name"].replace("_", " ")
        mass = json.loads(data.attrs["machine"])["mass"]
        left.set_title(f"({letter}) {name}, {mass:g} kg", loc="left")
    for axes in panels[:-1].ravel():
        axes.set_xlabel("")
    style.legend(drawn, 4)
    return drawn


def finite(values):
    """Return the displacements `values`, with NaN for motions that escape."""
    values = np.asarray(values, float)
    return np.where(values < ENDLESS, values, np.nan)


def plot_sizes(axes, x, sizes, **look):
    """Plot displacements of motions. Motions that escape get a marker at the upper edge."""
    sizes = np.asarray(sizes, float)
    if np.isfinite(finite(sizes)).any():
        axes.plot(x, finite(sizes), **look)
    escaped = sizes >= ENDLESS
    if escaped.any():
        across = axes.get_xaxis_transform()
        axes.plot(np.asarray(x)[escaped], np.ones(escaped.sum()), transform=across, **ESCAPED)


def limit_line(axes, data):
    """Draw the displacement limit, if one was given, as a horizontal line."""
    if np.isfinite(data["displacement_limit"]):
        axes.axhline(float(data["displacement_limit"]), **LIMIT)


def decades(axes):
    """Make the axis of displacements logarithmic, with plain numbers as labels."""
    axes.set_yscale("log")
    name_numbers(axes.yaxis, *axes.get_ylim())


def name_numbers(axis, low, high):
    """Label a logarithmic axis from `low` to `high` with plain numbers."""
    ratio = high / low
    digits = "123456789" if ratio < 3 else "1235" if ratio < 15 else "125" if ratio < 300 else "1"
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(lambda x, _: f"{x:g}" if f"{x:.0e}"[0] in digits else "")


# Name of a figure on the page of a machine -> function that returns the figure or None.
FIGURES = {"answer": draw_answer, "forces": draw_forces, "transients": draw_transients}
