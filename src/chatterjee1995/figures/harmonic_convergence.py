"""Errors of harmonic balance and of Hill's method against the number of harmonics.

Figure kind `harmonic_convergence`. Hill's method computes Floquet multipliers from the harmonics
of an orbit. In a cold start Newton's method begins from the solution with
one harmonic, otherwise from the solution with the next lower number of harmonics.
"""

import numpy as np

from impact_damper.data.datasets import flag, has_damper, parameters_of
from impact_damper.plot.panels.style import (
    GREY,
    ROLES,
    axis_label,
    curve,
    figure,
    legend,
    letter_panels,
    parameter_label,
    points,
    style,
)

CAPTION = """
Error of harmonic balance with harmonics 1, 3, ... N against the exact orbit: (a) largest
displacement; (b) root mean square over the harmonics of Z1 up to N; (c) Floquet multiplier by
Hill's method. (d) Result of Newton's method started from the solution with one harmonic. Dashed
grey: predicted decrease, drawn 3 times too high.
"""

PANELS = {
    "maximum": r"Error of $\max\,|Z_1|$",
    "retained": "Error of $Z_1$ in harmonics up to $N$",
    "multiplier": "Error of a Floquet multiplier (Hill)",
}
ROUNDING = 1e-12  # smallest error fitted: smaller ones are dominated by rounding
FLOOR = 1e-16  # smallest error drawn
GUIDE = {"color": GREY, "linewidth": 0.7, "linestyle": (0, (2, 1.5)), "zorder": 1}
# Result of a cold start -> legend text and marker.
COLD = {
    "same_motion": ("(d): finds the same motion", {"marker": "o", "markerfacecolor": "none"}),
    "another_motion": ("(d): finds another motion", {"marker": "s", "markersize": 4.4}),
    "stalled": ("(d): Newton's method stalls", {"marker": "x"}),
    "iteration_limit": ("(d): reaches the limit of steps", {"marker": "+", "markersize": 5}),
}


@style()
def draw_harmonic_convergence(*, harmonic_convergence):
    """Draw errors of max |Z1|, of the retained harmonics and of multipliers, and cold starts.

    Parameters
    ----------
    harmonic_convergence : list of xarray.Dataset
        Datasets of the stage harmonic_convergence, at most five.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 6.4)
    panels = drawn.subplots(2, 2, sharex=True)
    letter_panels(panels.flat)
    for axes, (measure, words) in zip(panels.flat, PANELS.items(), strict=False):
        draw_errors(axes, harmonic_convergence, measure)
        axes.set(xscale="log", yscale="log", ylabel=words, ylim=(FLOOR / 2, 10))
    draw_cold(panels[1, 1], harmonic_convergence)
    for axes in panels[1]:
        axes.set_xlabel(axis_label(harmonic_convergence[0]["highest_harmonic"]))
    legend(drawn, 3)
    return drawn


def draw_errors(axes, harmonics, measure):
    """Draw the errors of one measure, the predicted decrease, and failures at the upper edge."""
    status = "hill_status" if measure == "multiplier" else "series_status"
    for index, data in enumerate(harmonics):
        at = data.sel(error_measure=measure)
        highest, error = data["highest_harmonic"].values, at["series_error"].values
        line = points(index) | curve(index) | {"linewidth": 0.8}
        axes.plot(highest, np.maximum(error, FLOOR), **line, label=title(data))
        lost = highest[data[status].values != 0]
        if len(lost):
            place = {"transform": axes.get_xaxis_transform(), "label": "failed"}
            axes.plot(lost, np.full(len(lost), 0.97), **ROLES["unresolved"] | place)
    for data in harmonics:
        axes.plot(*guide(data, data.sel(error_measure=measure)), **GUIDE, label="predicted decay")


def guide(data, at):
    """Return harmonics and values of the line of predicted decrease: two arrays, or empty lists.

    The line is three times as high as the fit of the predicted decrease to the errors, so that it
    does not hide them.
    """
    highest, error = data["highest_harmonic"].values, at["series_error"].values
    used = (highest >= data["asymptotic_harmonic"].item()) & (error > ROUNDING)
    if not used.any():
        return [], []
    highest, error = highest[used], np.log(error[used])
    exponential = data["decay_kind"] == flag("decay_kind", "exponential")
    decay = -at["decay_predicted"].item() * (highest if exponential else np.log(highest))
    return highest, 3 * np.exp(decay + np.mean(error - decay))


def draw_cold(axes, harmonics):
    """Draw the result of each cold start, one row for each motion."""
    for index, data in enumerate(harmonics):
        highest, status = data["highest_harmonic"].values, data["cold_status"].values
        for meaning, (words, look) in COLD.items():
            chosen = highest[status == flag("cold_status", meaning)]
            look = look | {"color": curve(index)["color"], "linestyle": "none"}
            if len(chosen):
                axes.plot(chosen, np.full(len(chosen), -index), **look, label=words)
    axes.set_yticks(-np.arange(len(harmonics)), [title(data, short=True) for data in harmonics])
    axes.set_ylim(0.5 - len(harmonics), 0.5)
    axes.tick_params(axis="y", length=0)


def title(data, short=False):
    """Return the parameters of a motion as text: its damper, or "free" without one."""
    parameters = parameters_of(data)
    if not has_damper(data):
        return "free" if short else f"free, {parameter_label(parameters, 'frequency')}"
    separator = "\n" if short else ", "
    damper = parameter_label(parameters, "mass_ratio", "restitution")
    return damper + separator + parameter_label(parameters, "contact_stiffness")
