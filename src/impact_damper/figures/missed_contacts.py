"""Share of contacts near grazing that each method misses, over depth and tolerance."""

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from impact_damper.data.shares import missed_share
from impact_damper.figures.maps import edges
from impact_damper.figures.style import (
    BLACK,
    SKY,
    VERMILION,
    axis_label,
    figure,
    legend,
    letter_panels,
    style,
)

NAMES = {
    "taylor": "Taylor series, events",
    "runge_kutta_4": "Runge-Kutta 4, fixed",
    "merson": "Merson, adaptive",
    "RK45": "SciPy RK45",
    "DOP853": "SciPy DOP853",
    "LSODA": "SciPy LSODA",
    "Radau": "SciPy Radau",
}


@style()
def draw_missed_contacts(*, missed_contacts):
    """Map of the share missed, a panel for each method; the last is the legend's of the colours.

    Parameters
    ----------
    missed_contacts : list of xarray.Dataset
        One, of `missed_contacts.missed_contacts`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    (data,) = missed_contacts
    drawn = figure("double", 4.6)
    panels = drawn.subplots(2, 4, sharex=True).ravel()
    depths = data["depth"].values
    for axes, name in zip(panels, data["integrator"].values, strict=False):
        of = data.sel(integrator=name)
        fixed = name == "runge_kutta_4"
        y = data["fixed_steps"].values if fixed else data["method_tolerance"].values
        image = axes.pcolormesh(
            edges(depths),
            edges(y),
            missed_share(of),
            cmap="cividis_r",
            vmin=0,
            vmax=1,
            rasterized=True,
        )
        axes.plot(of["motion_error"], y, color=VERMILION, label="median error of the motion")
        if fixed:
            expected = data["expected_unseen"].values
            axes.contour(depths, y, expected, [0.5], colors=BLACK, linestyles="--", linewidths=1.1)
        i, j = np.nonzero(of["spurious_count"].values)
        axes.plot(depths[j], y[i], ".", color=SKY, markersize=2.2, markeredgewidth=0)
        failed = of["passage_count"].sel(contact_outcome="failed").values
        i, j = np.nonzero(failed)
        if len(i) > 0:
            axes.plot(depths[j], y[i], "x", color=VERMILION, markersize=3, label="some runs failed")
        axes.set(xscale="log", yscale="log", xlim=edges(depths)[[0, -1]], ylim=edges(y)[[0, -1]])
        axes.set_title(NAMES[name], loc="right", fontsize=8)
        axes.xaxis.set_major_locator(LogLocator(numticks=5))
        axes.xaxis.set_minor_formatter(NullFormatter())
        if fixed:
            axes.set_ylabel("Steps a forcing period")
        elif name in ("taylor", "DOP853"):
            axes.set_ylabel(axis_label(data["method_tolerance"]))
    for axes in panels[3:7]:
        axes.set_xlabel("Depth beyond the wall")
        axes.xaxis.set_tick_params(labelbottom=True)
    panels[7].set_axis_off()
    place = panels[7].inset_axes((0.1, 0.55, 0.85, 0.08))
    bar = drawn.colorbar(image, cax=place, orientation="horizontal")
    bar.set_label("Share of contacts missed")
    first = panels[0]
    first.plot([], [], color=BLACK, linestyle="--", label="half, if steps fall at random")
    first.plot([], [], ".", color=SKY, label="reports where the wall is as far out of reach")
    letter_panels(panels[:7])
    legend(drawn, 3)
    return drawn
