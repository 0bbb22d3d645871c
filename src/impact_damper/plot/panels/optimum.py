"""Largest displacement against clearance, with the optimum: figures 6, 7 and 11.

Figure kind `optimum`. The quiet motion is the small motion for which a damper is designed.
Equations (7) of the paper are harmonic balance with one harmonic.
"""

import numpy as np

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.panels.style import (
    BLACK,
    GREY,
    ROLES,
    axis_label,
    curve,
    figure,
    legend,
    parameter_label,
    points,
    style,
)

CAPTION = """
Largest displacement of the quiet motion against clearance. Points: exact motion. Lines: amplitude
of the first harmonic by harmonic balance (7); with inelastic contact the lines only join the
points. Star: smallest displacement of the exact orbit. Bar: range of clearances in which the
displacement is at most 10 % larger. Larger coexisting motions are not drawn.
"""

BALANCE = "lines: $|a|$ by equations (7)"
# Parameters named in the legend, if they differ between the curves.
VARIED = ("damping", "frequency", "restitution", "mass_ratio")


@style()
def draw_optimum(*, optimum):
    """Draw the largest displacement of the quiet motion against clearance, all sweeps in one plot.

    Parameters
    ----------
    optimum : list of xarray.Dataset
        Datasets of the stage optimum.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 4.4)
    axes = drawn.subplots()
    sweeps_panel(axes, optimum)
    legend(drawn, 3)
    return drawn


def sweeps_panel(axes, sweeps):
    """Draw the displacement of the quiet motion against clearance: points, lines of (7), optima."""
    elastic = [np.isfinite(sweep["analytical_optimum"].item()) for sweep in sweeps]
    star = ROLES["optimum"] | {"markeredgewidth": 0.5, "markersize": 7.5}
    # Legend: each curve with its own line; entries that hold for all curves are grey.
    for index, words in enumerate(titles(sweeps)):
        axes.plot([], [], **points(index) | curve(index), label=words)
    if any(elastic):
        axes.plot([], [], color=GREY, label=BALANCE)
    axes.plot([], [], **star | {"color": GREY})
    axes.plot([], [], **ROLES["near_optimum"])
    for index, (sweep, balanced) in enumerate(zip(sweeps, elastic, strict=True)):
        color = {"color": curve(index)["color"], "label": None}
        axes.plot(sweep["clearance"], sweep["quiet_displacement"], **points(index))
        axes.plot(*line_of(sweep, balanced), **curve(index))
        best = sweep["optimum_clearance"], sweep["optimum_displacement"]
        near = ROLES["near_optimum"] | color
        axes.plot(sweep["near_clearance"], best[1].values.repeat(2), **near)
        filled = {"markerfacecolor": color["color"], "markeredgecolor": BLACK}
        axes.plot(*best, **star | color | filled)
    first = sweeps[0]
    axes.set(
        xlabel=axis_label(first["clearance"]),
        ylabel=axis_label(first["quiet_displacement"]),
    )
    axes.set_ylim(bottom=0)


def line_of(sweep, elastic):
    """Return clearances and ordinates of the line of a sweep, its optimum inserted.

    The ordinates are the amplitude |a| by (7), which holds for elastic contact only; with inelastic
    contact they are max |Z1| of the exact motion.
    """
    if elastic:
        names, least = ("analytical_amplitude", "analytical_optimum"), 0
    else:
        names = "quiet_displacement", "optimum_clearance"
        least = sweep["optimum_displacement"]
    clearance, values, best = (sweep[name].values for name in ("clearance", *names))
    place = np.searchsorted(clearance, best)
    return np.insert(clearance, place, best), np.insert(values, place, least)


def titles(sweeps):
    """Return legend texts: the mass ratio, and all parameters that differ between sweeps."""
    parameters = [parameters_of(sweep) for sweep in sweeps]
    names = [
        name
        for name in VARIED
        if name == "mass_ratio" or len({values[name] for values in parameters}) > 1
    ]
    return [parameter_label(values, *names) for values in parameters]
