"""Dampers of several loose masses: displacement, contact force, and the Pareto front."""

import numpy as np

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.machine_figures.looks import STAR, decades, limit_line, plot_sizes
from impact_damper.plot.style import BLACK, BLUE, figure, legend, style

CAPTION = """
Dampers of other masses for the same machine and band. A shortened design chose the gap of each
(numbers, in mm). Above: largest displacement of any motion over the band and over the tolerance of
the gap. Below: largest contact force. Filled: on the Pareto front, which means that no other of
these dampers is better in displacement, force and mass at once.
"""
FRONT = {"color": BLUE, "marker": "o", "markersize": 5, "linestyle": "none"}
FRONT |= {"label": "on the Pareto front"}
OTHERS = FRONT | {"markerfacecolor": "none", "label": "bettered by another mass"}
SMALL = {"textcoords": "offset points", "fontsize": 7}
DESIGN = STAR | {"label": "this design", "markersize": 4.5, "color": BLACK}


@style()
def draw_masses(data):
    """Return the figure of the dataset of `stages.machines.design_damper`."""
    drawn = figure("single", 3.9)
    panels = drawn.subplots(2, sharex=True)
    mass, best = data["other_mass"].values, data["other_best"].values.astype(bool)
    here = np.isclose(mass, parameters_of(data)["mass"])
    for axes, name in zip(panels, ("other_displacement", "other_force"), strict=True):
        values = data[name].values
        for chosen, look in ((best, FRONT), (~best, OTHERS)):
            plot_sizes(axes, mass[chosen], values[chosen], **look)
        axes.plot(mass[here], values[here], **DESIGN)
    limit_line(panels[0], data)
    panels[0].set_ylabel("Largest displacement (mm)")
    panels[1].set(xlabel="Loose mass (kg)", ylabel="Largest contact force (N)")
    for axes in panels:
        axes.set_yscale("log")
        axes.margins(0.12)
        low, high = axes.get_ylim()
        axes.set_ylim(low / 1.1, high * 1.25)
        decades(axes)
    rows = zip(mass, data["other_displacement"].values, data["other_gap"].values, strict=True)
    for x, size, gap in rows:
        if np.isfinite(size):
            panels[0].annotate(f"{gap:.3g}", (x, size), (0, 5), ha="center", **SMALL)
    legend(drawn, 2)
    return drawn
