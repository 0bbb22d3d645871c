"""Studies: outcomes of random starts over a grid of parameters."""

from impact_damper.data.variables import OUTCOME, register

AXES = ("mass_ratio", "clearance", "frequency", "restitution")
OUTCOMES = tuple(name for name, value in OUTCOME.items() if value >= 0)

register(
    """
cell | cell | | | number of the cell in the grid, the last axis fastest
counted_outcome | counted_outcome | | | outcome of a random start
outcome_count | cell counted_outcome | | | number of random starts with the outcome
quiet_count | cell | | | number of random starts that lead to the quiet orbit, which has period 1
  and touches each wall once in a cycle, symmetrically
best_clearance | mass_ratio frequency restitution | | d0 | clearance of the grid at which the
  largest motion that starts lead to is smallest
    """,
)
