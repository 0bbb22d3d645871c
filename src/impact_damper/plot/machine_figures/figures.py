"""Figures of one machine and the damper designed for it, and an overview of several machines.

The page of a machine shows FIGURES; their captions stand in its template.
"""

import json
from string import ascii_lowercase

import numpy as np
from matplotlib.colors import LogNorm, Normalize
from matplotlib.patheffects import withStroke
from matplotlib.ticker import NullLocator

from impact_damper.data.datasets import flag, is_settled, parameters_of
from impact_damper.plot.branches import runs, runs_of
from impact_damper.plot.machine_figures.drawing import draw_drawing
from impact_damper.plot.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PALE,
    PALE_SKY,
    ROLES,
    VERMILION,
    WHITE,
    figure,
    legend,
    style,
)

DOTTED, FINE_DOTS = {"linestyle": (0, (1, 1.2))}, {"linestyle": (0, (1, 1.5))}
POINTS = {"linestyle": "none", "markerfacecolor": "none"}
BARE = {"color": BLACK, "linewidth": 1.2, "label": "without damper"}
BARE_STABLE = BARE | {"label": "without damper, stable"}
BARE_UNSTABLE = BARE | {
    "color": GREY,
    "linestyle": (0, (4, 2)),
    "label": "without damper, unstable",
}
DAMPED = {"color": BLUE, "linewidth": 1.2, "label": "with this damper"}
STABLE = DAMPED | {"linewidth": 1.0, "label": "with damper, stable orbit"}
UNSTABLE = STABLE | FINE_DOTS | {"label": "with damper, unstable orbit"}
SETTLED = ROLES["period_1"] | {"label": "with damper, periodic", "markersize": 2.6}
OTHERS = ROLES["chaotic"] | {"label": "with damper, not periodic", "markersize": 3.0}
REACHED = POINTS | {"color": BLUE, "marker": "s", "markersize": 3.2, "label": "largest reached"}
HIGH = POINTS | {
    "color": BLUE,
    "marker": "_",
    "markersize": 6,
    "label": "95 % of the peaks are below",
}
TUNED = {"color": GREEN, "linewidth": 1.2, "label": "tuned absorber", "linestyle": (0, (5, 2))}
OURS = DAMPED | {"marker": "s", "markersize": 3.0, "zorder": 3}
LIMIT = DOTTED | {"color": VERMILION, "linewidth": 0.9, "label": "quiet limit"}
ASKED = DOTTED | {"color": GREY, "linewidth": 0.8, "label": "share required"}
CHOSEN = {"color": VERMILION, "linewidth": 1.1, "label": "gap to build"}
TOLERATED = {"facecolor": PALE_SKY, "linewidth": 0, "zorder": 0, "label": "tolerance of the gap"}
CLIFF = {"color": ORANGE, "linewidth": 1.1, "linestyle": (0, (4, 2)), "label": "cliff"}
STAR = {"color": BLACK, "marker": "*", "markersize": 7, "linestyle": "none", "zorder": 4}
ESCAPED = {
    "color": GREY,
    "marker": "^",
    "markersize": 5,
    "linestyle": "none",
    "label": "escapes",
    "clip_on": False,
}
COARSE = {
    "color": GREY,
    "marker": "o",
    "markersize": 3.0,
    "linewidth": 0.6,
    "markerfacecolor": "none",
    "label": "coarse comparison",
}
CANDIDATES = {
    "color": BLUE,
    "marker": "s",
    "markersize": 3.2,
    "linewidth": 0.8,
    "label": "candidates",
}
ORBIT = {"color": BLUE, "linewidth": 1.0, "label": "quiet orbit, stable"}
LOST_ORBIT = FINE_DOTS | {"color": BLUE, "linewidth": 0.8, "label": "quiet orbit, unstable"}
BARS = {"linestyle": "none", "elinewidth": 0.6, "markerfacecolor": "none"}
SAMPLES = {"color": BLUE, "marker": "o", "markersize": 3.2, "label": "sample or corner"}
CORNERS = {"color": ORANGE, "marker": "s", "markersize": 3.2, "label": "corner, new starts"}
HALO = [withStroke(linewidth=2.6, foreground=WHITE)]
NOMINAL_FORCE = {"color": VERMILION, "linewidth": 1.3, "label": "nominal excitation"}
# Modulus in cells without an orbit, so that the line at 1 passes between them and the others.
ABSENT = 2.0
FRONT = {
    "color": BLUE,
    "marker": "o",
    "markersize": 5,
    "linestyle": "none",
    "label": "on the Pareto front",
}
BETTERED = FRONT | {"markerfacecolor": "none", "label": "bettered by another mass"}
NOTE = {"textcoords": "offset points", "fontsize": 7}


