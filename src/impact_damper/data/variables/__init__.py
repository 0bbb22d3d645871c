"""The registry: what each variable in a dataset is called, measured in, and means.

A module holds the variables of one subject; a name stands in one of them only.
"""

from impact_damper.data.variables import (
    accuracy,
    balance_map,
    contact,
    design_rules,
    harmonic_balance,
    harmonics,
    integrators,
    migration,
    motions,
    orbits,
    studies,
    subharmonic,
)
from impact_damper.data.variables.variable import Variable

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
    accuracy,
    studies,
)
VARIABLES: dict[str, Variable] = {}
for module in MODULES:
    twice = VARIABLES.keys() & module.VARIABLES.keys()
    if twice:
        raise ValueError(f"{', '.join(sorted(twice))}: stands in two modules of the registry")
    VARIABLES |= module.VARIABLES
