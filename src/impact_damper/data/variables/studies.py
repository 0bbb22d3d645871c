"""Studies: what random starts come to over a grid."""

from impact_damper.data.variables.variable import OUTCOME, Variable

AXES = ("mass_ratio", "clearance", "frequency", "restitution")
OUTCOMES = tuple(name for name, value in OUTCOME.items() if value >= 0)

VARIABLES = {
    "cell": Variable(("cell",), "number of the cell in the grid, the last axis fastest"),
    "counted_outcome": Variable(("counted_outcome",), "what a start came to"),
    "outcome_count": Variable(("cell", "counted_outcome"), "random starts that came to it"),
    "quiet_count": Variable(("cell",), "random starts that lead to the quiet motion"),
    "best_clearance": Variable(
        ("mass_ratio", "frequency", "restitution"),
        "clearance of the grid at which the largest displacement is least",
        "d0",
    ),
}
