"""Displacement against forcing frequency: motions, harmonic balance and exact orbits."""

import numpy as np

from impact_damper.data.datasets import flag, has_damper, is_settled, parameters_of
from impact_damper.plot.branches import draw_free_orbits, followed_label, runs
from impact_damper.plot.lines import branch_lines
from impact_damper.plot.sheets import datasets_in, sheet
from impact_damper.plot.style import BLUE, ROLES, axis_label, draw

# Settled motions of a branch are joined by a thin line.
JOINED = {"linestyle": "-", "linewidth": 0.5}
# Looks of motions that have not settled on an orbit with contacts, by outcome.
DAMPED = {name: ROLES[name] for name in ("chaotic", "chaotic_transient", "quasi_periodic")}
DAMPED |= {name: ROLES["non_colliding"] for name in ("non_colliding", "drifting")}
DAMPED["unresolved"] = ROLES["unresolved"]
FREE = {
    "chaotic": ROLES["chaotic"] | {"label": "free, chaotic"},
    "unresolved": ROLES["unresolved"] | {"label": "free, unresolved"},
}
# Looks of results of `steady_motion`.
SETTLED = ROLES["period_1"] | JOINED | {"label": "settled"}
STILL = ROLES["non_colliding"] | {"label": "no contact"}
UNSETTLED = ROLES["chaotic"] | {"label": "not settled"}


def response(data, axes=None):
    """Draw displacement against forcing frequency.

    Stable orbits with a damper are drawn if no motions with a damper are.

    Parameters
    ----------
    data : xarray.Dataset or list of xarray.Dataset
        Results of `frequency_response`, `subharmonic_suppression`, `steady_motion`,
        `harmonic_balance` or `orbit_branches` (over frequency), with or without a damper, in any
        combination.
    axes : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import impact_damper as idm
    >>> free = idm.harmonic_balance(idm.Oscillator(0.215), None, [1.8, 1.9, 2.0])
    >>> axes = idm.plot.response(free)
    """
    given = datasets_in(
        data,
        lambda each: bool(_kind(each)),
        "frequency_response, subharmonic_suppression, steady_motion, harmonic_balance or "
        "orbit_branches (over frequency)",
    )
    parts = {kind: [each for each in given if _kind(each) == kind] for kind in map(_kind, given)}
    motions, orbits = parts.get("motions", []), parts.get("orbits", [])
    with sheet(axes) as (axes,):
        for each in orbits:
            _draw_orbits(axes, each, stable=not any(map(has_damper, motions)))
        for each in parts.get("balance", []):
            _draw_balance(axes, each, free=not has_damper(each) or not motions + orbits)
        for each in motions:
            _draw_motions(axes, each)
        if "steady" in parts:
            _draw_steady(axes, parts["steady"])
        axes.set(xlabel=_frequency_label(given), ylabel=_size_label(given))
        axes.set_ylim(bottom=0)
    return axes


def _kind(data):
    """Return the kind of response that a dataset holds, or ""."""
    if "followed_value" in data and parameters_of(data).get("parameter") == "frequency":
        return "orbits"
    if "free_amplitude" in data:
        return "balance"
    if "maximum_displacement" in data and "frequency" in data.coords:
        kinds = {("frequency", "motion"): "motions", (): "steady", ("frequency",): "steady"}
        return kinds.get(data["maximum_displacement"].dims, "")
    return ""


def _draw_orbits(axes, orbits, stable):
    """Draw orbits without a damper, or with one those of period 1 and, if `stable`, stable ones."""
    if not has_damper(orbits):
        draw_free_orbits(axes, orbits)
        return
    for value, size, is_stable in runs(orbits, lambda period: period == 1):
        if not is_stable:
            draw(axes, value, size, **ROLES["unstable_orbit"])
    for value, size, is_stable in runs(orbits, lambda period: stable):
        if is_stable:
            draw(axes, value, size, color=BLUE, label="stable orbit")


def _draw_balance(axes, balance, free):
    """Draw the band, the stable solutions with contact and, if `free`, those without a damper."""
    _draw_band(axes, balance)
    if free:
        stable = balance["free_stability"].values == flag("free_stability", "stable")
        _draw_amplitudes(axes, balance, "free_amplitude", stable, ROLES["free_stable"])
        _draw_unstable(axes, balance)
    if has_damper(balance):
        stable = balance["stability"].values == flag("stability", "stable")
        impacting = balance["kind"].values == flag("kind", "impacting")
        role = ROLES["harmonic_balance"]
        _draw_amplitudes(axes, balance, "amplitude", stable & impacting, role)


