"""Plots for the choice of a damper: a sweep of the clearance, and a finished design.

A quiet motion is a small motion with damper. A start is a random initial state; a quiet start leads
to a quiet motion.
"""

from impact_damper.plot.drawing import axes_for, dataset_in, datasets_in, key, looks
from impact_damper.plot.machine_figures.cliff import share_panel, size_panel
from impact_damper.plot.machine_figures.response import response_panel
from impact_damper.plot.panels.optimum import sweeps_panel
from impact_damper.plot.panels.style import CURVES


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
        If `data` or `ax` is of another type.

    Examples
    --------
    >>> import impact_damper as idm
    >>> found = idm.clearance_sweep(
    ...     idm.Oscillator(0.215), {"mass_ratio": 0.12}, 2.0, [2.2, 2.3, 2.4], starts=4
    ... )
    >>> axes = idm.plot.sweep(found)
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
        If `data` or `ax` is of another type.

    Examples
    --------
    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
    >>> found = idm.design_damper(
    ...     machine, mass=1.2, band=(20.4, 20.7), restitution=0.6, contact_stiffness=2e7
    ... )  # doctest: +SKIP
    >>> axes = idm.plot.design(found)  # doctest: +SKIP
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
