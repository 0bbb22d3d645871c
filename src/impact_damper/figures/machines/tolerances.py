"""Tolerance cloud: worst displacement against quiet share, of samples and of unseen corners."""

from impact_damper.data.datasets import parameters_of
from impact_damper.figures.machines.looks import STAR, decades, limit_line, plot_sizes
from impact_damper.figures.style import BLUE, GREY, ORANGE, figure, legend, style

CAPTION = """
Each point is one damper and machine with all values off within their tolerances: samples spread
over the tolerances; corners, where every value is off by its whole tolerance; and the corners again
with starts that the design had not seen. Horizontal: share of the starts over the band that end
quiet, with its 95 % interval. Vertical: the largest displacement of any of them.
"""
SAMPLES = {"color": BLUE, "marker": "o", "markersize": 3.2, "label": "sample of the tolerances"}
CORNERS = {"color": ORANGE, "marker": "s", "markersize": 3.2, "label": "corner, unseen starts"}
NOMINAL = STAR | {"label": "nominal, unseen starts"}
ASKED = {"color": GREY, "linewidth": 0.8, "linestyle": (0, (1, 1.2)), "label": "share asked for"}
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
