"""Frequency responses with and without a damper (paper: figures 5, 8, 10; figure kind `response`).

A role is a key of `style.ROLES`, the colour and marker of a kind of motion. Free means without the
damper.
"""

import numpy as np

from impact_damper.data.datasets import flag, has_damper, is_settled, parameters_of
from impact_damper.plot.panels.branches import draw_free_orbits, runs
from impact_damper.plot.panels.harmonic_balance import draw_balance, draw_band
from impact_damper.plot.panels.motion_lines import branch_lines, draw_lines
from impact_damper.plot.panels.style import ROLES, axis_label, figure, legend, letter_panels, style

CAPTION = """
Largest displacement against forcing frequency. Motions with damper come from random starts and
neighbouring frequencies. Lines join settled motions of a branch. Dotted lines, and all motions
without damper, are exact orbits. Transient chaos ended in a longer run. Harmonic balance gives the
amplitude of the first harmonic.
"""

JOINED = {"linestyle": "-", "linewidth": 0.5}
# Role of each outcome, and of chaotic transients.
STATUSES = {
    "chaotic": "chaotic",
    "chaotic_transient": "chaotic_transient",
    "quasi_periodic": "quasi_periodic",
    "non_colliding": "non_colliding",
    "drifting": "non_colliding",
    "unresolved": "unresolved",
}
FREE = {
    "chaotic": ROLES["chaotic"] | {"label": "free, chaotic"},
    "unresolved": ROLES["unresolved"] | {"label": "free, unresolved"},
}


@style()
def draw_response(*, response, harmonic_balance, subharmonic, branches):
    """Draw the largest displacement against frequency, all dampers of an oscillator in one plot.

    Parameters
    ----------
    response : list of xarray.Dataset
        Datasets of the stage response with a damper, elastic or inelastic.
    harmonic_balance : list of xarray.Dataset
        Datasets of the stage harmonic_balance of the elastic dampers.
    subharmonic : list of xarray.Dataset
        Datasets of the stage subharmonic.
    branches : list of xarray.Dataset
        Datasets of the stage branches, with and without a damper.

    Returns
    -------
    matplotlib.figure.Figure
    """
    free = [orbits for orbits in branches if not has_damper(orbits)]
    kinds = sorted({restitution(motions) for motions in response}, reverse=True)
    drawn = figure("double", 1.7 + 3.3 * len(kinds))
    panels = drawn.subplots(len(kinds), squeeze=False, sharex=True)[:, 0]
    for axes, kind in zip(panels, kinds, strict=True):

        def same(data, kind=kind):
            return has_damper(data) and restitution(data) == kind

        response_panel(
            axes,
            [*filter(same, response)],
            [*filter(same, harmonic_balance)],
            free + [*filter(same, branches)],
        )
        for motions in filter(same, subharmonic):
            draw_settled(axes, motions, ["subharmonic_damped"])
        axes.set_ylabel(axis_label(response[0]["maximum_displacement"]))
        axes.set_ylim(bottom=0)
        if len(kinds) > 1:
            axes.set_title(f"$e = {kind:g}$")
    first = response[0]["frequency"]
    panels[-1].set(xlabel=axis_label(first), xlim=first.values[[0, -1]])
    if len(kinds) > 1:
        letter_panels(panels)
    legend(drawn, 3)
    return drawn


def restitution(data):
    """Return the coefficient of restitution of the damper that a dataset was computed for."""
    return parameters_of(data)["restitution"]


def response_panel(axes, response, harmonic_balance, branches, *, apart=False):
    """Draw motions, solutions of harmonic balance and exact orbits, with and without a damper.

    With `apart`, inelastic dampers have other colours and markers than elastic ones.
    """
    for orbits in branches:
        if has_damper(orbits):
            draw_unstable_orbits(axes, orbits, prefix_of(orbits) if apart else "")
        else:
            draw_free_orbits(axes, orbits)
    for balance in harmonic_balance:
        if has_damper(balance):
            draw_band(axes, balance)
            draw_balance(axes, balance)
    for motions in response:
        if has_damper(motions):
            draw_motions(axes, motions, prefix_of(motions) if apart else "")
        else:
            draw_free_motions(axes, motions)


def draw_free_motions(axes, motions):
    """Draw the motions without a damper: settled ones joined along branches, others as points."""
    settled = is_settled(motions)
    period = motions["period"].values
    for role, chosen in (("free_stable", period == 1), ("free_higher", period != 1)):
        draw_lines(axes, branch_lines(motions, settled & chosen), ROLES[role])
    draw_unsettled(axes, motions, FREE)


def draw_motions(axes, motions, prefix):
    """Draw the motions with a damper: settled ones joined along branches, others as points."""
    draw_settled(axes, motions, ["period_1", "higher_period", "subharmonic_damped"], prefix)
    roles = {status: ROLES[f"{prefix}{role}"] for status, role in STATUSES.items()}
    draw_unsettled(axes, motions, roles)


def draw_unsettled(axes, motions, roles):
    """Draw the motions that have not settled on an orbit as points; `roles` maps outcomes to roles.

    Chaos that ended in one of the runs gets the role `chaotic_transient`, if `roles` has it.
    """
    for status, role in roles.items():
        outcome = "chaotic" if status == "chaotic_transient" else status
        chosen = motions["outcome"].values == flag("outcome", outcome)
        if outcome == "chaotic" and "chaotic_transient" in roles:
            ended = motions["life_ends"].values > 0 if "life_ends" in motions else False
            chosen &= np.equal(ended, status == "chaotic_transient")
        row, column = chosen.nonzero()
        if len(row):
            axes.plot(
                motions["frequency"].values[row],
                motions["maximum_displacement"].values[row, column],
                **role,
            )


def draw_unstable_orbits(axes, orbits, prefix):
    """Draw the unstable parts of the branches of orbits with a damper that have period 1."""
    role = ROLES[f"{prefix}unstable_orbit"]
    for value, size, stable in runs(orbits, lambda period: period == 1):
        if not stable:
            axes.plot(value, size, **role)


def prefix_of(data):
    """Return the prefix of names in `style.ROLES`: "inelastic_" for restitution below 1, or ""."""
    return "inelastic_" if restitution(data) < 1 else ""


def draw_settled(axes, motions, roles, prefix=""):
    """Draw settled motions with contacts; periods that are multiples of 3 count as subharmonic."""
    period = motions["period"].values
    colliding = is_settled(motions) & (motions["contacts"].values > 0)
    chosen = {
        "period_1": period == 1,
        "higher_period": (period > 1) & (period % 3 != 0),
        "subharmonic_damped": (period > 1) & (period % 3 == 0),
    }
    for role in roles:
        found = branch_lines(motions, colliding & chosen[role])
        draw_lines(axes, found, ROLES[f"{prefix}{role}"] | JOINED)
