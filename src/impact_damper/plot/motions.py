"""Plots of single motions, of migration control, and of basins of attraction.

Migration control takes an oscillator from one motion to another by switching the damper.
"""

import numpy as np

from impact_damper.data.datasets import parameters_of, system_of
from impact_damper.motions.simulate import simulate
from impact_damper.plot.drawing import axes_for, dataset_in, key, looks
from impact_damper.plot.panels.basins import draw_plane
from impact_damper.plot.panels.migration import draw_run
from impact_damper.plot.panels.motion import phase_panel, time_panel
from impact_damper.plot.panels.style import axis_label


def orbit(data, *, ax=None):
    """Draw a motion: its phase portrait, and its course in time with its contacts.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `simulate`, `steady_motion` or `periodic_orbit`. For the last two, one period is
        simulated from the state in the dataset.
    ax : sequence of 2 matplotlib.axes.Axes, optional

    Returns
    -------
    list of matplotlib.axes.Axes
        Axes of the phase portrait and of the course in time.

    Raises
    ------
    TypeError
        If `data` or `ax` is of another type.

    Examples
    --------
    >>> import impact_damper as idm
    >>> motion = idm.simulate(idm.Oscillator(0.215), idm.Damper(0.12, 2.0), 2.0, (1, 0.5, 0, 0))
    >>> axes = idm.plot.orbit(motion)
    """
    words = "simulate, steady_motion or periodic_orbit"
    found = dataset_in(data, _is_motion, words)
    run = found if "time" in found.coords else _one_period(found)
    with looks(ax):
        left, right = axes_for(ax, 2)
        phase_panel(left, run)
        time_panel(right, run)
        key(right, 1)
    return [left, right]


def _is_motion(data):
    """Return whether a dataset holds a run, a steady motion or a single orbit."""
    run = {"displacement", "velocity", "contact_begin"} <= data.keys() and "time" in data.coords
    single = data["state"].dims == ("component",) if "state" in data else False
    return run or single or data.get("orbit_state", np.empty(0)).shape == (1, 4)


def _one_period(data):
    """Return a run over one period of a steady motion or an orbit."""
    state = data["state"] if "state" in data else data["orbit_state"]
    made = parameters_of(data)
    periods = max(1, int(data["period"]) if "period" in data else made["period"])
    system, damper = system_of(data)
    frequency = system.scales.to_si(made["frequency"], "frequency")
    return simulate(system, damper, frequency, state, periods=periods)


def basins(data, *, ax=None):
    """Draw basins of attraction: the motion to which each state of a plane leads.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `basins`.
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
    >>> axes = idm.plot.basins(idm.basins(idm.Oscillator(0.215), None, 1.85, cells=40))
    """
    found = dataset_in(data, lambda each: "basin_label" in each, "basins")
    with looks(ax):
        (axes,) = axes_for(ax, height=5.0)
        draw_plane(axes, found)
    return axes


def migration(data, *, ax=None):
    """Draw a run of migration control: displacement against time, shaded while the damper is on.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `migrate`.
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
    >>> run = idm.migrate(idm.Oscillator(0.215), idm.Damper(0.12, 2.0), 1.95, seed=1)
    >>> axes = idm.plot.migration(run)
    """
    run = dataset_in(data, lambda each: {"on_time", "displacement"} <= each.keys(), "migrate")
    with looks(ax):
        (axes,) = axes_for(ax)
        draw_run(axes, run, run["time"].values[[0, -1]], 0.4)
        axes.set(xlabel=axis_label(run["time"]), ylabel=axis_label(run["displacement"]))
        key(axes, 3)
    return axes
