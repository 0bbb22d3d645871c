"""Ranges of a design in words, whose ends may be where the search ended."""

import numpy as np

from impact_damper.data.datasets import flag


def quiet_gaps(data) -> str:
    """Return the ends of the quiet gaps (mm) around the gap to build, as `known_range`."""
    return known_range(
        data["cliff_gap"].values, data["cliff_status"].values == flag("cliff_status", "range_ends")
    )


def stable_range(data, parameter) -> str:
    """Return where the quiet orbit is stable, as `known_range`; "" without an orbit.

    Parameters
    ----------
    data : xarray.Dataset
    parameter : str
        "gap" (mm) or "force" (multiple of the nominal one).
    """
    ends, event = data[f"stability_{parameter}"].values, f"stability_{parameter}_event"
    if not np.isfinite(ends).all():
        return ""
    return known_range(ends, data[event].values == flag(event, "range_ends"))


def known_range(ends, is_open) -> str:
    """Return two numbers in words, from `low` to `high`.

    Where the search ended before the range did, at an open end, the number is a bound only.
    """
    low, high = (f"{end:.4g}" for end in ends)
    return f"{low}{' or less' * bool(is_open[0])} to {high}{' or more' * bool(is_open[1])}"
