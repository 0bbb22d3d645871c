"""Displacement against forcing frequency: motions, harmonic balance and exact orbits."""

import numpy as np

from impact_damper.data.datasets import flag, has_damper, is_settled, parameters_of
from impact_damper.plot import style
from impact_damper.plot.branches import draw_free_orbits, followed_label, runs
from impact_damper.plot.sheets import datasets_in, sheet

# Look of the line that joins the settled motions of a branch.
JOINED = {"linestyle": "-", "linewidth": 0.5}
# Looks of motions that have not settled, by outcome. DAMPED: with a damper. FREE: without.
DAMPED = {name: style.ROLES[name] for name in ("chaotic", "chaotic_transient", "quasi_periodic")}
DAMPED |= {name: style.ROLES["non_colliding"] for name in ("non_colliding", "drifting")}
DAMPED["unresolved"] = style.ROLES["unresolved"]
FREE = {
    "chaotic": style.ROLES["chaotic"] | {"label": "free, chaotic"},
    "unresolved": style.ROLES["unresolved"] | {"label": "free, unresolved"},
}
# Looks of motions from `steady_motion`.
SETTLED = style.ROLES["period_1"] | JOINED | {"label": "settled"}
STILL = style.ROLES["non_colliding"] | {"label": "no contact"}
UNSETTLED = style.ROLES["chaotic"] | {"label": "not settled"}
# Variable with displacements -> label of the axis, or None for the variable's own description.
SIZES = {
    "maximum_displacement": None,
    "orbit_displacement": None,
    "free_amplitude": "amplitude of the primary mass",
}


def response(data, axes=None):
    """Draw displacement against forcing frequency.

    If motions with a damper are given (results of `frequency_response` or
    `subharmonic_suppression`), stable orbits of `orbit_branches` with a damper are not drawn.

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
        _label(axes, given)
        axes.set_ylim(bottom=0)
    return axes


def _kind(data):
    if "followed_value" in data and parameters_of(data).get("parameter") == "frequency":
        return "orbits"
    if "free_amplitude" in data:
        return "balance"
    if "maximum_displacement" in data and "frequency" in data.coords:
        kinds = {("frequency", "motion"): "motions", (): "steady", ("frequency",): "steady"}
        return kinds.get(data["maximum_displacement"].dims, "")
    return ""


def _draw_orbits(axes, orbits, stable):
    if not has_damper(orbits):
        draw_free_orbits(axes, orbits)
        return
    for value, size, is_stable in runs(orbits, lambda period: period == 1):
        if not is_stable:
            style.draw(axes, value, size, **style.ROLES["unstable_orbit"])
    for value, size, is_stable in runs(orbits, lambda period: stable):
        if is_stable:
            style.draw(axes, value, size, color=style.BLUE, label="stable orbit")


def _draw_balance(axes, balance, free):
    if "band_status" in balance and balance["band_status"] == flag("band_status", "found"):
        axes.axvspan(*balance["edge_frequency"].values, **style.ROLES["band"])
    if free:
        stable = balance["free_stability"] == flag("free_stability", "stable")
        _draw_solutions(axes, balance["free_amplitude"].where(stable), "free_stable")
        _draw_unstable(axes, balance)
    if has_damper(balance):
        stable = balance["stability"] == flag("stability", "stable")
        stable &= balance["kind"] == flag("kind", "impacting")
        _draw_solutions(axes, balance["amplitude"].where(stable), "harmonic_balance")


def _draw_solutions(axes, amplitude, role):
    for branch in np.abs(amplitude.values).T:
        if np.isfinite(branch).any():
            style.draw(axes, amplitude["frequency"], branch, **style.ROLES[role])


def _draw_unstable(axes, balance):
    phase = balance["free_phase"].values
    order = np.argsort(phase, axis=None)[: np.isfinite(phase).sum()]
    frequency, amplitude, stability = (
        np.broadcast_to(balance[name].values.T, phase.T.shape).T.ravel()[order]
        for name in ("frequency", "free_amplitude", "free_stability")
    )
    unstable = stability == flag("free_stability", "unstable")
    shown = np.convolve(unstable, [1, 1, 1], "same") > 0
    style.draw(axes, frequency, np.where(shown, amplitude, np.nan), **style.ROLES["free_unstable"])


def _draw_motions(axes, motions):
    period, settled = motions["period"].values, is_settled(motions)
    if has_damper(motions):
        settled = settled & (motions["contacts"].values > 0)
        third = (period > 1) & (period % 3 == 0)
        masks = {
            "period_1": period == 1,
            "higher_period": (period > 1) & ~third,
            "subharmonic_damped": third,
        }
        look, others = JOINED, DAMPED
    else:
        masks, look, others = {"free_stable": period == 1, "free_higher": period != 1}, {}, FREE
    for name, chosen in masks.items():
        for frequency, size in _branch_lines(motions, settled & chosen):
            style.draw(axes, frequency, size, **style.ROLES[name] | look)
    _draw_unsettled(axes, motions, others)


def _branch_lines(motions, chosen):
    branch, period = motions["branch"].values, motions["period"].values
    names = ("end_branch", "end_direction", "end_value", "end_displacement")
    ends = list(zip(*(motions[name].values for name in names), strict=True))
    for number, cycles in sorted(set(zip(branch[chosen], period[chosen], strict=True))):
        here = chosen & (branch == number) & (period == cycles)
        x = motions["frequency"].values
        y = np.fmax.reduce(np.where(here, motions["maximum_displacement"].values, np.nan), axis=1)
        for _, direction, value, size in (end for end in ends if end[0] == number):
            place = np.searchsorted(x, value, "right" if direction > 0 else "left")
            before = place - (direction > 0)
            if 0 <= before < len(x) and np.isfinite(y[before]):
                x, y = np.insert(x, place, value), np.insert(y, place, size)
        yield x, y


def _draw_unsettled(axes, motions, looks):
    for status, look in looks.items():
        outcome = "chaotic" if status == "chaotic_transient" else status
        chosen = motions["outcome"].values == flag("outcome", outcome)
        if outcome == "chaotic" and "chaotic_transient" in looks:
            ended = motions["life_ends"].values > 0 if "life_ends" in motions else False
            chosen &= np.equal(ended, status == "chaotic_transient")
        row, column = chosen.nonzero()
        if len(row):
            size = motions["maximum_displacement"].values[row, column]
            style.draw(axes, motions["frequency"].values[row], size, **look)


def _draw_steady(axes, motions):
    frequency, size, outcome = (
        np.concatenate([np.ravel(each[name]) for each in motions])
        for name in ("frequency", "maximum_displacement", "outcome")
    )
    settled = outcome == flag("outcome", "settled")
    still = outcome == flag("outcome", "non_colliding")
    for chosen, look in ((settled, SETTLED), (still, STILL), (~settled & ~still, UNSETTLED)):
        if chosen.any():
            axes.plot(frequency, np.where(chosen, size, np.nan), **look)


def _label(axes, given):
    first = given[0]
    swept = "frequency" in first.coords
    axes.set_xlabel(style.axis_label(first["frequency"]) if swept else followed_label(first))
    name, each = next((name, each) for name in SIZES for each in given if name in each)
    axes.set_ylabel(style.axis_label(each[name], SIZES[name]))
