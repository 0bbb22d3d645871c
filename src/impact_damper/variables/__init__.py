"""The registry: what each variable in a dataset is called, measured in, and means.

A module holds the variables of one subject; a name stands in one of them only.
"""

from impact_damper.variables import (
    balance_map,
    contact,
    design_rules,
    harmonic_balance,
    harmonics,
    integrators,
    migration,
    motions,
    orbits,
    subharmonic,
)
from impact_damper.variables.variable import Variable

MODULES = (
    motions,
    harmonic_balance,
    migration,
    subharmonic,
    orbits,
    harmonics,
    design_rules,
    contact,
    integrators,
    balance_map,
)
VARIABLES: dict[str, Variable] = {
    name: entry for module in MODULES for name, entry in module.VARIABLES.items()
}
