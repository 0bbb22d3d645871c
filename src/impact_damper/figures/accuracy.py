"""Error against counted work, a panel for each scene."""

from itertools import cycle

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from impact_damper.data.datasets import parameters_of
from impact_damper.data.variables import VARIABLES
from impact_damper.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PALE,
    PURPLE,
    SKY,
    VERMILION,
    figure,
    legend,
    letter_panels,
    style,
)

# Colour by family, marker and line by what is done at contacts.
ROLES = {
    "taylor": ("Taylor, events", BLUE, "o", "-"),
    "merson_kink": ("Merson, kink", VERMILION, "v", ":"),
    "merson_located": ("Merson, located", VERMILION, "^", "-"),
    "DOP853_kink": ("DOP853, kink", GREEN, "v", ":"),
    "DOP853_located": ("DOP853, events", GREEN, "^", "-"),
    "LSODA_kink": ("LSODA, kink", ORANGE, "v", ":"),
    "LSODA_located": ("LSODA, events", ORANGE, "^", "-"),
    "Radau_kink": ("Radau, kink", PURPLE, "v", ":"),
    "Radau_located": ("Radau, events", PURPLE, "^", "-"),
    "rigid": ("rigid impacts", GREY, "s", "none"),
    "rigid_mended": ("rigid, mended", GREY, "D", "none"),
    "rigid_balance": ("one term, (14)", SKY, "P", "none"),
    "full_balance": ("one term, (7)", SKY, "X", "none"),
    "many_harmonics": ("many harmonics", SKY, "h", "-"),
    "shooting": ("shooting", BLACK, "*", "none"),
}
# Of series of further orders, named by these: first marker, then line.
OTHER_ORDERS = [("<", "--"), (">", "-."), ("d", ":")]
ENDED = ("ok", "missed_contacts", "invented_contacts")
QUANTITIES = {
    "amplitude": ("amplitude_error", r"Relative error of max $|Z_1|$"),
    "state": ("state_error", "Error of the state at the end"),
    "contact_time": ("contact_time_error", "Error of contact times"),
    "contacts": ("state_error", "Error of the state at the end"),
    "contact_rate": ("contact_rate", "Relative error of contacts a period"),
    "displacement": ("displacement", r"Relative error of mean max $|Z_1|$"),
    "exponent": ("exponent", "Relative error of the Lyapunov exponent"),
}
FINEST = 1e-16


@style()
def draw_accuracy(*, accuracy):
    """Panels of error over work, methods by colour and marker.

    Parameters
    ----------
    accuracy : list of xarray.Dataset
        Of `accuracy.error_against_work`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    rows = -(-len(accuracy) // 2)
    drawn = figure("double", 1.5 + 2.4 * rows)
    panels = drawn.subplots(rows, min(2, len(accuracy)), squeeze=False).ravel()
    for axes, data in zip(panels, accuracy, strict=False):
        _panel(axes, data)
    for axes in panels[len(accuracy) :]:
        axes.set_axis_off()
    letter_panels(panels[: len(accuracy)])
    for axes in panels[max(0, len(accuracy) - 2) : len(accuracy)]:
        axes.set_xlabel("Floating-point operations")
    legend(drawn, 4)
    return drawn


def _panel(axes, data):
    made = parameters_of(data)
    quantity, borne = made["accuracy"]["quantity"], made["accuracy"]["within"]
    name, words = QUANTITIES[quantity]
    chaotic = made["motion"] == "chaotic"
    if chaotic:
        truth = float(data["reference_average"].sel(statistic=quantity))
        average = data["average"].sel(statistic=quantity).values
        bars = data["average_error"].sel(statistic=quantity).values / truth
        error = np.abs(average / truth - 1)
        doubt = float(data["reference_average_error"].sel(statistic=quantity)) / truth
        axes.axhspan(1e-9, doubt, color=PALE, zorder=0, label="error of the reference")
    else:
        error, bars = data[name].values, None
    meanings = VARIABLES["run_status"].flags
    status = data["run_status"].values
    work = data["operations"].values
    error = np.maximum(error, FINEST)
    ended = np.isin(status, [meanings[each] for each in ENDED])
    right = status == meanings["ok"]
    low, high = (1e-4, 1.0) if chaotic else (10 ** np.floor(np.log10(np.min(error[ended]))), 30)
    run = np.log10(work[work > 0])
    least, most = np.min(run), np.max(run)
    for method, (label, color, marker, line) in _roles(data).items():
        of = data["method"].values == method
        looks = {"color": color, "markersize": 4}
        chosen = of & ended
        axes.plot(work[chosen], error[chosen], color=color, linestyle=line, linewidth=0.7)
        good, bad = of & ended & right, of & ended & ~right
        axes.plot(work[good], error[good], marker, markerfacecolor=color, label=label, **looks)
        if bars is not None:
            axes.errorbar(
                work[good], error[good], bars[good], fmt="none", ecolor=color, elinewidth=0.5
            )
        axes.plot(work[bad], error[bad], marker, markerfacecolor="none", **looks)
        axes.plot(work[bad], error[bad], "x", color=BLACK, markersize=5.5, markeredgewidth=0.6)
        stopped = work[of & ~ended & (work > 0)]
        if len(stopped) > 0:
            top = np.full(len(stopped), high)
            axes.plot(stopped, top, marker, markerfacecolor="none", clip_on=False, **looks)
            axes.plot(stopped, top, "+", color=BLACK, markersize=7, clip_on=False)
    if quantity != "contacts":
        axes.axhline(borne, color=BLACK, linestyle="--", linewidth=0.9, label="accuracy asked")
    axes.plot([], [], "x", color=BLACK, label="wrong contacts")
    axes.plot([], [], "+", color=BLACK, label="no result")
    axes.set(xscale="log", yscale="log", ylim=(low, high))
    axes.yaxis.set_major_locator(LogLocator(numticks=8))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_formatter(NullFormatter())
    axes.set_xlim(*(10 ** np.array([np.floor(least), np.ceil(most)])))
    axes.set_ylabel(words)
    axes.set_title(made["scene"].replace("_", " "), loc="right", fontsize=8)


def _roles(data):
    """All roles, those of series of further orders after that of the ones in use."""
    names = sorted(set(data["method"].values) - set(ROLES))
    further = {
        name: ("Taylor, orders {1} and {2}".format(*name.split("_")), BLUE, marker, line)
        for name, (marker, line) in zip(names, cycle(OTHER_ORDERS))
    }
    return {"taylor": ROLES["taylor"]} | further | ROLES
