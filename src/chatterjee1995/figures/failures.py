"""Figures of how integrators fail: by missing shallow contacts, and by too large steps."""

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from chatterjee1995.methods.integrators import integrators
from impact_damper.data.datasets import parameters_of
from impact_damper.plot import style
from impact_damper.plot.maps import edges_of

COLUMNS = 3  # panels side by side
LINEAR = "linear stability limit"
# Words in the legend -> look of a line. "within 1 %": relative error of max |Z1| up to 1 %.
LINES = {
    "within 1 %": {"marker": "o", "markerfacecolor": style.WHITE, "linestyle": (0, (4, 2))},
    "within 10 %": {"marker": "s"},
    LINEAR: {"linestyle": (0, (1, 1.2)), "linewidth": 0.9},
}


@style.context()
def draw_missed_contacts(*, missed_contacts):
    """Draw the share of contacts that an integrator misses, one map for each integrator."""
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
    of, depths, fixed = data.sel(integrator=name), data["depth"].values, integrators()[name].fixed
    y = data["fixed_steps"].values if fixed else data["method_tolerance"].values
    shares = {"cmap": "cividis_r", "vmin": 0, "vmax": 1, "rasterized": True}
    image = axes.pcolormesh(_edges(depths), _edges(y), of["contacts_missed"], **shares)
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
    axes.set(xscale="log", yscale="log", xlim=_edges(depths)[[0, -1]], ylim=_edges(y)[[0, -1]])
    axes.xaxis.set_major_locator(LogLocator(numticks=5))
    axes.xaxis.set_minor_formatter(NullFormatter())
    return image


@style.context()
def draw_stable_steps(*, stable_steps):
    """Draw the largest accurate time step over contact stiffness, one panel for each damper."""
    drawn = style.figure("double", 3.9)
    panels = drawn.subplots(1, len(stable_steps), sharey=True, squeeze=False)[0]
    for axes, data in zip(panels, stable_steps, strict=True):
        for index, name in enumerate(data["fixed_method"].values):
            _draw_method(axes, data.sel(fixed_method=name), index, integrators()[name].title)
        words = style.parameter_label(parameters_of(data), "mass_ratio", "clearance", "restitution")
        axes.set(xscale="log", yscale="log", xlabel=style.axis_label(data["contact_stiffness"]))
        axes.set_title(words)
        # The axes get fixed limits, because a panel may have no points.
        stiffness, tested = data["contact_stiffness"].values, data["scaled_step"].values
        axes.set(xlim=(stiffness.min() / 2, stiffness.max() * 2))
        axes.set(ylim=(tested.min(), tested.max()))
    panels[0].set_ylabel(style.axis_label(stable_steps[0]["scaled_step"]))
    for words, look in LINES.items():
        panels[0].plot([], [], color=style.GREY, label=words, **look)
    style.letter_panels(panels)
    style.legend(drawn, 4)
    return drawn


def _draw_method(axes, data, index, title):
    looks = dict(zip(data["accuracy"].values, list(LINES.values())[:2], strict=True))
    for accuracy, look in looks.items():
        step = data["stable_step"].sel(accuracy=accuracy) * data["contact_frequency"]
        axes.plot(data["contact_stiffness"], step, color=style.curve(index)["color"], **look)
    axes.plot([], [], color=style.curve(index)["color"], label=title)
    if data["linear_limit"] > 0:
        look = LINES[LINEAR] | {"color": style.curve(index)["color"]}
        axes.axhline(float(data["linear_limit"]), **look)


def _edges(values):
    if len(values) == 1:
        return np.asarray(values) * np.sqrt([0.1, 10])
    return np.exp(edges_of(np.log(values)))
