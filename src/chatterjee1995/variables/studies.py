"""Studies: outcomes of random starts over a grid of parameters."""

from impact_damper.data.variables.variable import OUTCOME, Variable

AXES = ("mass_ratio", "clearance", "frequency", "restitution")
OUTCOMES = tuple(name for name, value in OUTCOME.items() if value >= 0)

VARIABLES = {
    "cell": Variable(("cell",), "number of the cell in the grid, the last axis fastest"),
    "counted_outcome": Variable(("counted_outcome",), "outcome of a random start"),
    "outcome_count": Variable(
        ("cell", "counted_outcome"), "number of random starts with the outcome"
    ),
    "quiet_count": Variable(
        ("cell",),
        "number of random starts that lead to the quiet orbit, which has period 1 and touches each "
        "wall once in a cycle, symmetrically",
    ),
    "best_clearance": Variable(
        ("mass_ratio", "frequency", "restitution"),
        "clearance of the grid at which the largest motion that starts lead to is smallest",
        "d0",
    ),
}
