"""Plots of one's own results: `impact_damper.plot.response(data)`, and likewise the others.

Each function takes what the public functions of the package return, alone or in a list, draws it
with the functions that draw the figures of the paper, and returns the Axes. `ax` is where to draw;
without it a figure is made.
"""

from impact_damper.plot.designs import design, sweep
from impact_damper.plot.motions import basins, migration, orbit
from impact_damper.plot.responses import branch, response, shares

__all__ = ["basins", "branch", "design", "migration", "orbit", "response", "shares", "sweep"]


def __getattr__(name):
    from impact_damper.system.names import nearest

    raise AttributeError(f"module {__name__!r} has no attribute {name!r}{nearest(name, __all__)}")