def _draw_amplitudes(axes, balance, name, chosen, role):
    """Draw the amplitude of the solutions where the mask `chosen` is True."""
    size = np.where(chosen, abs(balance[name].values), np.nan)
    for branch in size.T[np.isfinite(size).any(axis=0)]:
        draw(axes, balance["frequency"].values, branch, **role)


def _draw_band(axes, balance):
    """Shade the suppression band, if it exists."""
    if "band_status" in balance and balance["band_status"] == flag("band_status", "found"):
        axes.axvspan(*balance["edge_frequency"].values, **ROLES["band"])


def _draw_unstable(axes, balance):
    """Draw the unstable solutions of harmonic balance without a damper, up to the folds.

    Along the response curve the phase increases, so the solutions are sorted by phase.
    """
    phase = balance["free_phase"].values
    order = np.argsort(phase, axis=None)[: np.isfinite(phase).sum()]
    frequency, amplitude, stability = (
        np.broadcast_to(balance[name].values.T, phase.T.shape).T.ravel()[order]
        for name in ("frequency", "free_amplitude", "free_stability")
    )
    unstable = stability == flag("free_stability", "unstable")
    shown = np.convolve(unstable, [1, 1, 1], "same") > 0
    draw(axes, frequency, np.where(shown, amplitude, np.nan), **ROLES["free_unstable"])


def _draw_motions(axes, motions):
    """Draw motions from random starts: settled ones joined along branches, others as points."""
    period = motions["period"].values
    if not has_damper(motions):
        settled = is_settled(motions)
        _draw_settled(axes, motions, settled & (period == 1), ROLES["free_stable"])
        _draw_settled(axes, motions, settled & (period != 1), ROLES["free_higher"])
        _draw_unsettled(axes, motions, FREE)
        return
    colliding = is_settled(motions) & (motions["contacts"].values > 0)
    third = (period > 1) & (period % 3 == 0)
    for name, chosen in (
        ("period_1", period == 1),
        ("higher_period", (period > 1) & ~third),
        ("subharmonic_damped", third),
    ):
        _draw_settled(axes, motions, colliding & chosen, ROLES[name] | JOINED)
    _draw_unsettled(axes, motions, DAMPED)


def _draw_settled(axes, motions, chosen, role):
    """Draw lines through the chosen motions of each branch."""
    for frequency, size in branch_lines(motions, chosen):
        draw(axes, frequency, size, **role)


def _draw_unsettled(axes, motions, roles):
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
            size = motions["maximum_displacement"].values[row, column]
            draw(axes, motions["frequency"].values[row], size, **role)


def _draw_steady(axes, motions):
    """Draw steady motions, the settled ones joined in the order in which they are given."""
    frequency, size, outcome = (
        np.concatenate([np.ravel(each[name]) for each in motions])
        for name in ("frequency", "maximum_displacement", "outcome")
    )
    settled = outcome == flag("outcome", "settled")
    still = outcome == flag("outcome", "non_colliding")
    if settled.any():
        axes.plot(frequency, np.where(settled, size, np.nan), **SETTLED)
    for chosen, role in ((still, STILL), (~settled & ~still, UNSETTLED)):
        if chosen.any():
            axes.plot(frequency[chosen], size[chosen], **role)


def _frequency_label(given):
    """Return the label of the frequency axis, with the units of the first dataset that has it."""
    for each in given:
        if "frequency" in each.coords:
            return axis_label(each["frequency"])
        if "followed_value" in each:
            return followed_label(each)
    return axis_label(given[0]["edge_frequency"], "forcing frequency")


def _size_label(given):
    """Return the label of displacements, or of amplitudes if only amplitudes are drawn."""
    for name in ("maximum_displacement", "orbit_displacement"):
        for each in given:
            if name in each:
                return axis_label(each[name])
    units = next((each["free_amplitude"].units for each in given if "free_amplitude" in each), "1")
    words = "Amplitude of the primary mass"
    return f"{words}, $|a|$" if units == "1" else f"{words} ({units})"
