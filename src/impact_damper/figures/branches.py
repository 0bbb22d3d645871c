"""Branches of exact periodic orbits, stable and unstable, with their bifurcations."""

import numpy as np

from impact_damper.data.datasets import flag, has_damper
from impact_damper.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    ROLES,
    SKY,
    VERMILION,
    axis_label,
    figure,
    legend,
    style,
)

CAPTION = """
Largest displacement against forcing frequency of the exact periodic orbits, by pseudo-arclength
continuation of every branch on which a settled motion was found. Solid: stable, all Floquet
multipliers below 1 in modulus. Dotted: unstable. Grey and black: without the damper. Markers:
bifurcations and changes of contact, located to at least eight digits. A branch ends at the limits
of the frequency range or where it meets a branch of higher symmetry. Crosses: the branch continues,
but was not followed further, because a new contact begins there and the branch turns too sharply,
or because the orbit is too unstable (a multiplier above 100, or a disturbance that grows by more
than 300 in one period): it is one of the many unstable orbits within the chaotic motion. Branches
without any stable orbit are not searched for. Chaotic motions are not drawn.
"""

EVENTS = {
    "fold": ("fold", "o", BLACK),
    "symmetry_breaking": ("loss of symmetry", "s", BLACK),
    "period_doubling": ("period doubling", "^", VERMILION),
    "neimark_sacker": ("Neimark-Sacker", "D", VERMILION),
    "grazing": ("grazing: a contact is born", "P", SKY),
    "merging": ("merging of two contacts", "X", SKY),
}
OPEN_ENDS = ("too_unstable", "grazing", "lost", "point_limit")
OPEN = {
    "label": "not followed further",
    "marker": "x",
    "color": GREY,
    "markersize": 3.4,
    "linestyle": "none",
    "zorder": 2.5,
}
PERIODS = [
    ("period 1", BLUE, lambda period: period == 1),
    ("period 2", GREEN, lambda period: period == 2),
    ("period 3", PURPLE, lambda period: period == 3),
    ("longer periods", ORANGE, lambda period: period > 3),
]


@style()
def draw_branches(*, branches):
    """Draw the largest displacement of the orbits against frequency, one panel for each damper.

    Parameters
    ----------
    branches : list of xarray.Dataset
        Datasets of the stage branches; those without a damper are drawn in every panel.

    Returns
    -------
    matplotlib.figure.Figure
    """
    damped = [data for data in branches if has_damper(data)]
    free = [data for data in branches if not has_damper(data)]
    drawn = figure("double", 4.6 * len(damped))
    panels = drawn.subplots(len(damped), squeeze=False)[:, 0]
    for axes, data in zip(panels, damped, strict=True):
        for each in free:
            for value, size, stable in runs(each, lambda period: True):
                role = ROLES["free_stable" if stable else "free_unstable"]
                axes.plot(value, size, **role | {"linewidth": 0.7})
        for label, color, chosen in PERIODS:
            for value, size, stable in runs(data, chosen):
                look = {"label": f"damper, {label}"} if stable else {"linestyle": ":"}
                axes.plot(value, size, color=color, linewidth=1.5 if stable else 0.8, **look)
        mark_events(axes, data)
        mark_open_ends(axes, data)
        axes.set(
            xlabel="Forcing frequency, $\\Omega$",
            ylabel=axis_label(data["orbit_displacement"]),
        )
        axes.set_ylim(bottom=0)
    legend(drawn, 3)
    return drawn


def runs(data, chosen):
    """Yield each part of a branch on which all orbits are stable, or all unstable.

    Parameters
    ----------
    data : xarray.Dataset
        Dataset of the stage branches, or of `orbit_branch`.
    chosen : callable
        Maps the period of a branch to True if the branch is wanted.

    Yields
    ------
    (array, array, bool)
        Frequency, largest displacement, and whether stable.
    """
    names = ("orbit_branch", "followed_value", "orbit_displacement", "orbit_stability")
    periods = data["branch_period"].values
    branches = [branch for branch, period in enumerate(periods) if chosen(period)]
    yield from runs_of(branches, *(data[name].values for name in names))


def runs_of(branches, number, value, size, stability):
    """Yield the same as `runs`, for the given branches and from arrays in place of a dataset.

    Parameters
    ----------
    branches : iterable of int
    number, value, size, stability : array, shape (n,)
        Branch, frequency, largest displacement and stability of each orbit.
    """
    stable = stability == flag("orbit_stability", "stable")
    for branch in branches:
        at = np.flatnonzero(number == branch)
        edges = [0, *(np.flatnonzero(np.diff(stable[at])) + 1), len(at)]
        for first, last in zip(edges, edges[1:], strict=False):
            # includes the first orbit of the next part, so that no gap is drawn between them
            part = at[first : last + 1]
            yield value[part], size[part], bool(stable[at[first]])


def draw_free_orbits(axes, data):
    """Draw orbits without a damper; period (1, 3, others) and stability set colour and line."""
    for role, unstable, chosen in (
        ("free_stable", "free_unstable", lambda period: period == 1),
        ("subharmonic_free", "subharmonic_unstable", lambda period: period == 3),
        ("free_higher", "free_unstable", lambda period: period not in (1, 3)),
    ):
        for value, size, stable in runs(data, chosen):
            axes.plot(value, size, **ROLES[role if stable else unstable])


def mark_open_ends(axes, data):
    """Mark with a cross every end beyond which a branch continues but was not followed."""
    chosen = [flag("branch_end", name) for name in OPEN_ENDS]
    number = data["orbit_branch"].values
    for branch, ends in enumerate(data["branch_end"].values):
        at = np.flatnonzero(number == branch)
        for place, end in zip((at[0], at[-1]), ends, strict=True):
            if end in chosen:
                axes.plot(data["followed_value"][place], data["orbit_displacement"][place], **OPEN)


def mark_events(axes, data):
    """Mark every located event."""
    for name, (label, marker, color) in EVENTS.items():
        chosen = data["event_kind"].values == flag("event_kind", name)
        if chosen.any():
            axes.plot(
                data["event_value"].values[chosen],
                data["event_displacement"].values[chosen],
                label=label,
                marker=marker,
                color=color,
                markersize=3.4,
                linestyle="none",
                zorder=3,
            )
