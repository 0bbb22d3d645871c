"""Plots over a parameter: motions, harmonic balance, exact orbits, and shares of random starts.

A start is an initial state; the share of a motion is the fraction of starts that lead to it.
"""

import numpy as np

from impact_damper.data.datasets import flag, has_damper, parameters_of
from impact_damper.model.parameters import SYMBOLS
from impact_damper.plot.drawing import axes_for, dataset_in, datasets_in, key, looks
from impact_damper.plot.panels.branches import draw_orbits, runs
from impact_damper.plot.panels.harmonic_balance import draw_band, draw_free
from impact_damper.plot.panels.response import response_panel
from impact_damper.plot.panels.shares import shares_panel
from impact_damper.plot.panels.style import BLUE, ROLES, axis_label, tex

# Look of the settled motions in a sweep of steady motions.
SETTLED = {
    "label": "settled",
    "color": BLUE,
    "marker": "o",
    "markerfacecolor": "none",
    "linewidth": 0.5,
}
# First words of legend labels in the figures of the paper, and clearer words for plots.
PLAIN = {"free": "without damper", "inelastic": "damper with $e < 1$"}


def response(data, *, ax=None):
    """Draw displacement against forcing frequency.

    Parameters
    ----------
    data : xarray.Dataset or list of xarray.Dataset
        Results of `frequency_response`, `subharmonic_suppression`, `steady_motion`,
        `harmonic_balance_response`, `orbit_branch`, `complete_branches` (over frequency) or
        `suppression_band`, with or without a damper, in any combination.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    TypeError
        If `data` or `ax` is of another type.

    Examples
    --------
    >>> import impact_damper as idm
    >>> free = idm.harmonic_balance_response(idm.Oscillator(0.215), None, [1.8, 1.9, 2.0])
    >>> axes = idm.plot.response(free)
    """
    given = datasets_in(
        data,
        lambda each: bool(_kind(each)),
        "frequency_response, subharmonic_suppression, steady_motion, harmonic_balance_response, "
        "suppression_band, orbit_branch or complete_branches (over frequency)",
    )
    parts = {"motions": [], "balance": [], "orbits": [], "steady": [], "bands": []}
    for each in given:
        parts[_kind(each)].append(each)
    with looks(ax):
        (axes,) = axes_for(ax)
        response_panel(axes, parts["motions"], parts["balance"], parts["orbits"], apart=True)
        for balance in parts["balance"]:
            if not has_damper(balance) or not parts["motions"] + parts["orbits"]:
                draw_free(axes, balance)
        for orbits in filter(has_damper, parts["orbits"]):
            _stable_orbits(axes, orbits)
        for band in parts["bands"]:
            draw_band(axes, band)
        _steady(axes, parts["steady"])
        shown = [each for each in given if _kind(each) != "bands"] or given
        axes.set(xlabel=_frequency_label(shown[0]), ylabel=_size_label(shown))
        axes.set_ylim(bottom=0)
        _name_dampers(axes)
        key(axes, 3)
    return axes


def _name_dampers(axes):
    """Replace the first words of legend labels as in `PLAIN`."""
    for artist in axes.get_children():
        words = str(artist.get_label())
        for begin, plain in PLAIN.items():
            if words.startswith(begin):
                artist.set_label(plain + words.removeprefix(begin))


def _kind(data):
    """Return the kind of response that a dataset holds, a key of `parts` in `response`, or ""."""
    if "followed_value" in data and parameters_of(data).get("parameter") == "frequency":
        return "orbits"
    if "free_amplitude" in data:
        return "balance"
    if "band_status" in data:
        return "bands"
    if "maximum_displacement" in data and "frequency" in data.coords:
        return {("frequency", "motion"): "motions", (): "steady", ("frequency",): "steady"}.get(
            data["maximum_displacement"].dims, ""
        )
    return ""


def _stable_orbits(axes, orbits):
    """Draw the stable parts of the branches of orbits."""
    for value, size, stable in runs(orbits, lambda period: True):
        if stable:
            axes.plot(value, size, color=BLUE, label="stable orbit")


