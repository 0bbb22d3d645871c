"""Helpers of all plots: checks of datasets, new figures, and legends."""

from contextlib import contextmanager

import matplotlib
import numpy as np
import xarray as xr
from matplotlib import pyplot

from impact_damper.model.bounds import shown
from impact_damper.plot.panels.style import COLUMNS, style


def datasets_in(data, takes, words) -> list[xr.Dataset]:
    """Return the datasets given, one or several, as a list.

    Parameters
    ----------
    data : xarray.Dataset or sequence of xarray.Dataset
    takes : callable
        Maps a dataset to True if it can be drawn.
    words : str
        Names of the functions whose results can be drawn, for messages.

    Raises
    ------
    TypeError
        If there is no dataset, one cannot be drawn, or datasets have different units.
    """
    found = [data] if isinstance(data, xr.Dataset) else data
    if not isinstance(found, (list, tuple)) or not found:
        raise TypeError(f"data = {shown(data)}: must be a result of {words}, or a list of them")
    for each in found:
        if not isinstance(each, xr.Dataset) or not takes(each):
            title = getattr(each, "attrs", {}).get("title", shown(each))
            raise TypeError(f"data = {title!r}: must be a result of {words}, or a list of them")
    units = {each.attrs.get("scales") for each in found}
    if len(units) > 1:
        raise TypeError("data = several: must be of one machine, or all dimensionless")
    return list(found)


def dataset_in(data, takes, words) -> xr.Dataset:
    """Return the single dataset given; arguments as for `datasets_in`.

    Raises
    ------
    TypeError
        If there is no dataset, more than one, or one that cannot be drawn.
    """
    found = datasets_in(data, takes, words)
    if len(found) > 1:
        raise TypeError(f"data = {len(found)} datasets: must be one result of {words}")
    return found[0]


@contextmanager
def looks(ax):
    """Return a context with the style of the paper's figures; given axes keep their own style.

    In a notebook, the first figure loads a backend that makes matplotlib interactive. This setting
    must outlive the context; otherwise the notebook would show only the first figure.
    """
    if ax is not None:
        yield
        return
    with style():
        yield
        interactive = matplotlib.is_interactive()
    matplotlib.interactive(interactive)


def axes_for(ax, count=1, height=3.6):
    """Return the axes to draw on as a list; new axes, `height` inches high, if `ax` is None.

    Raises
    ------
    TypeError
        If `ax` is not `count` axes.
    """
    if ax is None:
        width = COLUMNS["double"]
        _, made = pyplot.subplots(
            1, count, figsize=(width, height), layout="constrained", squeeze=False
        )
        return list(made[0])
    given = list(np.ravel(np.array(ax, object)))
    if len(given) != count or not all(hasattr(each, "plot") for each in given):
        raise TypeError(f"ax = {shown(ax)}: must be {count} Axes of matplotlib")
    return given


def key(axes, columns=2):
    """Add a legend above the axes, in which each label is listed once."""
    handles, labels = axes.get_legend_handles_labels()
    entries = dict(reversed(list(zip(labels, handles, strict=True))))
    if entries:
        order = list(dict.fromkeys(labels))
        axes.legend(
            [entries[label] for label in order],
            order,
            loc="lower left",
            bbox_to_anchor=(0.0, 1.01),
            borderaxespad=0.0,
            ncols=columns,
        )
