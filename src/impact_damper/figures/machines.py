"""Machines in SI units: displacement against frequency and gap (figure kind `machines`)."""

import numpy as np

from impact_damper.data.datasets import flag, is_settled
from impact_damper.figures.branches import runs, runs_of
from impact_damper.figures.style import (
    BLUE,
    ORANGE,
    ROLES,
    axis_label,
    figure,
    legend,
    letter_panels,
    style,
)

CAPTION = """
One row for each machine, (a), (b) and so on in the order named. Left: largest displacement against
forcing frequency, without and with the damper. Lines are exact periodic orbits. Points are motions
to which starts lead, or which are followed from the neighbouring frequency; the starts are scaled
by the motions without the damper. Right: largest displacement against the gap, the full play of the
loose mass, at one frequency: the quiet motion, the largest motion that any start leads to, and the
share of random starts that lead to the quiet motion (dotted, right scale). Star: the smallest quiet
motion, to which few starts may lead. Motions that escape over the barrier of a softening spring
have no size and are not drawn.
"""

BARE = {"stable": ROLES["free_stable"], "unstable": ROLES["free_unstable"]}
BARE = {name: role | {"label": f"without damper, {name}"} for name, role in BARE.items()}
ORBIT = {"color": BLUE, "linewidth": 1.0, "label": "with damper, stable orbit"}
UNSTABLE = {"color": BLUE, "linewidth": 0.7, "linestyle": (0, (1, 1.5)), "zorder": 1.9}
SETTLED = ROLES["period_1"] | {"label": "with damper, settled motion", "markersize": 2.6}
OTHERS = ROLES["chaotic"] | {"label": "with damper, other motion"}
QUIET = ROLES["period_1"] | {"label": "quiet motion", "marker": "s", "markersize": 2.6}
LARGEST = {"color": ORANGE, "linewidth": 0.9, "label": "largest motion from starts"}
SHARE = {"linestyle": ":", "linewidth": 0.9, "color": "black", "label": "share of quiet starts"}


@style()
def draw_machines(*, machines):
    """Draw displacements of machines against frequency, and against the gap of their dampers.

    Parameters
    ----------
    machines : list of xarray.Dataset
        Datasets of the stage machines.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 0.8 + 2.0 * len(machines))
    panels = drawn.subplots(len(machines), 2, squeeze=False)
    for (left, right), data in zip(panels, machines, strict=True):
        draw_response(left, data)
        draw_gaps(right, data)
    letter_panels(panels[:, 0])
    legend(drawn, 3)
    return drawn


def draw_response(axes, data):
    """Draw displacements against forcing frequency, without and with the damper."""
    names = ("bare_branch", "bare_frequency", "bare_displacement", "bare_stability")
    number, *rest = (data[name].values for name in names)
    for value, size, stable in runs_of(np.unique(number), number, *rest):
        axes.plot(value, size, **BARE["stable" if stable else "unstable"])
    for value, size, stable in runs(data, lambda period: True):
        axes.plot(value, size, **(ORBIT if stable else UNSTABLE))
    size = data["maximum_displacement"].values
    settled = is_settled(data)
    drawn = np.isfinite(size) & (data["outcome"].values != flag("outcome", "absent"))
    for chosen, role in ((settled, SETTLED), (drawn & ~settled, OTHERS)):
        row, column = chosen.nonzero()
        axes.plot(data["frequency"].values[row], size[row, column], **role)
    axes.set(xlabel=axis_label(data["frequency"]), ylabel=axis_label(data["maximum_displacement"]))
    axes.set_ylim(bottom=0)


def draw_gaps(axes, data):
    """Draw quiet and largest displacement, and the share of quiet starts, against the gap."""
    gap, largest = data["gap"].values, data["largest_displacement"].values
    axes.plot(gap, np.where(np.isfinite(largest), largest, np.nan), **LARGEST)
    axes.plot(gap, data["quiet_displacement"], **QUIET)
    star = ROLES["optimum"] | {"label": "smallest quiet motion"}
    axes.plot(data["optimum_gap"], data["optimum_displacement"], **star)
    axes.set(
        xlabel=axis_label(data["gap"]),
        ylabel=f"Displacement at {float(data['swept_frequency']):.4g} Hz (mm)",
    )
    axes.set_ylim(bottom=0)
    shares = axes.twinx()
    shares.plot(gap, data["quiet_share"], **SHARE)
    shares.set(ylim=(0, 1.02), ylabel="Share of quiet starts")
