"""Frequency responses, branches of orbits and shares: figures 2 to 5, 8 and 10 of the paper."""

import numpy as np

from impact_damper.data.datasets import flag, has_damper, is_settled, parameters_of
from impact_damper.plot.branches import branch as branch_plot
from impact_damper.plot.branches import next_to_stable, runs
from impact_damper.plot.motions import phase_panel
from impact_damper.plot.responses import response as response_plot
from impact_damper.plot.stacked_shares import LOOKS
from impact_damper.plot.stacked_shares import shares as shares_plot
from impact_damper.plot.style import (
    ROLES,
    figure,
    legend,
    letter_panels,
    parameter_label,
    style,
)

# An inset magnifies a part of the axes with many events. All lengths are fractions of the axes.
INSET = (0.225, 0.45)  # width and height of the inset
LABELS = (0.05, 0.07)  # room for its labels, to the left and below
# Left and lower sides of the inset that are tried, the upper right corner first.
LEFTS, BOTTOMS = np.linspace(0.76, 0.06, 15), np.linspace(0.52, 0.1, 15)
MAGNIFIED = (0.15, 0.2)  # width and height of the part that it shows
CROWD = 4  # least number of events in this part


@style()
def draw_free(*, branches):
    """Draw the largest displacement of orbits without a damper, one panel for each oscillator."""
    drawn = figure("double", 3.4)
    panels = drawn.subplots(1, len(branches), squeeze=False)[0]
    for axes, free in zip(panels, branches, strict=True):
        response_plot(free, axes)
        value = free["followed_value"].values
        axes.set_xlim(value.min(), value.max())
    if len(panels) > 1:
        letter_panels(panels)
    legend(drawn, 2)
    return drawn


@style()
def draw_harmonic_balance(*, harmonic_balance):
    """Draw the amplitude by harmonic balance against frequency, one panel for each damper."""
    drawn = figure("double", 3.2)
    panels = drawn.subplots(1, len(harmonic_balance), sharey=True, squeeze=False)[0]
    for axes, balance in zip(panels, harmonic_balance, strict=True):
        response_plot(balance, axes)
        axes.set(
            title=f"$d_0 = {parameters_of(balance)['clearance']:.3g}$",
            xlim=balance["frequency"].values[[0, -1]],
        )
    for axes in panels[1:]:
        axes.set_ylabel("")
    panels[0].autoscale(axis="y")
    panels[0].set_ylim(bottom=0)
    legend(drawn, 2)
    return drawn


@style()
def draw_motion(*, motion):
    """Draw velocity against displacement and mark the contacts, one panel for each motion."""
    drawn = figure("single" if len(motion) == 1 else "double", 3.2)
    panels = drawn.subplots(1, len(motion), squeeze=False)[0]
    for axes, traced in zip(panels, motion, strict=True):
        phase_panel(axes, traced)
    if len(panels) > 1:
        letter_panels(panels)
    legend(drawn, 2)
    return drawn


@style()
def draw_response(*, response, harmonic_balance, subharmonic, branches):
    """Draw displacement against frequency, one panel for each restitution of the dampers."""
    free = [orbits for orbits in branches if not has_damper(orbits)]
    kinds = sorted({_restitution(motions) for motions in response}, reverse=True)
    drawn = figure("double", 1.7 + 3.3 * len(kinds))
    panels = drawn.subplots(len(kinds), squeeze=False, sharex=True)[:, 0]
    for axes, kind in zip(panels, kinds, strict=True):
        damped = [
            each
            for each in [*branches, *harmonic_balance, *response]
            if has_damper(each) and _restitution(each) == kind
        ]
        same = [each for each in subharmonic if has_damper(each) and _restitution(each) == kind]
        response_plot([*free, *damped, *map(_period_3, same)], axes)
        axes.label_outer()
        if len(kinds) > 1:
            axes.set_title(f"$e = {kind:g}$")
    panels[-1].set_xlim(response[0]["frequency"].values[[0, -1]])
    if len(kinds) > 1:
        letter_panels(panels)
    legend(drawn, 3)
    return drawn


