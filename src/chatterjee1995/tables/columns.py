"""Columns that several tables have."""

from impact_damper.data.datasets import parameters_of

HEADS = {
    "damping": "damping h",
    "linear_frequency": "linear frequency ωl",
    "frequency": "forcing frequency Ω",
    "mass_ratio": "mass ratio rm",
    "clearance": "clearance d0",
    "restitution": "restitution e",
    "contact_stiffness": "contact stiffness r1",
}
DAMPER = ("mass_ratio", "clearance", "restitution")


def parameter_columns(data, *names) -> dict:
    """Return the values of those named parameters that a dataset has."""
    parameters = parameters_of(data)
    return {HEADS[name]: parameters[name] for name in names if name in parameters}
