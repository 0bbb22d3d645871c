"""Text for two ranges that the design of a damper computes: quiet gaps, and the stable quiet orbit.

In a quiet gap nearly all starts lead to motions of small displacement (quiet motions). An end of a
range can be unknown, because the search stopped before the range ended.
"""

import numpy as np

from impact_damper.data.datasets import flag


def quiet_gaps(data) -> str:
    """Return the range of quiet gaps (mm) around the chosen gap, as text of `known_range`."""
    return known_range(
        data["cliff_gap"].values, data["cliff_status"].values == flag("cliff_status", "range_ends")
    )


def stable_range(data, parameter) -> str:
    """Return the range in which the quiet orbit is stable as text; "" if it is stable nowhere.

    `known_range` makes the text.

    Parameters
    ----------
    data : xarray.Dataset
    parameter : str
        "gap" (mm) or "force" (multiple of the nominal force).
    """
    ends, event = data[f"stability_{parameter}"].values, f"stability_{parameter}_event"
    if not np.isfinite(ends).all():
        return ""
    return known_range(ends, data[event].values == flag(event, "range_ends"))


def known_range(ends, is_open) -> str:
    """Return the text of a range, such as "1.2 to 3.4 or more".

    An end is open if the search stopped before the range ended. The range then extends at least to
    this number, and the text adds "or less" or "or more".

    Parameters
    ----------
    ends : sequence of float
        Least and greatest known value.
    is_open : sequence of bool
        Whether each of the two ends is open.
    """
    low, high = (f"{end:.4g}" for end in ends)
    return f"{low}{' or less' * bool(is_open[0])} to {high}{' or more' * bool(is_open[1])}"
