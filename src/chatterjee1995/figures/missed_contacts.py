"""Share of contacts near grazing that integrators miss (figure kind `missed_contacts`)."""

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from chatterjee1995.methods.integrators import integrators
from impact_damper.plot import style
from impact_damper.plot.maps import edges

COLUMNS = 3  # panels side by side


@style.context()
def draw_missed_contacts(*, missed_contacts):
    """Draw the share of contacts missed, one panel for each method, and a colour bar."""
    (data,) = missed_contacts
    drawn, panels = style.grid(data.sizes["integrator"], 1.9, 0.8, COLUMNS)
    for k, (axes, name) in enumerate(zip(panels, data["integrator"].values, strict=True)):
        image = _panel(axes, data, name)
        axes.set_title(integrators()[name].title, loc="right", fontsize=8)
        if integrators()[name].fixed:
            axes.set_ylabel("Steps a cycle")
        elif k % COLUMNS == 0:
            axes.set_ylabel(style.axis_label(data["method_tolerance"]))
        if k + COLUMNS >= len(panels):
            axes.set_xlabel("Depth beyond the wall")
    drawn.colorbar(image, ax=panels, label="Share of contacts missed")
    panels[0].plot([], [], color=style.BLACK, linestyle="--", label="half missed by constant steps")
    panels[0].plot([], [], ".", color=style.SKY, label="contact reported, none occurs")
    style.legend(drawn, 3)
    return drawn


def _panel(axes, data, name):
    """Draw the panel of one method, and return the image of the shares of missed contacts."""
    of, depths, fixed = data.sel(integrator=name), data["depth"].values, integrators()[name].fixed
    y = data["fixed_steps"].values if fixed else data["method_tolerance"].values
    shares = {"cmap": "cividis_r", "vmin": 0, "vmax": 1, "rasterized": True}
    image = axes.pcolormesh(edges(depths), edges(y), of["contacts_missed"], **shares)
    axes.plot(of["motion_error"], y, color=style.VERMILION, label="median error of the motion")
    if fixed:
        expected = data["expected_unseen"].values
        axes.contour(
            depths, y, expected, [0.5], colors=style.BLACK, linestyles="--", linewidths=1.1
        )
    i, j = np.nonzero(of["spurious_count"].values)
    axes.plot(depths[j], y[i], ".", color=style.SKY, markersize=2.2, markeredgewidth=0)
    i, j = np.nonzero(of["passage_count"].sel(contact_outcome="failed").values)
    if len(i) > 0:
        axes.plot(
            depths[j], y[i], "x", color=style.VERMILION, markersize=3, label="some runs failed"
        )
    axes.set(xscale="log", yscale="log", xlim=edges(depths)[[0, -1]], ylim=edges(y)[[0, -1]])
    axes.xaxis.set_major_locator(LogLocator(numticks=5))
    axes.xaxis.set_minor_formatter(NullFormatter())
    return image
