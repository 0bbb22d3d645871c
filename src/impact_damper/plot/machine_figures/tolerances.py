"""Worst displacement against the share of quiet starts, for values changed within tolerances.

A start is a random initial state. It is quiet if it leads to a quiet motion, one below the
displacement limit of the design.
"""

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.machine_figures.looks import STAR, decades, limit_line, plot_sizes
from impact_damper.plot.style import BLUE, GREY, ORANGE, figure, legend, style

CAPTION = """
Each point is one damper and machine whose values differ from the nominal ones within their
tolerances. Squares: corners, where each value is at one end of its tolerance. Star: nominal values.
Both have new random starts, which the design did not use. Circles: samples spread over the
tolerances, and the same corners and nominal values with fewer starts; with these the design decided
what to promise. Horizontal: share of starts over the band that lead to quiet motions, with its 95 %
interval. Vertical: largest displacement of all motions found.
"""
SAMPLES = {"color": BLUE, "marker": "o", "markersize": 3.2, "label": "sample or corner"}
CORNERS = {"color": ORANGE, "marker": "s", "markersize": 3.2, "label": "corner, new starts"}
NOMINAL = STAR | {"label": "nominal, new starts"}
ASKED = {"color": GREY, "linewidth": 0.8, "linestyle": (0, (1, 1.2)), "label": "share required"}
BARS = {"linestyle": "none", "elinewidth": 0.6, "markerfacecolor": "none"}


@style()
def draw_tolerances(data):
    """Return the figure of the dataset of `stages.machines.design_damper`."""
    drawn = figure("single", 3.3)
    axes = drawn.subplots()
    corners = slice(1, None)
    for name, chosen, look in (
        ("sample", slice(None), SAMPLES | BARS),
        ("corner", corners, CORNERS | BARS),
        ("corner", slice(1), NOMINAL),
    ):
        share = data[f"{name}_share"].values[chosen]
        size = data[f"{name}_displacement"].values[chosen]
        if not len(size):
            continue
        value = share[:, 0]
        if look is NOMINAL:
            plot_sizes(axes, value, size, **look)
        else:
            bars = abs(share[:, 1:].T - value)
            axes.errorbar(value, size, xerr=bars, **look)
    limit_line(axes, data)
    axes.axvline(parameters_of(data)["share"], **ASKED)
    axes.set(xlabel="Share of quiet starts over the band", ylabel="Largest displacement (mm)")
    decades(axes)
    legend(drawn, 2)
    return drawn
