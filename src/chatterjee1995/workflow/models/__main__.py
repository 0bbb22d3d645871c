"""Print the reference of the configuration."""

from chatterjee1995.workflow.models.reference import reference

print(reference(), end="")
