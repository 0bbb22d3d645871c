"""Displacement against forcing frequency, without and with the damper that was designed.

The motions with the damper were found from random starts (initial states).
"""

import numpy as np

from impact_damper.data.datasets import flag, is_settled
from impact_damper.plot.branches import runs, runs_of
from impact_damper.plot.machine_figures.looks import (
    BARE,
    DAMPED,
    decades,
    limit_line,
    plot_if_any,
    plot_sizes,
)
from impact_damper.plot.style import BLUE, GREY, ROLES, figure, legend, style

CAPTION = """
Largest displacement of the machine against forcing frequency. Without the damper: exact periodic
orbits, stable (full) and unstable (dashed). With the damper: motions to which random starts lead
(circles if periodic, dots if not), curves of exact orbits through the circles, and the largest
motion to which any start leads (squares). If the peaks of this motion vary from cycle to cycle,
95 % of them lie below the short dash.
"""
BARE_STABLE = BARE | {"label": "without damper, stable"}
BARE_UNSTABLE = BARE | {
    "color": GREY,
    "linestyle": (0, (4, 2)),
    "label": "without damper, unstable",
}
STABLE = DAMPED | {"linewidth": 1.0, "label": "with damper, stable orbit"}
UNSTABLE = STABLE | {"linestyle": (0, (1, 1.5)), "label": "with damper, unstable orbit"}
SETTLED = ROLES["period_1"] | {"label": "with damper, periodic", "markersize": 2.6}
OTHERS = ROLES["chaotic"] | {"label": "with damper, not periodic", "markersize": 3.0}
REACHED = {
    "color": BLUE,
    "marker": "s",
    "markersize": 3.2,
    "markerfacecolor": "none",
    "linestyle": "none",
    "label": "largest reached",
}
HIGH = {
    "color": BLUE,
    "marker": "_",
    "markersize": 6,
    "linestyle": "none",
    "label": "95 % of the peaks are below",
}


@style()
def draw_response(data):
    """Return the figure of the dataset of `stages.machines.design_damper`."""
    drawn = figure("single", 3.5)
    response_panel(drawn.subplots(), data)
    legend(drawn, 2)
    return drawn


def response_panel(axes, data):
    """Draw displacements without and with the damper against the forcing frequency."""
    names = ("bare_branch", "bare_frequency", "bare_displacement", "bare_stability")
    number, *rest = (data[name].values for name in names)
    for value, size, stable in runs_of(np.unique(number), number, *rest):
        axes.plot(value, size, **(BARE_STABLE if stable else BARE_UNSTABLE))
    for value, size, stable in runs(data, lambda period: True):
        axes.plot(value, size, **(STABLE if stable else UNSTABLE))
    size = data["maximum_displacement"].values
    settled = is_settled(data)
    shown = np.isfinite(size) & (data["outcome"].values != flag("outcome", "absent"))
    shown &= data["motion_starts"].values > 0
    for chosen, role in ((shown & settled, SETTLED), (shown & ~settled, OTHERS)):
        row, column = chosen.nonzero()
        plot_if_any(axes, data["frequency"].values[row], size[row, column], **role)
    frequency, largest = data["frequency"].values, data["reached_displacement"].values
    plot_sizes(axes, frequency, largest, **REACHED)
    high = data["motion_peak_high"].values
    plot_if_any(axes, frequency, np.where(high < 0.99 * largest, high, np.nan), **HIGH)
    limit_line(axes, data)
    axes.set(xlabel="Forcing frequency (Hz)", ylabel="Largest displacement (mm)")
    decades(axes)
