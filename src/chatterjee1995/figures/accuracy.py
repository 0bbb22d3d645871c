"""Figure of the errors of integrators and models over the floating-point operations they need."""

from itertools import cycle

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from chatterjee1995.methods.integrators import runs_of_accuracy
from chatterjee1995.methods.labels import colour_of, method_in_words
from impact_damper.data.datasets import decode, parameters_of
from impact_damper.plot import style

# Model with which an orbit is computed -> colour, marker, line.
MODELS = {
    "rigid": (style.GREY, "s", "none"),
    "rigid_mended": (style.GREY, "D", "none"),
    "rigid_balance": (style.SKY, "P", "none"),
    "full_balance": (style.SKY, "X", "none"),
    "many_harmonics": (style.SKY, "h", "-"),
    "shooting": (style.BLACK, "*", "none"),
}
LOCATED = {True: ("^", "-"), False: ("v", ":")}  # method locates contacts -> marker, line
OTHER_ORDERS = [("<", "--"), (">", "-."), ("d", ":")]  # marker, line of other Taylor orders
# Quantity whose error is drawn -> variable of the dataset, label of the axis.
QUANTITIES = {
    "amplitude": ("amplitude_error", r"Relative error of max $|Z_1|$"),
    "state": ("state_error", "Error of the state at the end"),
    "contact_time": ("contact_time_error", "Error of contact times"),
    "contacts": ("state_error", "Error of the state at the end"),
    "contact_rate": ("contact_rate", "Relative error of contacts a cycle"),
    "displacement": ("displacement", r"Relative error of mean max $|Z_1|$"),
    "exponent": ("exponent", "Relative error of the Lyapunov exponent"),
}
FINEST = 1e-16  # smallest error drawn
ENDED = "ok", "missed_contacts", "invented_contacts"  # `run_status` of runs with a result
DOUBTFUL = "open: wrong number of contacts, or\nchaos within its standard error"


@style.context()
def draw_accuracy(*, accuracy):
    """Draw errors of methods against their floating-point operations, one panel for each scene."""
    drawn, panels = style.grid(len(accuracy), 2.4, 1.5)
    for axes, data in zip(panels, accuracy, strict=True):
        _panel(axes, data)
    for axes in panels[-2:]:
        axes.set_xlabel("Floating-point operations")
    style.legend(drawn, 4)
    return drawn


def _panel(axes, data):
    made = parameters_of(data)
    quantity, chaotic = made["accuracy"]["quantity"], made["motion"] == "chaotic"
    name, label = QUANTITIES[quantity]
    error, bars = _errors(axes, data, quantity) if chaotic else (data[name].values, None)
    error, status = np.maximum(error, FINEST), decode(data["run_status"]).values
    ended = np.isin(status, ENDED)
    low = 1e-4 if chaotic else 10 ** np.floor(np.log10(np.min(error[ended])))
    high, work = 1.0 if chaotic else 30, data["operations"].values
    for method, role in _roles(data).items():
        of = data["method"].values == method
        right = status == "ok"
        _method(axes, role, work, error, bars, of & ended & right, of & ended & ~right)
        stopped = work[of & ~ended & (work > 0)]
        if len(stopped) > 0:
            looks = {"color": role[1], "markersize": 4, "clip_on": False}
            top = np.full(len(stopped), high)
            axes.plot(stopped, top, role[2], markerfacecolor="none", **looks)
            axes.plot(stopped, top, "+", color=style.BLACK, markersize=7, clip_on=False)
    if quantity == "contacts":
        words = "errors above 1: the motion left the orbit"
        axes.text(0.02, 0.86, words, transform=axes.transAxes, fontsize=7)
    else:
        required = made["accuracy"]["within"]
        axes.axhline(
            required, color=style.BLACK, linestyle="--", linewidth=0.9, label="required accuracy"
        )
    axes.plot([], [], "o", color=style.GREY, markerfacecolor="none", label=DOUBTFUL)
    axes.plot([], [], "+", color=style.BLACK, label="no result")
    decades = np.log10(work[work > 0])
    ends = 10 ** np.floor(decades.min()), 10 ** np.ceil(decades.max())
    axes.set(xscale="log", yscale="log", xlim=ends, ylim=(low, high), ylabel=label)
    axes.yaxis.set_major_locator(LogLocator(numticks=8))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_formatter(NullFormatter())
    axes.set_title(made["scene"].replace("_", " "), loc="right", fontsize=8)


def _errors(axes, data, quantity):
    of = data.sel(statistic=quantity)
    truth = float(of["reference_average"])
    doubt = float(of["reference_average_error"]) / truth
    axes.axhspan(1e-9, doubt, color=style.PALE, zorder=0, label="error of the reference")
    return np.abs(of["average"].values / truth - 1), of["average_error"].values / truth


def _method(axes, role, work, error, bars, good, bad):
    label, color, marker, line = role
    looks, ended = {"color": color, "markersize": 4}, good | bad
    if bars is None:
        joined = np.where(good, error, np.nan)[ended]
        axes.plot(work[ended], joined, color=color, linestyle=line, linewidth=0.7)
    else:
        unsure = error <= bars
        good, bad = good & ~unsure, bad | (good & unsure)
    axes.plot(work[good], error[good], marker, markerfacecolor=color, label=label, **looks)
    axes.plot(work[bad], error[bad], marker, markerfacecolor="none", alpha=0.5, **looks)


def _roles(data):
    looks = {"taylor": (colour_of("taylor"), "o", "-")}
    further = sorted(set(data["method"].values) - {*runs_of_accuracy(), *MODELS})
    for name, look in zip(further, cycle(OTHER_ORDERS)):
        looks[name] = (colour_of("taylor"), *look)
    for label, (integrator, located) in runs_of_accuracy().items():
        looks.setdefault(label, (colour_of(integrator.name), *LOCATED[located]))
    return {name: (method_in_words(name), *look) for name, look in (looks | MODELS).items()}
