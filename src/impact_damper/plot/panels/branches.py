"""Branches of exact periodic orbits, stable and unstable, with their bifurcations.

A branch is a sequence of periodic orbits along the forcing frequency. An event is a bifurcation on
a branch, or a change of the contacts of its orbits. Free means without the damper.
"""

import numpy as np

from impact_damper.data.datasets import flag, has_damper
from impact_damper.plot.panels.style import (
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
Largest displacement of the exact periodic orbits against forcing frequency. Each settled motion
found is continued to a branch. Black, grey: without damper. Unstable orbits of other periods are
faint. Markers are large next to a stable orbit, small between unstable orbits of period 1.
Plus: a contact appears, or two merge. Cross: the branch continues, but was not followed further.
"""

# Kind of event -> label, marker, colour.
EVENTS = {
    "fold": ("fold", "o", BLACK),
    "symmetry_breaking": ("loss of symmetry or doubling", "s", VERMILION),
    "period_doubling": ("loss of symmetry or doubling", "s", VERMILION),
    "neimark_sacker": ("Neimark-Sacker", "D", GREEN),
    "grazing": ("change of contact", "P", SKY),
    "merging": ("change of contact", "P", SKY),
}
# Markers of changes of contact are pale, so they have an edge and are larger by this factor.
EDGE = {"P": {"markeredgecolor": BLACK, "markeredgewidth": 0.3}}
WIDER = {"P": 2.0}
# An inset magnifies a part of the axes with many events. All lengths are fractions of the axes.
INSET = (0.225, 0.45)  # width and height of the inset
LABELS = (0.05, 0.07)  # room for its labels, to the left and below
# Left and lower sides of the inset that are tried, the upper right corner first.
LEFTS, BOTTOMS = np.linspace(0.76, 0.06, 15), np.linspace(0.52, 0.1, 15)
MAGNIFIED = (0.15, 0.2)  # width and height of the part that it shows
CROWD = 4  # least number of events in this part
# Sizes of markers of events next to stable orbits, and of others.
LARGE, SMALL = 3.0, 1.2
# Reasons for the end of a branch that continues in truth.
OPEN_ENDS = ("lost", "point_limit", "unstable")
OPEN = {
    "marker": "x",
    "color": BLACK,
    "markersize": 4.5,
    "markeredgewidth": 1.0,
    "linestyle": "none",
    "zorder": 3.1,
}

# Label, colour, opacity of unstable orbits, and test of the period.
PERIODS = [
    ("period 1", BLUE, 1.0, lambda period: period == 1),
    ("period 3", PURPLE, 1.0, lambda period: period == 3),
    ("other periods", ORANGE, 0.4, lambda period: period not in (1, 3)),
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
                look = {"linewidth": 0.7, "label": None} | ({} if stable else {"linestyle": ":"})
                axes.plot(value, size, **role | look)
        draw_orbits(axes, data)
        axes.set_ylim(bottom=0)
        _magnify(axes, data)
        axes.set(
            xlabel="Forcing frequency, $\\Omega$",
            ylabel=axis_label(data["orbit_displacement"]),
        )
    legend(drawn, 4)
    return drawn


def _magnify(axes, data):
    """Draw an inset that magnifies the part with most events next to stable orbits."""
    beside = _next_to_stable(data)
    places = np.stack([data["event_value"].values, data["event_displacement"].values])[:, beside]
    limits = np.array([axes.get_xlim(), axes.get_ylim()])
    half = np.diff(limits) * np.array(MAGNIFIED)[:, None] / 2
    near = np.all(np.abs(places[:, :, None] - places[:, None]) <= half[..., None], axis=0)
    if near.sum(axis=0).max(initial=0) < CROWD:
        return
    middle = places[:, near[np.argmax(near.sum(axis=0))]].mean(axis=1)[:, None]
    inset = axes.inset_axes((*_emptiest_corner(axes), *INSET))
    draw_orbits(inset, data)
    (left, right), (bottom, top) = middle + half * [-1, 1]
    inset.set(xlim=(left, right), ylim=(bottom, top))
    axes.indicate_inset_zoom(inset)


def _emptiest_corner(axes):
    """Return the lower left corner of the inset that covers the fewest points of lines, shape (2,).

    In fractions of the axes.
    """
    lines = [line.get_xydata() for line in axes.lines]
    points = axes.transLimits.transform(np.concatenate(lines))
    corners = np.array([(left, bottom) for left in LEFTS for bottom in BOTTOMS])
    covered = [
        np.all((points > corner - LABELS) & (points < corner + INSET), axis=1).sum()
        for corner in corners
    ]
    return corners[np.argmin(covered)]


def draw_orbits(axes, data):
    """Draw every branch of a dataset, its events, and the ends beyond which it was not followed.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    data : xarray.Dataset
        Of the stage branches, or of `orbit_branch`.
    """
    for label, color, opacity, chosen in PERIODS:
        faint = {"linestyle": ":", "linewidth": 0.35, "alpha": opacity}
        strong = {"label": label, "zorder": 2.2, "linewidth": 1.5}
        for value, size, stable in runs(data, chosen):
            axes.plot(value, size, color=color, **(strong if stable else faint))
    axes.plot([], [], color=GREY, linewidth=0.8, linestyle=":", label="unstable")
    mark_events(axes, data)
    mark_open_ends(axes, data)


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
        Parameter that varies (in the stage branches the frequency), largest displacement, and
        whether stable.
    """
    names = ("orbit_branch", "followed_value", "orbit_displacement", "orbit_stability")
    periods = data["branch_period"].values
    branches = [branch for branch, period in enumerate(periods) if chosen(period)]
    yield from runs_of(branches, *(data[name].values for name in names))


def runs_of(branches, number, value, size, stability):
    """Yield the parts of branches as `runs` does, from arrays instead of a dataset.

    Parameters
    ----------
    branches : iterable of int
    number, value, size, stability : array, shape (n,)
        Branch, parameter that varies, largest displacement and stability of each orbit.
    """
    stable = stability == flag("orbit_stability", "stable")
    for branch in branches:
        at = np.flatnonzero(number == branch)
        edges = [0, *(np.flatnonzero(np.diff(stable[at])) + 1), len(at)]
        for first, last in zip(edges, edges[1:], strict=False):
            # includes the first orbit of the next part, so that the lines of both parts join
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
    """Mark with a cross each end beyond which a branch continues but was not followed."""
    chosen = [flag("branch_end", name) for name in OPEN_ENDS]
    number = data["orbit_branch"].values
    for branch, ends in enumerate(data["branch_end"].values):
        at = np.flatnonzero(number == branch)
        for place, end in zip((at[0], at[-1]), ends, strict=True):
            if end in chosen:
                axes.plot(data["followed_value"][place], data["orbit_displacement"][place], **OPEN)


def mark_events(axes, data):
    """Mark events of period 1, and with large markers all events next to stable orbits."""
    beside = _next_to_stable(data)
    plain = data["branch_period"].values[data["event_branch"].values] == 1
    kinds = data["event_kind"].values
    for name, (label, marker, color) in EVENTS.items():
        chosen = kinds == flag("event_kind", name)
        for large in (True, False):
            at = chosen & (beside == large) & (plain | large)
            if at.any():
                axes.plot(
                    data["event_value"].values[at],
                    data["event_displacement"].values[at],
                    label=label if large else None,
                    marker=marker,
                    color=color,
                    markersize=WIDER.get(marker, 1) * (LARGE if large else SMALL),
                    linestyle="none",
                    zorder=3 if large else 2.1,
                    **EDGE.get(marker, {}),
                )


def _next_to_stable(data):
    """Return for each event whether the orbit at the event or one of its neighbours is stable."""
    number, branch = data["orbit_branch"].values, data["event_branch"].values
    stable = data["orbit_stability"].values == flag("orbit_stability", "stable")
    place = np.searchsorted(number, branch) + data["event_place"].values
    found = np.zeros(len(place), bool)
    for side in (-1, 0, 1):
        at = np.clip(place + side, 0, len(number) - 1)
        found |= stable[at] & (number[at] == branch)
    return found
