"""Displacement against clearance, and the optimum clearance."""

import json

import numpy as np

from impact_damper.data.datasets import parameters_of
from impact_damper.model.units import Scales
from impact_damper.plot import style
from impact_damper.plot.sheets import datasets_in, sheet

OPTIMUM = style.markers(
    "smallest, on the exact orbit",
    style.BLACK,
    "*",
    markerfacecolor=style.BLACK,
    markersize=5.5,
    zorder=3,
)
STAR = OPTIMUM | {"markeredgewidth": 0.5, "markersize": 7.5}
NEAR = style.line("at most 10 % larger", style.GREY, marker="|", linewidth=0.6, zorder=3)
BALANCE = style.line("lines: $|a|$ by equations (7)", style.GREY)
# Parameters in the legend: `mass_ratio` always, another parameter if it differs between curves.
VARIED = ("damping", "frequency", "restitution", "mass_ratio")


def sweep(data, axes=None):
    """Draw the largest displacement of the quiet orbit against clearance, and mark the minimum.

    Points show the exact orbit. For elastic contact lines show the amplitude by harmonic balance.
    For inelastic contact harmonic balance gives no optimum. Lines then join the points.

    Parameters
    ----------
    data : xarray.Dataset or list of xarray.Dataset
        Up to five results of `clearance_sweep`.
    axes : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import impact_damper as idm
    >>> found = idm.clearance_sweep(
    ...     idm.Oscillator(0.215), {"mass_ratio": 0.12}, 2.0, [2.2, 2.3, 2.4], starts=4
    ... )
    >>> axes = idm.plot.sweep(found)
    """
    sweeps = datasets_in(data, lambda each: "quiet_displacement" in each, "clearance_sweep")
    if len(sweeps) > len(style.CURVES):
        raise TypeError(f"data = {len(sweeps)} datasets: must be at most {len(style.CURVES)}")
    with sheet(axes) as (axes,):
        # The legend has one coloured entry for each sweep. Grey entries explain shared markers.
        for index, words in enumerate(_titles(sweeps)):
            axes.plot([], [], **style.points(index) | style.curve(index), label=words)
        if any(map(_balanced, sweeps)):
            axes.plot([], [], **BALANCE)
        axes.plot([], [], **STAR | {"color": style.GREY})
        axes.plot([], [], **NEAR)
        for index, each in enumerate(sweeps):
            _draw_sweep(axes, each, index)
        axes.set_xlabel(style.axis_label(sweeps[0]["clearance"]))
        axes.set_ylabel(style.axis_label(sweeps[0]["quiet_displacement"]))
        axes.set_ylim(bottom=0)
    return axes


def _balanced(sweep):
    return bool(np.isfinite(sweep["analytical_optimum"]))


def _draw_sweep(axes, sweep, index):
    clearance, size = sweep["clearance"].values, sweep["quiet_displacement"].values
    best, least = float(sweep["optimum_clearance"]), float(sweep["optimum_displacement"])
    color = {"color": style.curve(index)["color"], "label": None}
    axes.plot(clearance, size, **style.points(index))
    if _balanced(sweep):
        at, values, lowest = float(sweep["analytical_optimum"]), sweep["analytical_amplitude"], 0
    else:
        at, values, lowest = best, size, least
    place = np.searchsorted(clearance, at)
    line = np.insert(clearance, place, at), np.insert(values, place, lowest)
    axes.plot(*line, **style.curve(index))
    axes.plot(sweep["near_clearance"], [least, least], **NEAR | color)
    filled = {"markerfacecolor": color["color"], "markeredgecolor": style.BLACK}
    axes.plot(best, least, **STAR | color | filled)


def _titles(sweeps):
    *others, masses = zip(*map(_parameters, sweeps), strict=True)
    different = [texts for texts in others if len(set(texts)) > 1]
    return [", ".join(words) for words in zip(*different, masses, strict=True)]


def _parameters(sweep):
    values = parameters_of(sweep)
    if "machine" not in sweep.attrs:
        return [style.parameter_label(values, name) for name in VARIED]
    machine, scales = (json.loads(sweep.attrs[name]) for name in ("machine", "scales"))
    return [
        f"damping ratio {machine['damping_ratio']:.4g}",
        f"{Scales(**scales, si=True).to_si(values['frequency'], 'frequency'):.4g} Hz",
        f"restitution {values['restitution']:.4g}",
        f"loose mass {values['mass_ratio'] * machine['mass']:.4g} kg",
    ]
