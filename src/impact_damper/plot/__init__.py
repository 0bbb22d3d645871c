"""Plots of results, such as `impact_damper.plot.response(data)`.

Each function takes one result or a list of results of the public functions, draws on `axes` or on a
new figure, and returns the matplotlib axes. New figures have a legend; on given axes
`axes.legend()` adds one. The figures of the paper are made of these plots.
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
