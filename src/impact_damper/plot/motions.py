"""Single motions: a phase portrait, a course in time, and a run of migration control."""

import numpy as np
from matplotlib.colors import to_rgb

from impact_damper.plot.sheets import dataset_in, sheet
from impact_damper.plot.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    ROLES,
    axis_label,
    forcing_period,
)

WALLS = {
    1: {"label": "contact, $Z_2 \\geq d_0$", "color": BLUE, "solid_capstyle": "butt"},
    -1: {"label": "contact, $Z_2 \\leq -d_0$", "color": ORANGE, "linestyle": (0, (1.2, 0.5))},
}
# Cycles above which the line of a run of migration control is thin, and above which its envelope is
# drawn instead.
MANY, LONG = 50, 100


def orbit(data, axes=None):
    """Draw a motion: its phase portrait, and its course in time with its contacts.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `simulate`. For a steady motion or a periodic orbit, simulate it from its state.
    axes : sequence of 2 matplotlib.axes.Axes, optional

    Returns
    -------
    list of matplotlib.axes.Axes
        Axes of the phase portrait and of the course in time.

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
    """Draw velocity against displacement of the primary mass, thick in contact."""
    axes.plot(run["displacement"], run["velocity"], color=BLACK, linewidth=0.8)
    for wall, look in WALLS.items():
        velocity = np.where(in_contact(run, wall), run["velocity"], np.nan)
        axes.plot(run["displacement"], velocity, linewidth=3, **look)
    axes.set(xlabel=axis_label(run["displacement"]), ylabel=axis_label(run["velocity"]))


def _time_panel(axes, run):
    """Draw both displacements against time; the line of the relative one is thick in contact."""
    time, relative = run["time"], run["relative_displacement"]
    axes.plot(time, run["displacement"], color=BLACK, label="primary mass, $Z_1$")
    if len(run["contact_wall"]):
        words = "relative to the loose mass, $Z_2$"
        axes.plot(time, relative, color=GREY, linewidth=0.8, label=words)
    for wall, look in WALLS.items():
        chosen = in_contact(run, wall)
        if chosen.any():
            axes.plot(time, np.where(chosen, relative, np.nan), linewidth=3, **look)
    units = run["displacement"].attrs["units"]
    axes.set(
        xlabel=axis_label(time),
        ylabel="Displacement" if units == "1" else f"Displacement ({units})",
    )


def in_contact(run, wall):
    """Return a mask of the times in contact with a wall (1 or -1), shape (time,).

    A contact whose end is not recorded lasts to the last time.
    """
    time = run["time"].values[:, None]
    chosen = run["contact_wall"].values == wall
    begin = run["contact_begin"].values[chosen]
    end = np.nan_to_num(run["contact_end"].values[chosen], nan=np.inf)
    return np.any((begin <= time) & (time <= end), axis=1)


def migration(data, axes=None, span=None):
    """Draw a run of migration control: displacement against time, shaded while the damper is on.

    Of more than a hundred cycles the envelope is drawn.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `migrate`.
    axes : matplotlib.axes.Axes, optional
    span : (float, float), optional
        First and last time to draw; otherwise the whole run.

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
        _draw_course(axes, run, first, last)
        on, off = (run[name].values[np.isfinite(run[name])] for name in ("on_time", "off_time"))
        for begin, end in zip(on, off, strict=True):
            axes.axvspan(begin, end, **ROLES["damper_on"])
        for times, role in ((on, "switched_on"), (off, "switched_off")):
            for time in times:
                axes.axvline(time, **ROLES[role])
        axes.set(
            xlim=(first, last),
            xlabel=axis_label(run["time"]),
            ylabel=axis_label(run["displacement"]),
        )
        axes.tick_params(top=False)
    return axes


def _draw_course(axes, run, first, last):
    """Draw the displacement from `first` to `last`, or the envelope of a long run."""
    time, displacement = run["time"].values, run["displacement"].values
    inside = (time >= first) & (time <= last)
    time, displacement = time[inside], displacement[inside]
    period = forcing_period(run)
    cycles = (last - first) / period
    if cycles <= LONG:
        axes.plot(time, displacement, color=BLACK, linewidth=0.8 if cycles <= MANY else 0.3)
        return
    each = max(1, round(period / (time[1] - time[0])))
    rows = displacement[: len(displacement) // each * each].reshape(-1, each)
    look = {"facecolor": (*to_rgb(BLACK), 0.25), "edgecolor": BLACK, "linewidth": 0.4}
    axes.fill_between(time[: rows.size : each], rows.min(axis=1), rows.max(axis=1), **look)