@style()
def draw_response(data):
    """Return the displacement against the forcing frequency, without and with the damper."""
    drawn = figure("single", 3.5)
    response_panel(drawn.subplots(), data)
    legend(drawn, 2)
    return drawn


def response_panel(axes, data):
    """Draw displacements without and with the damper against the forcing frequency."""
    names = ("bare_branch", "bare_frequency", "bare_displacement", "bare_stability")
    number, *rest = (data[name].values for name in names)
    for value, size, stable in runs_of(np.unique(number), number, *rest):
        axes.plot(value, size, **(BARE_STABLE if stable else BARE_UNSTABLE))
    for value, size, stable in runs(data, lambda period: True):
        axes.plot(value, size, **(STABLE if stable else UNSTABLE))
    size = data["maximum_displacement"].values
    settled = is_settled(data)
    shown = np.isfinite(size) & (data["outcome"].values != flag("outcome", "absent"))
    shown &= data["motion_starts"].values > 0
    for chosen, role in ((shown & settled, SETTLED), (shown & ~settled, OTHERS)):
        row, column = chosen.nonzero()
        plot_if_any(axes, data["frequency"].values[row], size[row, column], **role)
    frequency, largest = data["frequency"].values, data["reached_displacement"].values
    plot_sizes(axes, frequency, largest, **REACHED)
    high = data["motion_peak_high"].values
    plot_if_any(axes, frequency, np.where(high < 0.99 * largest, high, np.nan), **HIGH)
    limit_line(axes, data)
    axes.set(xlabel="Forcing frequency (Hz)", ylabel="Largest displacement (mm)")
    decades(axes)


@style()
def draw_transients(data):
    """Return the largest displacement in each cycle of two sweeps and of the unforced decay."""
    drawn = figure("single", 5.6)
    panels, looks = drawn.subplots(3), {"bare": BARE, "damped": DAMPED}
    for axes, direction in zip(panels, ("up", "down"), strict=False):
        swept = data.sel(direction=direction)
        for equipment, look in looks.items():
            size = swept["sweep_envelope"].sel(equipment=equipment)
            axes.plot(swept["sweep_frequency"], size, **look | {"linewidth": 0.8})
        limit_line(axes, data)
        _shade_outside_band(axes, data)
        axes.set(xlabel=f"Forcing frequency, swept {direction} (Hz)")
        if direction == "down":
            axes.invert_xaxis()
    for equipment, look in looks.items():
        rung = data.sel(equipment=equipment)
        panels[2].plot(rung["ring_time"], rung["ring_envelope"], **look)
    panels[2].set(xlabel="Time of the unforced decay (s)")
    panels[2].set_ylim(bottom=0.5 * float(data["ring_envelope"].sel(equipment="bare").min()))
    for axes in panels:
        axes.set_ylabel("Displacement (mm)")
        decades(axes)
    legend(drawn, 2)
    return drawn


def _shade_outside_band(axes, data):
    swept, band = data["sweep_frequency"].values, parameters_of(data)["band"]
    for low, high in ((swept.min(), band[0]), (band[1], swept.max())):
        if low < high:
            axes.axvspan(low, high, facecolor=PALE, linewidth=0, zorder=0)


@style()
def draw_cliff(data):
    """Return the share of quiet starts and the displacement against the gap."""
    drawn = figure("single", 4.6)
    upper, lower = drawn.subplots(2, sharex=True, height_ratios=(2, 3))
    share_panel(upper, data)
    size_panel(lower, data)
    lower.set_xlabel("Gap, full play (mm)")
    legend(drawn, 2)
    return drawn


