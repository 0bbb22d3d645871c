"""Response of the oscillator without a damper (paper: figure 2; figure kind `free`)."""

from impact_damper.plot.panels.branches import draw_free_orbits
from impact_damper.plot.panels.style import axis_label, figure, legend, letter_panels, style

CAPTION = """
Largest displacement of the periodic orbits without a damper against forcing frequency. Drawn is
every branch with a settled motion. Triangles: period of three cycles. Short vertical lines: other
periods.
"""


@style()
def draw_free(*, branches):
    """Draw the largest displacement of orbits without a damper, one panel for each oscillator.

    Parameters
    ----------
    branches : list of xarray.Dataset
        Datasets of the stage branches without a damper.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 3.4)
    panels = drawn.subplots(1, len(branches), squeeze=False)[0]
    for axes, free in zip(panels, branches, strict=True):
        draw_free_orbits(axes, free)
        value = free["followed_value"].values
        axes.set(
            xlabel="Forcing frequency, $\\Omega$",
            ylabel=axis_label(free["orbit_displacement"]),
            xlim=(value.min(), value.max()),
        )
        axes.set_ylim(bottom=0)
    if len(panels) > 1:
        letter_panels(panels)
    legend(drawn, 2)
    return drawn