def _restitution(data):
    """Return the coefficient of restitution of the damper that a dataset was computed for."""
    return parameters_of(data)["restitution"]


def _period_3(motions):
    """Return motions of which only the settled ones are left whose period is a multiple of 3."""
    period = motions["period"]
    chosen = is_settled(motions) & (period > 1) & (period % 3 == 0)
    outcome = motions["outcome"].where(chosen, flag("outcome", "absent"))
    return motions.assign(outcome=outcome)


@style()
def draw_branches(*, branches):
    """Draw the largest displacement of the orbits against frequency, one panel for each damper.

    Orbits without a damper are drawn in every panel.
    """
    damped = [data for data in branches if has_damper(data)]
    free = [data for data in branches if not has_damper(data)]
    drawn = figure("double", 4.6 * len(damped))
    panels = drawn.subplots(len(damped), squeeze=False)[:, 0]
    for axes, data in zip(panels, damped, strict=True):
        for each in free:
            for value, size, stable in runs(each, lambda period: True):
                role = ROLES["free_stable" if stable else "free_unstable"]
                dashes = {} if stable else {"linestyle": ":"}
                axes.plot(value, size, **role | dashes | {"linewidth": 0.7, "label": None})
        branch_plot(data, axes)
        axes.set_ylim(bottom=0)
        _magnify(axes, data)
    legend(drawn, 4)
    return drawn


def _magnify(axes, data):
    """Draw an inset that magnifies the part with most events next to stable orbits."""
    beside = next_to_stable(data)
    places = np.stack([data["event_value"].values, data["event_displacement"].values])[:, beside]
    limits = np.array([axes.get_xlim(), axes.get_ylim()])
    half = np.diff(limits) * np.array(MAGNIFIED)[:, None] / 2
    near = np.all(np.abs(places[:, :, None] - places[:, None]) <= half[..., None], axis=0)
    if near.sum(axis=0).max(initial=0) < CROWD:
        return
    middle = places[:, near[np.argmax(near.sum(axis=0))]].mean(axis=1)[:, None]
    inset = axes.inset_axes((*_emptiest_corner(axes), *INSET))
    branch_plot(data, inset)
    (left, right), (bottom, top) = middle + half * [-1, 1]
    inset.set(xlim=(left, right), ylim=(bottom, top), xlabel="", ylabel="")
    axes.indicate_inset_zoom(inset)


def _emptiest_corner(axes):
    """Return the lower left corner of the inset that covers the fewest points of lines."""
    lines = [line.get_xydata() for line in axes.lines]
    points = axes.transLimits.transform(np.concatenate(lines))
    corners = np.array([(left, bottom) for left in LEFTS for bottom in BOTTOMS])
    covered = [
        np.all((points > corner - LABELS) & (points < corner + INSET), axis=1).sum()
        for corner in corners
    ]
    return corners[np.argmin(covered)]


@style()
def draw_shares(*, response):
    """Draw the shares of random starts over frequency, one panel for each damper."""
    columns = min(len(response), 2)
    rows = -(-len(response) // columns)
    empty = rows * columns > len(response)
    drawn = figure("double", (0.2 if empty else 0.8) + 2.3 * rows)
    panels = drawn.subplots(rows, columns, squeeze=False, sharey=True)
    used = panels.flat[: len(response)]
    for axes, data in zip(used, response, strict=True):
        shares_plot(data, axes)
        words = parameter_label(parameters_of(data), "mass_ratio", "clearance", "restitution")
        unseen = f"not seen: at most {100 * float(data['missed_share']):.2g} %"
        axes.set_title(f"{words}; {unseen}", loc="right", fontsize=8)
    for axes in panels[:, 1:].flat:
        axes.set_ylabel("")
    if len(response) > 1:
        letter_panels(used)
    if empty:
        legend(drawn, 2, order=LOOKS, place=panels.flat[-1])
    else:
        legend(drawn, 4, order=LOOKS)
    return drawn
