"""Verdicts of each method against the truth, by tolerance."""

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from impact_damper.data.variables import VARIABLES
from impact_damper.figures.maps import edges, flags
from impact_damper.figures.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    PALE_SKY,
    PURPLE,
    VERMILION,
    WHITE,
    axis_label,
    figure,
    legend,
    letter_panels,
    style,
)

NAMES = {
    "taylor": "Taylor series, events",
    "heun": "Heun",
    "verlet": "velocity Verlet",
    "runge_kutta_4": "Runge-Kutta 4",
    "merson": "Merson, kink",
    "merson_located": "Merson, located",
    "LSODA": "LSODA, kink",
    "DOP853_located": "DOP853, events",
}
FIXED = ("heun", "verlet", "runge_kutta_4")
ROLES = {
    "not_run": (WHITE, "not run"),
    "right": (PALE_SKY, "right"),
    "not_settled": (ORANGE, "does not settle"),
    "wrong_period": (PURPLE, "wrong period"),
    "wrong_branch": (VERMILION, "wrong branch"),
    "stays_wrongly": (BLUE, "stays where it must leave"),
    "failed": (BLACK, "fails"),
}


@style()
def draw_verdicts(*, verdicts):
    """Map of verdicts, a panel for each method: scenes by tolerance or steps.

    Parameters
    ----------
    verdicts : list of xarray.Dataset
        One, of `verdicts.verdicts`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    (data,) = verdicts
    drawn = figure("double", 4.8)
    panels = drawn.subplots(2, 4, sharey=True).ravel()
    meanings = VARIABLES["verdict"].flags
    scenes = np.arange(data.sizes["scene"] + 1)
    for axes, name in zip(panels, data["verdict_method"].values, strict=True):
        fixed = name in FIXED
        x = data["verdict_steps"].values if fixed else data["method_tolerance"].values
        cells = data["verdict"].sel(verdict_method=name).values
        run = (cells != meanings["not_run"]).any(axis=0)
        flags(axes, edges(x[run]), scenes, cells[:, run], meanings, ROLES)
        axes.set_xscale("log")
        if not fixed:
            axes.invert_xaxis()
        axes.xaxis.set_major_locator(LogLocator(numticks=4))
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xlabel("Steps a forcing period" if fixed else axis_label(data["method_tolerance"]))
        axes.set_yticks(
            scenes[:-1] + 0.5, [str(scene).replace("_", " ") for scene in data["scene"].values]
        )
        axes.tick_params(which="both", top=False, right=False, left=False)
        for scene in scenes[1:-1]:
            axes.axhline(scene, color=GREY, linewidth=0.3)
        axes.set_title(NAMES[name], loc="right", fontsize=7.5)
    panels[0].invert_yaxis()
    letter_panels(panels)
    legend(drawn, 4)
    return drawn
