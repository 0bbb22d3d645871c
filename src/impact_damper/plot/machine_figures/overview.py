"""All machines: displacement against frequency, and displacement and share over the gap.

The share is the fraction of random starts (initial states) that lead to a quiet motion, one below
the displacement limit of the design.
"""

import json
from string import ascii_lowercase

from impact_damper.plot.machine_figures.cliff import share_panel, size_panel
from impact_damper.plot.machine_figures.response import response_panel
from impact_damper.plot.style import figure, legend, style

CAPTION = """
Left: largest displacement against forcing frequency, without the damper and with the damper
designed. Middle: largest displacement over the band against the gap. Right: share of random starts
that lead to quiet motions, at the worst frequency of the band. Shaded: tolerance of the gap. Star:
smallest stable quiet orbit.
"""


@style({"axes.labelsize": 8.0, "lines.markersize": 2.6})
def draw_machines(*, machines):
    """Draw the response of each machine and the choice of its gap.

    Parameters
    ----------
    machines : list of xarray.Dataset
        Datasets of the stage machines.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 1.0 + 1.75 * len(machines))
    panels = drawn.subplots(len(machines), 3, squeeze=False)
    for (left, middle, right), data in zip(panels, machines, strict=True):
        response_panel(left, data)
        size_panel(middle, data)
        share_panel(right, data)
        right.set_xlim(middle.get_xlim())
    for axes in panels[-1, 1:]:
        axes.set_xlabel("Gap, full play (mm)")
    for axes, letter, data in zip(panels[:, 0], ascii_lowercase, machines, strict=False):
        axes.set_title(f"({letter}) {row_title(data)}", loc="left")
    legend(drawn, 4)
    return drawn


def row_title(data) -> str:
    """Return the name of a machine and its mass."""
    name = data.attrs["name"].replace("_", " ")
    return f"{name}, {json.loads(data.attrs['machine'])['mass']:g} kg"
