"""Largest steps with which fixed-step methods keep the quiet motion (kind `stable_steps`)."""

from chatterjee1995.methods.integrators import integrators
from impact_damper.data.datasets import parameters_of
from impact_damper.plot import style

LINEAR = "linear stability limit"
# Lines: one for each accuracy, in the order of the dataset, and one for the linear limit.
LINES = {
    "within 1 %": {"marker": "o", "markerfacecolor": style.WHITE, "linestyle": (0, (4, 2))},
    "within 10 %": {"marker": "s"},
    LINEAR: {"linestyle": (0, (1, 1.2)), "linewidth": 0.9},
}


@style.context()
def draw_stable_steps(*, stable_steps):
    """Draw the largest step that keeps the motion against contact stiffness, a panel per damper."""
    drawn = style.figure("double", 3.9)
    panels = drawn.subplots(1, len(stable_steps), sharey=True, squeeze=False)[0]
    for axes, data in zip(panels, stable_steps, strict=True):
        for index, name in enumerate(data["fixed_method"].values):
            _draw_method(axes, data.sel(fixed_method=name), index, integrators()[name].title)
        words = style.parameter_label(parameters_of(data), "mass_ratio", "clearance", "restitution")
        axes.set(xscale="log", yscale="log", xlabel=style.axis_label(data["contact_stiffness"]))
        axes.set_title(words)
        # Limits are fixed, because a panel may have no points.
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
    """Draw the largest steps of one method for each accuracy, and its linear stability limit."""
    looks = dict(zip(data["accuracy"].values, list(LINES.values())[:2], strict=True))
    for accuracy, look in looks.items():
        step = data["stable_step"].sel(accuracy=accuracy) * data["contact_frequency"]
        axes.plot(data["contact_stiffness"], step, color=style.curve(index)["color"], **look)
    axes.plot([], [], color=style.curve(index)["color"], label=title)
    if data["linear_limit"] > 0:
        look = LINES[LINEAR] | {"color": style.curve(index)["color"]}
        axes.axhline(float(data["linear_limit"]), **look)
