"""Text for the ranges that a design found.

An end of a range can be unknown, because the search ended before the range did.
"""

import numpy as np

from impact_damper.data.datasets import flag


def quiet_gaps(data) -> str:
    """Return the text of `known_range` for the quiet gaps (mm) around the gap to build."""
    return known_range(
        data["cliff_gap"].values, data["cliff_status"].values == flag("cliff_status", "range_ends")
    )


def stable_range(data, parameter) -> str:
    """Return the text of `known_range` for the stable quiet orbit; "" if there is none.

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
    """Return the text of a range.

    An end is open if the search stopped before the range ended. The range then extends at least to
    the number, and the text adds "or less" or "or more".
    """
    low, high = (f"{end:.4g}" for end in ends)
    return f"{low}{' or less' * bool(is_open[0])} to {high}{' or more' * bool(is_open[1])}"
