"""Helpers of the public plots: checks of datasets, and the axes to draw on."""

from contextlib import contextmanager

import matplotlib
import numpy as np
import xarray as xr
from matplotlib import pyplot

from impact_damper.model.bounds import shown
from impact_damper.plot import style


def datasets_in(data, takes, words) -> list[xr.Dataset]:
    """Return one or several datasets as a list.

    The function `takes` returns whether a dataset is allowed. `words` names the functions whose
    results are allowed. Other datasets raise TypeError. Several datasets must all be dimensionless,
    or all be of the same machine; otherwise raise TypeError.
    """
    found = [data] if isinstance(data, xr.Dataset) else data
    if not isinstance(found, (list, tuple)) or not found:
        raise TypeError(f"data = {shown(data)}: must be a result of {words}, or a list of them")
    for each in found:
        if not isinstance(each, xr.Dataset) or not takes(each):
            title = getattr(each, "attrs", {}).get("title", shown(each))
            raise TypeError(f"data = {title!r}: must be a result of {words}, or a list of them")
    if len({each.attrs.get("scales") for each in found}) > 1:
        raise TypeError("data = several: must be of one machine, or all dimensionless")
    return list(found)


def dataset_in(data, takes, words) -> xr.Dataset:
    """Check `data` as `datasets_in` does. Return the dataset. Several datasets raise TypeError."""
    found = datasets_in(data, takes, words)
    if len(found) > 1:
        raise TypeError(f"data = {len(found)} datasets: must be one result of {words}")
    return found[0]


@contextmanager
def sheet(axes, count=1, height=3.6, columns=3):
    """Return a context that yields the given axes, or `count` axes of a new figure.

    A new figure is `height` inches high. Its legend has `columns` columns; 0 means no legend.
    """
    if axes is not None:
        given = list(np.ravel(np.array(axes, object)))
        if len(given) != count or not all(hasattr(each, "plot") for each in given):
            raise TypeError(f"axes = {shown(axes)}: must be {count} Axes of matplotlib")
        yield given
        return
    with style.context():
        size = style.COLUMNS["double"], height
        drawn, panels = pyplot.subplots(1, count, figsize=size, layout="constrained", squeeze=False)
        yield list(panels[0])
        if columns:
            style.legend(drawn, columns)
        # In a notebook the first figure turns on interactive mode. This mode must stay on.
        interactive = matplotlib.is_interactive()
    matplotlib.interactive(interactive)
