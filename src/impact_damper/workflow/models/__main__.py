"""Print the reference of the configuration."""

from impact_damper.workflow.models.reference import reference

print(reference(), end="")
