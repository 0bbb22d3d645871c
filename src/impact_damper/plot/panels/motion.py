"""Phase plots of steady motions (paper: figure 4; figure kind `motion`)."""

import numpy as np

from impact_damper.plot.panels.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    axis_label,
    figure,
    legend,
    letter_panels,
    style,
)

CAPTION = """
Velocity against displacement of the primary mass during one period of the motion. Thick: contact
with a wall. A contact is short and reverses the velocity at nearly constant displacement, so the
motion differs strongly from the single harmonic of harmonic balance, equations (7).
"""

WALLS = {
    1: {"label": "contact, $Z_2 \\geq d_0$", "color": BLUE, "solid_capstyle": "butt"},
    -1: {"label": "contact, $Z_2 \\leq -d_0$", "color": ORANGE, "linestyle": (0, (1.2, 0.5))},
}


@style()
def draw_motion(*, motion):
    """Draw velocity against displacement and mark the contacts, one panel for each motion.

    Parameters
    ----------
    motion : list of xarray.Dataset
        Datasets of the stage motion.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("single" if len(motion) == 1 else "double", 3.2)
    panels = drawn.subplots(1, len(motion), squeeze=False)[0]
    for axes, traced in zip(panels, motion, strict=True):
        phase_panel(axes, traced)
    if len(panels) > 1:
        letter_panels(panels)
    legend(drawn, 2)
    return drawn


def phase_panel(axes, traced):
    """Draw velocity against displacement of the primary mass, thick in contact."""
    axes.plot(traced["displacement"], traced["velocity"], color=BLACK, linewidth=0.8)
    for wall, look in WALLS.items():
        velocity = np.where(in_contact(traced, wall), traced["velocity"], np.nan)
        axes.plot(traced["displacement"], velocity, linewidth=3, **look)
    axes.set(xlabel=axis_label(traced["displacement"]), ylabel=axis_label(traced["velocity"]))


def time_panel(axes, traced):
    """Draw Z1 and Z2 against time; the line of Z2 is thick during contacts."""
    axes.plot(traced["time"], traced["displacement"], color=BLACK, label="primary mass, $Z_1$")
    relative = traced["relative_displacement"]
    if len(traced["contact_wall"]):
        words = "relative to the loose mass, $Z_2$"
        axes.plot(traced["time"], relative, color=GREY, linewidth=0.8, label=words)
    for wall, look in WALLS.items():
        chosen = in_contact(traced, wall)
        if chosen.any():
            axes.plot(traced["time"], np.where(chosen, relative, np.nan), linewidth=3, **look)
    units = traced["displacement"].attrs["units"]
    axes.set(
        xlabel=axis_label(traced["time"]),
        ylabel="Displacement" if units == "1" else f"Displacement ({units})",
    )


def in_contact(traced, wall):
    """Return a mask of the times in contact with a wall (1 or -1), shape (time,).

    A contact whose end is not recorded lasts to the last time.
    """
    time = traced["time"].values[:, None]
    chosen = traced["contact_wall"].values == wall
    begin = traced["contact_begin"].values[chosen]
    end = np.nan_to_num(traced["contact_end"].values[chosen], nan=np.inf)
    return np.any((begin <= time) & (time <= end), axis=1)
