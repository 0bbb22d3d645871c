"""Plots of results, such as `impact_damper.plot.response(data)`.

Each function except `conclusion` draws on the given `axes`, without a legend: call `axes.legend()`.
Without `axes` the function makes a figure with a legend.
"""

from impact_damper.plot.basin_plane import basins
from impact_damper.plot.branches import branch
from impact_damper.plot.designs import conclusion, design
from impact_damper.plot.motions import migration, orbit
from impact_damper.plot.responses import response
from impact_damper.plot.stacked_shares import shares
from impact_damper.plot.sweeps import sweep

__all__ = [
    "basins",
    "branch",
    "conclusion",
    "design",
    "migration",
    "orbit",
    "response",
    "shares",
    "sweep",
]