def _steady(axes, motions):
    """Draw steady motions, the settled ones joined in the order in which they are given."""
    if not motions:
        return
    frequency, size, outcome = (
        np.concatenate([np.ravel(each[name]) for each in motions])
        for name in ("frequency", "maximum_displacement", "outcome")
    )
    settled = outcome == flag("outcome", "settled")
    still = outcome == flag("outcome", "non_colliding")
    if settled.any():
        axes.plot(frequency, np.where(settled, size, np.nan), **SETTLED)
    for chosen, role, words in (
        (still, "non_colliding", "no contact"),
        (~settled & ~still, "chaotic", "not settled"),
    ):
        if chosen.any():
            axes.plot(frequency[chosen], size[chosen], **ROLES[role] | {"label": words})


def _frequency_label(data):
    """Return the label of the frequency axis, with the units of the dataset."""
    if "frequency" in data.coords:
        return axis_label(data["frequency"])
    values = data["followed_value" if "followed_value" in data else "edge_frequency"]
    units = values.attrs["units"]
    return "Forcing frequency, $\\Omega$" if units == "1" else f"Forcing frequency ({units})"


def _size_label(given):
    """Return the label of displacements, or of amplitudes if only amplitudes are drawn."""
    for name in ("maximum_displacement", "orbit_displacement"):
        for each in given:
            if name in each:
                return axis_label(each[name])
    units = next((each["free_amplitude"].units for each in given if "free_amplitude" in each), "1")
    return "Amplitude, $|a|$" if units == "1" else f"Amplitude ({units})"


def branch(data, *, ax=None):
    """Draw the largest displacement in periodic orbits against the parameter that varies.

    Stable orbits are solid lines, unstable ones dotted lines. Colours distinguish periods;
    markers are bifurcations and changes of contact.

    Parameters
    ----------
    data : xarray.Dataset or list of xarray.Dataset
        Results of `orbit_branch` or `complete_branches`, over the same parameter.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    TypeError
        If `data` or `ax` is of another type.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, start = idm.Oscillator(0.215), (0.006, 0.187, 0.002, -2.408)
    >>> damper = idm.Damper(0.12, 2.0)
    >>> found = idm.orbit_branch(oscillator, damper, 2.0, start, span=(1.9, 2.1))
    >>> axes = idm.plot.branch(found)
    """
    given = datasets_in(
        data, lambda each: "event_kind" in each, "orbit_branch or complete_branches"
    )
    with looks(ax):
        (axes,) = axes_for(ax)
        for each in given:
            draw_orbits(axes, each)
        axes.set(
            xlabel=_followed_label(given[0]), ylabel=axis_label(given[0]["orbit_displacement"])
        )
        key(axes, 3)
    return axes


def _followed_label(data):
    """Return the label of the axis of the parameter that varies along a branch."""
    name, units = parameters_of(data)["parameter"], data["followed_value"].attrs["units"]
    if name == "frequency":
        return _frequency_label(data)
    words = name.replace("_", " ").capitalize()
    if name == "mass_ratio" and units == "kg":
        words = "Mass of the damper"
    return f"{words}, ${tex(SYMBOLS[name])}$" if units == "1" else f"{words} ({units})"


def shares(data, *, ax=None):
    """Draw the shares of random starts that lead to each motion, stacked, with 95 % intervals.

    A motion keeps its colour over all values; further motions of a kind are paler, and
    of period 1 also hatched.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `frequency_response`, `subharmonic_suppression` or `clearance_sweep`.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    TypeError
        If `data` or `ax` is of another type.

    Examples
    --------
    >>> import impact_damper as idm
    >>> bare = idm.frequency_response(idm.Oscillator(0.215), None, [1.9, 2.0], starts=8)
    >>> axes = idm.plot.shares(bare)
    """
    words = "frequency_response, subharmonic_suppression or clearance_sweep"
    found = dataset_in(data, lambda each: "run_outcome" in each, words)
    with looks(ax):
        (axes,) = axes_for(ax)
        shares_panel(axes, found)
        axes.set_ylabel("Share of random starts")
        key(axes, 4)
    return axes
