"""Plots of one's own results, such as `impact_damper.plot.response(data)`.

Each function takes one result or a list of results of the package's public functions, draws them
like the figures of the paper, and returns the matplotlib axes. It draws on `ax`, or on a new
figure.
"""

from impact_damper.plot.designs import design, sweep
from impact_damper.plot.motions import basins, migration, orbit
from impact_damper.plot.responses import branch, response, shares

__all__ = ["basins", "branch", "design", "migration", "orbit", "response", "shares", "sweep"]


def __getattr__(name):
    from impact_damper.model.names import nearest

    raise AttributeError(f"module {__name__!r} has no attribute {name!r}{nearest(name, __all__)}")