def share_panel(axes, data):
    """Draw the least share of quiet starts over the band against the gap."""
    _mark_gap(axes, data)
    axes.plot(data["coarse_gap"], data["coarse_share"], **COARSE)
    shares = data["start_quiet_share"].values
    rows, least = np.arange(len(shares)), shares.argmin(axis=1)
    share, ends = shares[rows, least], data["start_quiet_interval"].values[rows, least]
    bars = np.clip(np.abs(ends.T - share), 0, None)
    axes.errorbar(data["candidate_gap"], share, bars, elinewidth=0.8, capsize=1.5, **CANDIDATES)
    axes.axhline(parameters_of(data)["share"], **ASKED)
    axes.set(ylim=(-0.02, 1.04), ylabel="Share of quiet starts")


def size_panel(axes, data):
    """Draw the largest displacement over the band, and the quiet orbit, against the gap."""
    _mark_gap(axes, data)
    plot_sizes(axes, data["coarse_gap"].values, data["coarse_displacement"].values, **COARSE)
    worst = data["worst_displacement"].values.max(axis=1)
    plot_sizes(axes, data["candidate_gap"].values, worst, **CANDIDATES)
    for gap, size, stable in stable_runs(data):
        axes.plot(gap, size, **(ORBIT if stable else LOST_ORBIT))
    if int(data["best_orbit_status"]) != flag("best_orbit_status", "absent"):
        star = STAR | {"label": "smallest stable quiet orbit"}
        axes.plot(data["best_orbit_gap"], data["best_orbit_displacement"], **star)
    limit_line(axes, data)
    axes.set(xlim=_gap_span(data), ylabel="Largest displacement (mm)")
    decades(axes)


def stable_runs(data):
    """Yield gap (mm), displacement (mm) and stability of each part of the quiet orbit's branch."""
    names = ("gap_of_orbit", "displacement_by_gap", "modulus_by_gap")
    value, size, modulus = (data[name].values for name in names)
    stable = modulus < 1
    edges = [0, *(np.flatnonzero(np.diff(stable)) + 1), len(value)]
    for first, last in zip(edges, edges[1:], strict=False):
        if last > first:
            # includes the first orbit of the next part, so that the lines of both parts join
            part = slice(first, last + 1)
            yield value[part], size[part], bool(stable[first])


def _gap_span(data):
    """Return the limits of the axis of gaps, mm: around candidates, best orbit and edges."""
    names = ("candidate_gap", "best_orbit_gap", "cliff_gap", "cliff_beyond", "stability_gap")
    gaps = np.concatenate([np.ravel(data[name].values) for name in names])
    coarse = data["coarse_gap"].values
    low, high = 0.85 * np.nanmin(gaps), 1.15 * np.nanmax(gaps)
    return max(low, 0.97 * coarse[0]), min(high, 1.03 * coarse[-1])


def _mark_gap(axes, data):
    """Mark the chosen gap, its tolerance, and the cliffs."""
    gap = float(data["design_gap"])
    tolerance = parameters_of(data)["tolerances"].get("gap", 0.0)
    axes.axvspan(gap * (1 - tolerance), gap * (1 + tolerance), **TOLERATED)
    axes.axvline(gap, **CHOSEN)
    found = data["cliff_status"].values == flag("cliff_status", "found")
    for edge in data["cliff_gap"].values[found]:
        axes.axvline(edge, **CLIFF)


@style()
def draw_tolerances(data):
    """Return the displacement against the share of quiet starts, for values within tolerances."""
    drawn = figure("single", 3.3)
    axes = drawn.subplots()
    for name, chosen, look in (
        ("sample", slice(None), SAMPLES),
        ("corner", slice(1, None), CORNERS),
    ):
        share = data[f"{name}_share"].values[chosen]
        size = data[f"{name}_displacement"].values[chosen]
        if len(size):
            bars = abs(share[:, 1:].T - share[:, 0])
            axes.errorbar(share[:, 0], size, xerr=bars, **look, **BARS)
    nominal = STAR | {"label": "nominal, new starts"}
    sizes = data["corner_displacement"].values[:1]
    plot_sizes(axes, data["corner_share"].values[:1, 0], sizes, **nominal)
    limit_line(axes, data)
    axes.axvline(parameters_of(data)["share"], **ASKED)
    axes.set(xlabel="Share of quiet starts over the band", ylabel="Largest displacement (mm)")
    decades(axes)
    legend(drawn, 2)
    return drawn


