"""Quantities of a machine and its damper that may deviate from their nominal values."""

from collections.abc import Mapping

from impact_damper.model.bounds import shown
from impact_damper.model.units import check_si

# VARIED: names of the quantities. "stiffness", "damping" and "force" belong to the machine.
# NOMINAL: factors of these quantities without a deviation.
# TOLERANCES: largest relative deviations by default.
VARIED = ("gap", "restitution", "contact_stiffness", "stiffness", "damping", "force")
NOMINAL = (1.0,) * len(VARIED)
TOLERANCES = {"gap": 0.2}


def checked_tolerances(tolerances) -> dict:
    """Return the largest relative deviations as numbers, keyed by names of VARIED.

    Raises
    ------
    TypeError, ValueError
        If a name or a value is not allowed.
    """
    if not isinstance(tolerances, Mapping):
        raise TypeError(f"tolerances = {shown(tolerances)}: must be a dictionary")
    found = {}
    for name, value in tolerances.items():
        if name not in VARIED:
            raise ValueError(f"tolerances = {shown(name)}: must be of {', '.join(VARIED)}")
        found[name] = check_si(
            f"tolerances[{name!r}]",
            value,
            "number",
            least=0,
            most=0.9,
            why="relative deviation: at 1 the nominal value would become 0",
        )
    return found
