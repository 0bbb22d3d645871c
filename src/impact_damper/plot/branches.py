"""Plots of branches of periodic orbits, stable and unstable, with their bifurcations."""

import numpy as np

from impact_damper.data.datasets import flag, parameters_of
from impact_damper.model.parameters import SYMBOLS
from impact_damper.plot import style
from impact_damper.plot.sheets import datasets_in, sheet

# Kind of event -> label, marker, colour.
EVENTS = {
    "fold": ("fold", "o", style.BLACK),
    "symmetry_breaking": ("loss of symmetry or doubling", "s", style.VERMILION),
    "period_doubling": ("loss of symmetry or doubling", "s", style.VERMILION),
    "neimark_sacker": ("Neimark-Sacker", "D", style.GREEN),
    "grazing": ("change of contact", "P", style.SKY),
    "merging": ("change of contact", "P", style.SKY),
}
# Reasons why the computation ended although the branch goes on. OPEN is the marker of such an end.
OPEN_ENDS = ("lost", "point_limit", "unstable")
OPEN = {"marker": "x", "color": style.BLACK, "markersize": 4.5, "linestyle": "none", "zorder": 3.1}
# Looks of branches. Columns: label, colour, opacity of unstable orbits, condition on the period.
PERIODS = [
    ("period 1", style.BLUE, 1.0, lambda period: period == 1),
    ("period 3", style.PURPLE, 1.0, lambda period: period == 3),
    ("other periods", style.ORANGE, 0.4, lambda period: period not in (1, 3)),
]
# Looks of branches without a damper. Columns: key of `style.ROLES` for stable orbits, key for
# unstable orbits, condition on the period.
FREE = [
    ("free_stable", "free_unstable", lambda period: period == 1),
    ("subharmonic_free", "subharmonic_unstable", lambda period: period == 3),
    ("free_higher", "free_unstable", lambda period: period not in (1, 3)),
]


def branch(data, axes=None):
    """Draw the largest displacement in periodic orbits against the parameter that varies.

    Stable orbits are solid lines, and unstable orbits dotted lines. Colours distinguish periods.
    Markers show bifurcations and changes of contact, but only next to stable orbits.

    Parameters
    ----------
    data : xarray.Dataset or list of xarray.Dataset
        Results of `orbit_branches`, all with equal `parameter`.
    axes : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, start = idm.Oscillator(0.215), (0.006, 0.187, 0.002, -2.408)
    >>> damper = idm.Damper(0.12, 2.0)
    >>> found = idm.orbit_branches(oscillator, damper, 2.0, start, span=(1.9, 2.1))
    >>> axes = idm.plot.branch(found)
    """
    given = datasets_in(data, lambda each: "event_kind" in each, "orbit_branches")
    with sheet(axes) as (axes,):
        for each in given:
            for label, color, opacity, chosen in PERIODS:
                faint = {"linestyle": ":", "linewidth": 0.35, "alpha": opacity}
                strong = {"label": label, "zorder": 2.2, "linewidth": 1.5}
                for value, size, stable in runs(each, chosen):
                    style.draw(axes, value, size, color=color, **(strong if stable else faint))
            _mark_events(axes, each)
            _mark_open_ends(axes, each)
        axes.plot([], [], color=style.GREY, linewidth=0.8, linestyle=":", label="unstable")
        words = style.axis_label(given[0]["orbit_displacement"])
        axes.set(xlabel=followed_label(given[0]), ylabel=words)
    return axes


def followed_label(data):
    """Return the axis label of the parameter that varies along a branch."""
    name, units = parameters_of(data)["parameter"], data["followed_value"].attrs["units"]
    words = {
        ("frequency", units): "Forcing frequency",
        ("mass_ratio", "kg"): "Mass of the damper",
        ("clearance", "mm"): "Gap",
    }.get((name, units), name.replace("_", " ").capitalize())
    symbol = style.tex("Omega" if name == "frequency" else SYMBOLS[name])
    return f"{words}, ${symbol}$" if units == "1" else f"{words} ({units})"


def runs(data, chosen):
    """Yield parts (see `parts_by_stability`) of the branches for which chosen(period) is true."""
    stable = data["orbit_stability"].values == flag("orbit_stability", "stable")
    value, size = data["followed_value"].values, data["orbit_displacement"].values
    for branch, period in enumerate(data["branch_period"].values):
        if chosen(period):
            at = data["orbit_branch"].values == branch
            yield from parts_by_stability(value[at], size[at], stable[at])


def parts_by_stability(value, size, stable):
    """Cut a branch where stability changes. Yield (values, displacements, stable) for each part."""
    edges = [0, *(np.flatnonzero(np.diff(stable)) + 1), len(value)]
    for first, last in zip(edges, edges[1:], strict=False):
        if last > first:
            # A part includes the first orbit of the next part, so that the lines of the parts join.
            part = slice(first, last + 1)
            yield value[part], size[part], bool(stable[first])


def draw_free_orbits(axes, data):
    """Draw orbits without a damper. The look of an orbit depends on its period and stability."""
    for role, unstable, chosen in FREE:
        for value, size, stable in runs(data, chosen):
            style.draw(axes, value, size, **style.ROLES[role if stable else unstable])


def _mark_open_ends(axes, data):
    chosen = [flag("branch_end", name) for name in OPEN_ENDS]
    number = data["orbit_branch"].values
    for each, ends in enumerate(data["branch_end"].values):
        at = np.flatnonzero(number == each)[[0, -1]][np.isin(ends, chosen)]
        axes.plot(data["followed_value"][at], data["orbit_displacement"][at], **OPEN)


def _mark_events(axes, data):
    number, branches = data["orbit_branch"].values, data["event_branch"].values
    stable = data["orbit_stability"].values == flag("orbit_stability", "stable")
    place = np.searchsorted(number, branches) + data["event_place"].values
    beside = np.zeros(len(place), bool)
    for side in (-1, 0, 1):
        at = np.clip(place + side, 0, len(number) - 1)
        beside |= stable[at] & (number[at] == branches)
    for name, (label, marker, color) in EVENTS.items():
        chosen = data.isel(event=beside & (data["event_kind"].values == flag("event_kind", name)))
        if chosen.sizes["event"]:
            look = {"color": color, "marker": marker, "linestyle": "none", "zorder": 3}
            value, size = chosen["event_value"], chosen["event_displacement"]
            style.draw(axes, value, size, label=label, **look)