@style()
def draw_forces(data):
    """Return the maps over forcing frequency and excitation."""
    frequency, force = data["operating_frequency"].values, data["force_share"].values
    ends = _cell_edges(frequency), np.exp(_cell_edges(np.log(force)))
    drawn, panels = _maps(data, "force", frequency, force, ends)
    for axes in panels:
        axes.axhline(1.0, path_effects=HALO, **NOMINAL_FORCE)
        axes.set(yscale="log", ylabel="Excitation / nominal", yticks=force[::2])
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_locator(NullLocator())
        axes.set(xlim=ends[0][[0, -1]], ylim=ends[1][[0, -1]])
    panels[-1].set_xlabel("Forcing frequency (Hz)")
    legend(drawn, 2)
    return drawn


@style()
def draw_dampers(data):
    """Return the maps over gap and restitution, at the frequency at which quiet gaps end first."""
    gap, restitution = data["map_gap"].values, data["map_restitution"].values
    ends = np.exp(_cell_edges(np.log(gap))), _cell_edges(restitution)
    drawn, panels = _maps(data, "damper", gap, restitution, ends)
    star = STAR | {"markeredgecolor": WHITE, "markersize": 9, "label": "this design"}
    for axes in panels:
        axes.plot(float(data["design_gap"]), parameters_of(data)["restitution"], **star)
        axes.set(xscale="log", ylabel="Restitution", xticks=gap[::2])
        axes.xaxis.set_major_formatter("{x:.3g}")
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set(xlim=ends[0][[0, -1]], ylim=ends[1][[0, -1]])
    panels[-1].set_xlabel(f"Gap, full play (mm), at {float(data['branch_frequency']):.4g} Hz")
    legend(drawn, 2)
    return drawn


def _maps(data, name, x, y, ends):
    """Return a figure with a map of shares above a map of displacements, and its two axes.

    A line shows where the quiet orbit loses its stability. `ends` are the edges of the cells.
    """
    share, size, modulus = (
        data[f"{name}_map_{part}"].values.T for part in ("share", "displacement", "modulus")
    )
    drawn = figure("single", 5.2)
    panels, sizes = drawn.subplots(2, sharex=True), finite(size)
    low, high = np.nanmin(sizes), np.nanmax(sizes)
    looks = (
        (share, "cividis", Normalize(0, 1), "Share of quiet starts"),
        (sizes, "cividis_r", LogNorm(low, high), "Largest displacement (mm)"),
    )
    known = np.where(np.isnan(modulus), ABSENT, modulus)
    for axes, (values, colours, norm, label) in zip(panels, looks, strict=True):
        axes.set_facecolor(PALE)
        axes.patch.set(hatch="////", edgecolor=GREY, linewidth=0)
        shown = axes.pcolormesh(*ends, values, norm=norm, cmap=colours, rasterized=True)
        bar = drawn.colorbar(shown, ax=axes, label=label)
        if known.min() < 1 < known.max():
            line = axes.contour(x, y, known, [1.0], colors=BLACK, linewidths=1.1)
            line.set(path_effects=HALO)
            axes.plot([], [], color=BLACK, linewidth=1.1, label="end of stability")
    name_numbers(bar.ax.yaxis, low, high)
    return drawn, panels


def _cell_edges(centres):
    """Return cell edges midway between the centres, shape (len(centres) + 1,)."""
    middles = (centres[1:] + centres[:-1]) / 2
    ends = 2 * centres[[0, -1]] - middles[[0, -1]]
    return np.concatenate([ends[:1], middles, ends[1:]])


@style()
def draw_competitors(data):
    """Return the displacements with this damper, with the tuned absorber and without either."""
    drawn = figure("single", 4.8)
    upper, lower = drawn.subplots(2)
    frequency, force = data["frequency"].values, data["force_share"].values
    sizes = data["competitor_displacement"]
    _rivals_panel(upper, sizes.sel(force_share=1.0), frequency)
    _rivals_panel(lower, sizes.max("frequency", skipna=False), force)
    plot_sizes(upper, frequency, data["reached_displacement"].values, **OURS)
    ours = data["force_map_displacement"].max("operating_frequency")
    plot_sizes(lower, force, ours.values, **OURS)
    upper.set_xlabel("Forcing frequency (Hz)")
    lower.set(xlabel="Excitation / nominal", xscale="log", xticks=force[::2])
    lower.xaxis.set_major_formatter("{x:g}")
    lower.xaxis.set_minor_locator(NullLocator())
    for axes in (upper, lower):
        axes.set_ylabel("Largest displacement (mm)")
        decades(axes)
    legend(drawn, 2)
    return drawn


