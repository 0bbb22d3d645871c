"""Displacement against clearance, with the optimum."""

import numpy as np

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.sheets import datasets_in, sheet
from impact_damper.plot.style import (
    BLACK,
    CURVES,
    GREY,
    ROLES,
    axis_label,
    curve,
    parameter_label,
    points,
)

BALANCE = "lines: $|a|$ by equations (7)"
STAR = ROLES["optimum"] | {"markeredgewidth": 0.5, "markersize": 7.5}
# Parameters that the legend names if they differ between the curves.
VARIED = ("damping", "frequency", "restitution", "mass_ratio")


def sweep(data, axes=None):
    """Draw the largest displacement of the quiet motion against clearance, and its minimum.

    Points are the exact motion. The lines are the amplitude by harmonic balance; with inelastic
    contact, and for a machine, they join the points.

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
    if len(sweeps) > len(CURVES):
        raise TypeError(f"data = {len(sweeps)} datasets: must be at most {len(CURVES)}")
    balanced = [bool(np.isfinite(each["analytical_optimum"])) for each in sweeps]
    with sheet(axes) as (axes,):
        # Legend: each curve with its own line; entries that hold for all curves are grey.
        for index, words in enumerate(_titles(sweeps)):
            axes.plot([], [], **points(index) | curve(index), label=words)
        if any(balanced):
            axes.plot([], [], color=GREY, label=BALANCE)
        axes.plot([], [], **STAR | {"color": GREY})
        axes.plot([], [], **ROLES["near_optimum"])
        for index, (each, by_balance) in enumerate(zip(sweeps, balanced, strict=True)):
            _draw_sweep(axes, each, by_balance, index)
        axes.set(
            xlabel=axis_label(sweeps[0]["clearance"]),
            ylabel=axis_label(sweeps[0]["quiet_displacement"]),
        )
        axes.set_ylim(bottom=0)
    return axes


def _draw_sweep(axes, sweep, by_balance, index):
    """Draw a sweep: points, line, optimum, and the range of clearances near it."""
    color = {"color": curve(index)["color"], "label": None}
    axes.plot(sweep["clearance"], sweep["quiet_displacement"], **points(index))
    axes.plot(*_line_of(sweep, by_balance), **curve(index))
    near = sweep["near_clearance"], sweep["optimum_displacement"].values.repeat(2)
    axes.plot(*near, **ROLES["near_optimum"] | color)
    filled = {"markerfacecolor": color["color"], "markeredgecolor": BLACK}
    axes.plot(sweep["optimum_clearance"], sweep["optimum_displacement"], **STAR | color | filled)


def _line_of(sweep, by_balance):
    """Return clearances and ordinates of the line of a sweep, its optimum inserted."""
    if by_balance:
        names, least = ("analytical_amplitude", "analytical_optimum"), 0
    else:
        names = "quiet_displacement", "optimum_clearance"
        least = sweep["optimum_displacement"]
    clearance, values, best = (sweep[name].values for name in ("clearance", *names))
    place = np.searchsorted(clearance, best)
    return np.insert(clearance, place, best), np.insert(values, place, least)


def _titles(sweeps):
    """Return legend texts: the mass ratio, and all parameters that differ between sweeps."""
    parameters = [parameters_of(sweep) for sweep in sweeps]
    names = [
        name
        for name in VARIED
        if name == "mass_ratio" or len({values[name] for values in parameters}) > 1
    ]
    return [parameter_label(values, *names) for values in parameters]
