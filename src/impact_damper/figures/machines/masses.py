"""Loose masses beside the nominal one: displacement and contact force, and the Pareto front."""

import numpy as np

from impact_damper.figures.machines.looks import STAR, decades, limit_line, plot_sizes
from impact_damper.figures.style import BLACK, BLUE, figure, legend, style

CAPTION = """
Dampers of other masses for the same machine and band, each with its own gap by a reduced design.
Above: largest displacement of any motion over the band and the tolerance of the gap. Below: largest
contact force. Filled: no other mass betters displacement, force and mass together (the Pareto
front). The numbers are the gaps in mm.
"""
FRONT = {"color": BLUE, "marker": "o", "markersize": 5, "linestyle": "none"}
FRONT |= {"label": "on the Pareto front"}
OTHERS = FRONT | {"markerfacecolor": "none", "label": "bettered by another mass"}
DESIGN = STAR | {"label": "this design", "markersize": 4.5, "color": BLACK}


@style()
def draw_masses(data):
    """Return the figure of the dataset of `stages.machines.design_damper`."""
    drawn = figure("single", 3.9)
    panels = drawn.subplots(2, sharex=True)
    mass, best = data["other_mass"].values, data["other_best"].values.astype(bool)
    here = np.isclose(mass, data.attrs["mass"]) if "mass" in data.attrs else mass < 0
    for axes, name in zip(panels, ("other_displacement", "other_force"), strict=True):
        values = data[name].values
        for chosen, look in ((best, FRONT), (~best, OTHERS)):
            plot_sizes(axes, mass[chosen], values[chosen], **look)
        axes.plot(mass[here], values[here], **DESIGN)
    limit_line(panels[0], data)
    panels[0].set_ylabel("Largest displacement (mm)")
    panels[1].set(xlabel="Loose mass (kg)", ylabel="Largest contact force (N)")
    for axes in panels:
        decades(axes)
        axes.margins(0.12)
    for x, size, gap in zip(mass, data["other_displacement"].values, data["other_gap"].values):
        panels[0].annotate(f"{gap:.3g}", (x, size), (0, 6), textcoords="offset points")
    legend(drawn, 2)
    return drawn
