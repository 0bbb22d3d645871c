"""Tolerances at which integrators find the right motion (figure kind `method_verdicts`).

Each verdict is on one test case, called scene in the code: a start near a periodic orbit.
"""

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from chatterjee1995.methods.methods import METHODS, name_and_mode, title_with_mode
from chatterjee1995.methods.words import CASES
from impact_damper.data.variables import VARIABLES
from impact_damper.plot.panels.maps import edges, flags
from impact_damper.plot.panels.style import (
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

CAPTION = """
Whether an integrator, started near a periodic orbit, ends on the right motion, known from Floquet
multipliers. The table of verdicts lists the test cases. White: not run. Methods with fixed steps,
and those marked "kink", do not locate contacts.
"""

# Verdict -> colour and legend text.
ROLES = {
    "not_run": (WHITE, "not run"),
    "right": (PALE_SKY, "right"),
    "not_settled": (ORANGE, "motion does not settle"),
    "wrong_period": (PURPLE, "wrong period"),
    "wrong_branch": (VERMILION, "wrong branch"),
    "stays_wrongly": (BLUE, "stays on an unstable orbit"),
    "failed": (BLACK, "fails"),
}


@style()
def draw_method_verdicts(*, method_verdicts):
    """Draw the verdict on each test case against tolerance or steps, one panel for each method.

    Parameters
    ----------
    method_verdicts : list of xarray.Dataset
        One dataset of the stage method_verdicts.

    Returns
    -------
    matplotlib.figure.Figure
    """
    (data,) = method_verdicts
    labels = data["verdict_method"].values
    rows = -(-len(labels) // 4)
    drawn = figure("double", 0.8 + 2.0 * rows)
    panels = drawn.subplots(rows, 4, sharey=True).ravel()
    for axes in panels[len(labels) :]:
        axes.set_axis_off()
    meanings = VARIABLES["verdict"].flags
    scenes = np.arange(data.sizes["scene"] + 1)
    for axes, name in zip(panels, labels, strict=False):
        fixed = METHODS[name_and_mode(name)[0]].fixed
        x = data["verdict_steps"].values if fixed else data["method_tolerance"].values
        cells = data["verdict"].sel(verdict_method=name).values
        run = (cells != meanings["not_run"]).any(axis=0)
        if not run.any():
            run[:] = True
        flags(axes, edges(x[run]), scenes, cells[:, run], meanings, ROLES)
        axes.set_xscale("log")
        if not fixed:
            axes.invert_xaxis()
        axes.xaxis.set_major_locator(LogLocator(numticks=4))
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xlabel("Steps a cycle" if fixed else axis_label(data["method_tolerance"]))
        axes.set_yticks(
            scenes[:-1] + 0.5, [CASES.get(str(name), str(name)) for name in data["scene"].values]
        )
        axes.tick_params(which="both", top=False, right=False, left=False)
        for scene in scenes[1:-1]:
            axes.axhline(scene, color=GREY, linewidth=0.3)
        axes.set_title(title_with_mode(name), loc="right", fontsize=7.5)
    panels[0].invert_yaxis()
    letter_panels(panels[: len(labels)])
    legend(drawn, 4)
    return drawn