def _rivals_panel(axes, sizes, x):
    """Draw the machine alone and the absorber, with a band between its detuned versions (mm)."""
    plot_sizes(axes, x, sizes.sel(competitor="bare", detuning=0.0).values, **BARE)
    tuned = sizes.sel(competitor="tuned")
    if np.isfinite(tuned.values).any():
        low, high = finite(tuned.min("detuning")), finite(tuned.max("detuning"))
        shade = {"color": GREEN, "alpha": 0.2, "linewidth": 0, "label": "detuned by 10 %"}
        axes.fill_between(x, low, high, **shade)
        plot_sizes(axes, x, tuned.sel(detuning=0.0).values, **TUNED)


@style()
def draw_masses(data):
    """Return displacement and contact force against the loose mass, with the Pareto front."""
    design = STAR | {"label": "this design", "markersize": 4.5}
    drawn = figure("single", 3.9)
    panels = drawn.subplots(2, sharex=True)
    mass, best = data["other_mass"].values, data["other_best"].values.astype(bool)
    here = np.isclose(mass, parameters_of(data)["mass"])
    for axes, name in zip(panels, ("other_displacement", "other_force"), strict=True):
        values = data[name].values
        for chosen, look in ((best, FRONT), (~best, BETTERED)):
            plot_sizes(axes, mass[chosen], values[chosen], **look)
        axes.plot(mass[here], values[here], **design)
    limit_line(panels[0], data)
    panels[0].set_ylabel("Largest displacement (mm)")
    panels[1].set(xlabel="Loose mass (kg)", ylabel="Largest contact force (N)")
    for axes in panels:
        axes.set_yscale("log")
        axes.margins(0.12)
        low, high = axes.get_ylim()
        axes.set_ylim(low / 1.1, high * 1.25)
        decades(axes)
    rows = zip(mass, data["other_displacement"].values, data["other_gap"].values, strict=True)
    for x, size, gap in rows:
        if np.isfinite(size):
            panels[0].annotate(f"{gap:.3g}", (x, size), (0, 5), ha="center", **NOTE)
    legend(drawn, 2)
    return drawn


@style({"axes.labelsize": 8.0, "lines.markersize": 2.6})
def draw_machines(*, machines):
    """Return the response of each machine and the choice of its gap, from a list of datasets."""
    drawn = figure("double", 1.0 + 1.75 * len(machines))
    panels = drawn.subplots(len(machines), 3, squeeze=False)
    for (left, middle, right), data in zip(panels, machines, strict=True):
        response_panel(left, data)
        size_panel(middle, data)
        share_panel(right, data)
        right.set_xlim(middle.get_xlim())
    for axes in panels[-1, 1:]:
        axes.set_xlabel("Gap, full play (mm)")
    for axes, letter, data in zip(panels[:, 0], ascii_lowercase, machines, strict=False):
        name = data.attrs["name"].replace("_", " ")
        mass = json.loads(data.attrs["machine"])["mass"]
        axes.set_title(f"({letter}) {name}, {mass:g} kg", loc="left")
    legend(drawn, 4)
    return drawn


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


def plot_if_any(axes, x, y, **look):
    """Plot points, with an entry in the legend only if there are any."""
    if np.isfinite(np.asarray(y, float)).any():
        axes.plot(x, y, **look)


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


# Figures of the page of a machine, keyed by the name of the file without its ending.
FIGURES = {
    "drawing": draw_drawing,
    "response": draw_response,
    "transients": draw_transients,
    "cliff": draw_cliff,
    "tolerances": draw_tolerances,
    "forces": draw_forces,
    "dampers": draw_dampers,
    "competitors": draw_competitors,
    "masses": draw_masses,
}
