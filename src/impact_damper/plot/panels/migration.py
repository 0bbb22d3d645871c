"""A run of migration control against time (paper: figures 13, 15 and 16; figure kind `migration`).

Migration takes the oscillator from its resonance to its small motion, the goal, by switching the
damper on and off. A release is a moment at which the damper is switched off.
"""

import numpy as np
from matplotlib.colors import to_rgb

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.panels.style import (
    BLACK,
    ROLES,
    axis_label,
    figure,
    legend,
    letter_panels,
    style,
)

CAPTION = """
Displacement against time, (a) in the whole run, (b) around the last release. Of a long run (a)
shows the envelope. Shaded: damper on; the loose mass starts at a random place. Drawn is the first
run that reaches the goal with the median number of switchings; if none does, the first run.
"""

# Number of cycles above which the envelope of a run is drawn instead of its course.
LONG = 100
AROUND = -15, 25  # cycles from the last release at which panel (b) begins and ends


@style({"axes.titley": None})  # keeps the letters clear of the upper axis
def draw_migration(*, migration):
    """Draw the displacement in the stored run of each case: the whole run, and its last release.

    Parameters
    ----------
    migration : list of xarray.Dataset
        Datasets of the stage migration.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 0.7 + 3.6 * len(migration))
    panels = drawn.subplots(2 * len(migration), 1, squeeze=False)[:, 0]
    for runs, whole, part in zip(migration, panels[::2], panels[1::2], strict=True):
        run = runs.isel(trial=int(runs["example"]))
        period = 2 * np.pi / parameters_of(runs)["frequency"]
        release = np.nanmax(run["off_time"])
        draw_run(whole, run, run["time"].values[[0, -1]], 0.3)
        draw_run(part, run, release + period * np.array(AROUND), 0.8)
        above = whole.secondary_xaxis("top", (lambda t, p=period: t / p, lambda n, p=period: n * p))
        above.set_xlabel(r"Cycles of the forcing, $\Omega T / 2 \pi$")
        part.set(xlabel=axis_label(run["time"]))
    drawn.supylabel(axis_label(migration[0]["displacement"]), fontsize="medium")
    letter_panels(panels)
    legend(drawn, 3)
    return drawn


def draw_run(axes, run, span, width):
    """Draw a run of the controller within `span` (first and last time), with its switchings."""
    time, displacement = run["time"].values, run["displacement"].values
    inside = (time >= span[0]) & (time <= span[1])
    time, displacement = time[inside], displacement[inside]
    period = 2 * np.pi / parameters_of(run)["frequency"]
    if span[1] - span[0] > LONG * period:
        each = max(1, round(period / (time[1] - time[0])))
        rows = displacement[: len(displacement) // each * each].reshape(-1, each)
        lows, highs = rows.min(axis=1), rows.max(axis=1)
        look = {"facecolor": (*to_rgb(BLACK), 0.25), "edgecolor": BLACK, "linewidth": 0.4}
        axes.fill_between(time[: rows.size : each], lows, highs, **look)
    else:
        axes.plot(time, displacement, color=BLACK, linewidth=width)
    on, off = (run[name].values[np.isfinite(run[name])] for name in ("on_time", "off_time"))
    for begin, end in zip(on, off, strict=True):
        axes.axvspan(begin, end, **ROLES["damper_on"])
    for times, role in ((on, "switched_on"), (off, "switched_off")):
        for time in times:
            axes.axvline(time, **ROLES[role])
    axes.set(xlim=span)
    axes.tick_params(top=False)
