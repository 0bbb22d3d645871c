"""Largest displacement against clearance, with its optimum: figures 6, 7 and 11."""

import numpy as np

from impact_damper.data.datasets import parameters_of
from impact_damper.figures.style import ROLES, axis_label, curve, figure, legend, points, style

SYMBOLS = {"damping": "h", "frequency": r"\Omega", "restitution": "e", "mass_ratio": "r_m"}


@style()
def draw_optimum(*, optimum):
    """Largest displacement of the quiet motion against clearance, all curves in one plot.

    Parameters
    ----------
    optimum : list of xarray.Dataset
        Of `clearance_sweep`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 4.4)
    axes = drawn.subplots()
    elastic = [np.isfinite(sweep["analytical_optimum"].item()) for sweep in optimum]
    for index, (sweep, words) in enumerate(zip(optimum, titles(optimum), strict=True)):
        axes.plot(sweep["clearance"], sweep["quiet_displacement"], **points(index), label=words)
        axes.plot(*line_of(sweep, elastic[index]), **curve(index))
    for sweep in optimum:
        best = sweep["optimum_clearance"], sweep["optimum_displacement"]
        axes.plot(*best, **ROLES["optimum"])
        axes.plot(sweep["near_clearance"], best[1].values.repeat(2), **ROLES["near_optimum"])
    first = optimum[0]
    label = axis_label(first["quiet_displacement"])
    axes.set(
        xlabel=axis_label(first["clearance"]),
        ylabel=f"{label} (points), $|a|$ (lines)" if any(elastic) else label,
    )
    axes.set_ylim(bottom=0)
    legend(drawn, 3)
    return drawn


def line_of(sweep, elastic):
    """Clearance and |a| of equations (7), or the simulated displacement, with its optimum."""
    if elastic:
        names, least = ("analytical_amplitude", "analytical_optimum"), 0
    else:
        names = "quiet_displacement", "optimum_clearance"
        least = sweep["optimum_displacement"]
    clearance, values, best = (sweep[name].values for name in ("clearance", *names))
    place = np.searchsorted(clearance, best)
    return np.insert(clearance, place, best), np.insert(values, place, least)


def titles(sweeps):
    """What tells the curves apart: those of the parameters that are not the same in all."""
    parameters = [parameters_of(sweep) for sweep in sweeps]
    differing = [
        name
        for name in SYMBOLS
        if name == "mass_ratio" or len({given[name] for given in parameters}) > 1
    ]
    return [
        ", ".join(f"${SYMBOLS[name]} = {given[name]:g}$" for name in differing)
        for given in parameters
    ]
