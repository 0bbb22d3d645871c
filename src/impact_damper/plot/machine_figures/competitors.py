"""The designed damper compared with tuned absorbers of the same mass.

A tuned absorber is the mass on a spring and a dashpot. A start is a random initial state.
"""

import numpy as np
from matplotlib.ticker import NullLocator

from impact_damper.plot.machine_figures.looks import (
    BARE,
    DAMPED,
    TUNED,
    decades,
    finite,
    plot_sizes,
)
from impact_damper.plot.style import figure, legend, style

CAPTION = """
Largest displacement of all motions found: with this damper, with tuned absorbers of the same mass,
and without either. Above: against the forcing frequency at the nominal excitation. Below: largest
value over the band against the excitation; for this damper only motions to which random starts
lead. Shaded: springs of the absorber 10 % softer to 10 % stiffer than designed.
"""
DETUNED = "detuned by 10 %"
LOOKS = {"tuned": TUNED}
OURS = DAMPED | {"marker": "s", "markersize": 3.0, "zorder": 3}


@style()
def draw_competitors(data):
    """Return the figure of the dataset of `stages.machines.design_damper`."""
    drawn = figure("single", 4.8)
    upper, lower = drawn.subplots(2)
    sizes = data["competitor_displacement"]
    here = sizes.sel(force_share=1.0)
    worst = sizes.max("frequency", skipna=False)
    _panel(upper, here.transpose("competitor", "detuning", "frequency"), data["frequency"].values)
    _panel(lower, worst.transpose("competitor", "detuning", "force_share"), data["force_share"])
    plot_sizes(upper, data["frequency"].values, data["reached_displacement"].values, **OURS)
    ours = data["force_map_displacement"].max("operating_frequency")
    plot_sizes(lower, data["force_share"].values, ours.values, **OURS)
    upper.set_xlabel("Forcing frequency (Hz)")
    lower.set(xlabel="Excitation / nominal", xscale="log", xticks=data["force_share"].values[::2])
    lower.xaxis.set_major_formatter("{x:g}")
    lower.xaxis.set_minor_locator(NullLocator())
    for axes in (upper, lower):
        axes.set_ylabel("Largest displacement (mm)")
        decades(axes)
    legend(drawn, 2)
    return drawn


def _panel(axes, sizes, x):
    """Draw the machine alone and each absorber, with a band between its detuned versions.

    `sizes` has the dimensions competitor, detuning and that of `x`; millimetres.
    """
    x = np.asarray(x)
    plot_sizes(axes, x, sizes.sel(competitor="bare", detuning=0.0).values, **BARE)
    for name, look in LOOKS.items():
        each = sizes.sel(competitor=name)
        if not np.isfinite(each.values).any():
            continue
        low, high = finite(each.min("detuning")), finite(each.max("detuning"))
        axes.fill_between(x, low, high, color=look["color"], alpha=0.2, linewidth=0, label=DETUNED)
        plot_sizes(axes, x, each.sel(detuning=0.0).values, **look)
