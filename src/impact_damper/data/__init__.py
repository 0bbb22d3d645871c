"""Labelled datasets, the registry of their variables, and their files."""

# These register their variables.
from impact_damper.data import design_variables, motion_variables  # noqa: F401
