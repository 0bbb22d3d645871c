"""Plots for the choice of a damper: a sweep of the clearance, and a finished design."""

from impact_damper.figures.machines.cliff import share_panel, size_panel
from impact_damper.figures.machines.response import response_panel
from impact_damper.figures.optimum import sweeps_panel
from impact_damper.figures.style import CURVES
from impact_damper.plot.drawing import axes_for, dataset_in, datasets_in, key, looks


def sweep(data, *, ax=None):
    """Draw the largest displacement of the quiet motion against clearance, and its minimum.

    Parameters
    ----------
    data : xarray.Dataset or list of xarray.Dataset
        Up to five results of `clearance_sweep`.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    TypeError
        If something else is given.
    """
    given = datasets_in(data, lambda each: "quiet_displacement" in each, "clearance_sweep")
    if len(given) > len(CURVES):
        raise TypeError(f"data = {len(given)} datasets: must be at most {len(CURVES)}")
    with looks(ax):
        (axes,) = axes_for(ax)
        sweeps_panel(axes, given)
        key(axes, 3)
    return axes


def design(data, *, ax=None):
    """Draw a design: the response, and displacement and share of quiet starts against the gap.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `design_damper`.
    ax : sequence of 3 matplotlib.axes.Axes, optional

    Returns
    -------
    list of matplotlib.axes.Axes

    Raises
    ------
    TypeError
        If something else is given.
    """
    found = dataset_in(data, lambda each: "design_gap" in each, "design_damper")
    with looks(ax):
        axes = axes_for(ax, 3, height=4.2)
        for panel, each in zip((response_panel, size_panel, share_panel), axes, strict=True):
            panel(each, found)
            key(each, 1)
        for each in axes[1:]:
            each.set_xlabel("Gap, full play (mm)")
    return axes
