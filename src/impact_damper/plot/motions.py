"""Plots of single motions: phase portrait, displacement over time, run of migration control."""

import numpy as np

from impact_damper.plot import style
from impact_damper.plot.sheets import dataset_in, sheet

WALLS = {
    1: style.line("contact, $Z_2 \\geq d_0$", style.BLUE, linewidth=3, solid_capstyle="butt"),
    -1: style.line(
        "contact, $Z_2 \\leq -d_0$", style.ORANGE, linewidth=3, linestyle=(0, (1.2, 0.5))
    ),
}
DAMPER_ON = style.shading("damper on", style.PALE_SKY)
SWITCHED = {
    "on_time": style.line("switched on", style.VERMILION),
    "off_time": style.line("switched off", style.BLUE, linestyle=(0, (3, 1.5))),
}
# Line of a run of migration control: THIN if at least MANY samples are drawn, otherwise LINE.
MANY = 2500
LINE, THIN = {"linewidth": 0.8}, {"linewidth": 0.3, "alpha": 0.7, "rasterized": True}


def orbit(data, axes=None):
    """Draw a phase portrait of a motion, and displacements and contacts over time.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `simulate`. The run may start from the state of a steady motion or orbit.
    axes : sequence of 2 matplotlib.axes.Axes, optional

    Returns
    -------
    list of matplotlib.axes.Axes
        Axes of the phase portrait, axes of displacements over time.

    Examples
    --------
    >>> import impact_damper as idm
    >>> motion = idm.simulate(idm.Oscillator(0.215), idm.Damper(0.12, 2.0), 2.0, (1, 0.5, 0, 0))
    >>> axes = idm.plot.orbit(motion)
    """
    run = dataset_in(data, lambda each: {"velocity", "contact_begin"} <= each.keys(), "simulate")
    with sheet(axes, 2) as axes:
        phase_panel(axes[0], run)
        _time_panel(axes[1], run)
    return axes


def phase_panel(axes, run):
    """Draw velocity against displacement of the primary mass. The line is thick in contacts."""
    axes.plot(run["displacement"], run["velocity"], color=style.BLACK, linewidth=0.8)
    for wall, look in WALLS.items():
        axes.plot(run["displacement"], run["velocity"].where(_in_contact(run, wall)), **look)
    axes.set(xlabel=style.axis_label(run["displacement"]), ylabel=style.axis_label(run["velocity"]))


def _time_panel(axes, run):
    time, relative = run["time"], run["relative_displacement"]
    axes.plot(time, run["displacement"], color=style.BLACK, label="primary mass, $Z_1$")
    if len(run["contact_wall"]):
        words = "relative to the loose mass, $Z_2$"
        axes.plot(time, relative, color=style.GREY, linewidth=0.8, label=words)
    for wall, look in WALLS.items():
        chosen = _in_contact(run, wall)
        if chosen.any():
            axes.plot(time, relative.where(chosen), **look)
    units = run["displacement"].attrs["units"]
    words = "Displacement" if units == "1" else f"Displacement ({units})"
    axes.set(xlabel=style.axis_label(time), ylabel=words)


def _in_contact(run, wall):
    chosen = run["contact_wall"].values == wall
    contacts = run[["contact_begin", "contact_end"]].isel(contact=chosen)
    begun = contacts["contact_begin"] <= run["time"]
    return (begun & (run["time"] <= contacts["contact_end"].fillna(np.inf))).any("contact")


def migration(data, axes=None, span=None):
    """Draw a run of migration control: displacement against time, shaded while the damper is on.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `migrate`.
    axes : matplotlib.axes.Axes, optional
    span : (float, float), optional
        First and last time to draw, by default of the whole run.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import impact_damper as idm
    >>> run = idm.migrate(idm.Oscillator(0.215), idm.Damper(0.12, 2.0), 1.95, seed=1)
    >>> axes = idm.plot.migration(run)
    """
    run = dataset_in(data, lambda each: {"on_time", "displacement"} <= each.keys(), "migrate")
    with sheet(axes) as (axes,):
        first, last = run["time"].values[[0, -1]] if span is None else span
        drawn = run["displacement"].sel(time=slice(first, last))
        axes.plot(drawn["time"], drawn, color=style.BLACK, **(LINE if drawn.size < MANY else THIN))
        switched = [run[name].values[np.isfinite(run[name])] for name in SWITCHED]
        for begin, end in zip(*switched, strict=True):
            axes.axvspan(begin, end, **DAMPER_ON)
        for times, look in zip(switched, SWITCHED.values(), strict=True):
            for time in times:
                axes.axvline(time, **look)
        axes.set_xlim(first, last)
        axes.set_xlabel(style.axis_label(run["time"]))
        axes.set_ylabel(style.axis_label(run["displacement"]))
        axes.tick_params(top=False)
    return axes
