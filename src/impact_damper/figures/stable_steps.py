"""Accuracy of the quiet motion by fixed-step methods, against stiffness and step.

Figure kind `stable_steps`.
"""

import math

import numpy as np
from matplotlib.ticker import NullFormatter

from impact_damper.data.datasets import parameters_of
from impact_damper.data.variables import VARIABLES
from impact_damper.figures.maps import edges, flags
from impact_damper.figures.style import (
    BLACK,
    GREY,
    ORANGE,
    PALE_SKY,
    SKY,
    VERMILION,
    WHITE,
    axis_label,
    figure,
    legend,
    letter_panels,
    style,
)
from impact_damper.rivals.methods import METHODS

CAPTION = """
Each cell is a run that starts on the exact quiet orbit for this stiffness and integrates through
the kinks of the force with equal steps, an integer number of them per forcing period. omega_c is
the natural frequency of an undamped contact, which lasts half a natural period. Colour: largest
deviation of max abs(Z1) from the exact value in any period. Solid lines: largest step such that
this and all smaller steps tested, at least four, keep the accuracy. Dashed: linear stability limit
of the method. Dotted: a constant number of steps per period. White: not run, since more steps than
allowed. The paper used one stiffness, 2000, and has no such figure.
"""

ROLES = {
    "no_orbit": (WHITE, "no quiet motion"),
    "not_run": (WHITE, "not run"),
    "within_1_percent": (PALE_SKY, r"max $|Z_1|$ within 1 %"),
    "within_10_percent": (SKY, "within 10 %"),
    "off": (ORANGE, "off by more"),
    "escaped": (VERMILION, "escaped to a large motion"),
    "diverged": (BLACK, "diverged"),
}


@style()
def draw_stable_steps(*, stable_steps):
    """Draw the verdicts against stiffness and step, a row of panels for each damper.

    Parameters
    ----------
    stable_steps : list of xarray.Dataset
        Datasets of the stage stable_steps.

    Returns
    -------
    matplotlib.figure.Figure
    """
    rows = len(stable_steps)
    drawn = figure("double", 0.9 + 2.1 * rows)
    columns = stable_steps[0].sizes["fixed_method"]
    panels = drawn.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    meanings = VARIABLES["step_verdict"].flags
    for row, data in zip(panels, stable_steps, strict=True):
        stiffness, scaled = data["contact_stiffness"].values, data["scaled_step"].values
        for axes, name in zip(row, data["fixed_method"].values, strict=True):
            of = data.sel(fixed_method=name)
            x, y = edges(stiffness), edges(scaled)
            flags(axes, x, y, of["step_verdict"].values.T, meanings, ROLES)
            contact = data["contact_frequency"].values
            for accuracy, marker in zip(data["accuracy"].values, "os", strict=True):
                axes.plot(
                    stiffness,
                    of["stable_step"].sel(accuracy=accuracy).values * contact,
                    color=BLACK,
                    marker=marker,
                    linewidth=0.8,
                    markersize=3,
                    markerfacecolor=WHITE,
                    label=f"all smaller steps within {100 * accuracy:.0f} %",
                )
            if of["linear_limit"] > 0:
                axes.axhline(of["linear_limit"], color=WHITE, linewidth=2.4)
                axes.axhline(
                    of["linear_limit"], color=BLACK, linestyle="--", label="linear stability"
                )
            period = 2 * math.pi / parameters_of(data)["frequency"]
            for steps in 10.0 ** np.arange(2, 5):
                axes.plot(
                    stiffness, period / steps * contact, color=GREY, linestyle=":", linewidth=0.9
                )
            axes.set(xscale="log", yscale="log", xlim=(x[0], x[-1]), ylim=(y.min(), y.max()))
            axes.yaxis.set_minor_formatter(NullFormatter())
            axes.set_title(METHODS[name].title, fontsize=8)
        row[0].set_ylabel(axis_label(data["scaled_step"]))
        made = parameters_of(data)
        row[-1].yaxis.set_label_position("right")
        row[-1].set_ylabel(
            f"$r_m$ = {made['mass_ratio']:g}, $d_0$ = {made['clearance']:g}, "
            f"$e$ = {made['restitution']:g}",
            fontsize=8,
        )
    for axes in panels[-1]:
        axes.set_xlabel(r"Stiffness of the contact, $r_1$", fontsize=8)
    panels[0, 0].plot(
        [], [], color=GREY, linestyle=":", label=r"$10^2$, $10^3$, $10^4$ steps a period"
    )
    letter_panels(panels.ravel())
    legend(drawn, 3)
    return drawn
