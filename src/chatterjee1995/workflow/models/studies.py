"""Studies: motions from random starts (initial states) over a grid of dampers and frequencies."""

import math

from chatterjee1995.variables.studies import AXES
from chatterjee1995.workflow.models.system import (
    BOUNDS,
    MEANINGS,
    PARAMETERS,
    WithOscillator,
    range_of,
)
from impact_damper.command.messages import dotted, problem
from impact_damper.command.values import number_or_range


def axis(name):
    """Return the type of an axis of the grid: a value, or a range with its number of points."""
    several = range_of(PARAMETERS[name], points=True)
    return number_or_range(several, f"{MEANINGS[name]}, one value or an even range", **BOUNDS[name])


class Study(WithOscillator):
    """Outcomes of random starts over a grid of mass ratio, clearance, frequency and restitution."""

    mass_ratio: axis("mass_ratio")
    clearance: axis("clearance")
    frequency: axis("frequency")
    restitution: axis("restitution")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        if self.cells() < config.chunks:
            reason = f"must be at most {self.cells()} (the cells of {dotted(path)})"
            yield problem(("chunks",), config.chunks, reason)

    def cells(self) -> int:
        """Return the number of combinations of the points of the axes."""
        return math.prod(points(getattr(self, key)) for key in AXES)


def points(given) -> int:
    """Return the number of points of an axis, which is a number or a range."""
    return getattr(given, "points", 1)


SECTIONS = {"studies": Study}
