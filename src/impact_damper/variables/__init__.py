"""The registry: what each variable in a dataset is called, measured in, and means.

A module holds the variables of one subject; a name stands in one of them only.
"""

from impact_damper.variables import (
    balance_map,
    harmonic_balance,
    migration,
    motions,
    orbits,
    subharmonic,
)
from impact_damper.variables.variable import Variable

MODULES = (motions, harmonic_balance, migration, subharmonic, orbits)
from impact_damper.variables import contact, harmonic_balance, migration, motions, subharmonic
from impact_damper.variables.variable import Variable

MODULES = (motions, harmonic_balance, migration, subharmonic, contact)
from impact_damper.variables import design_rules, harmonic_balance, migration, motions, subharmonic
from impact_damper.variables.variable import Variable

MODULES = (motions, harmonic_balance, migration, subharmonic, design_rules)
from impact_damper.variables import harmonic_balance, harmonics, migration, motions, subharmonic
from impact_damper.variables.variable import Variable

MODULES = (motions, harmonic_balance, migration, subharmonic, harmonics)
from impact_damper.variables import harmonic_balance, integrators, migration, motions, subharmonic
from impact_damper.variables.variable import Variable

MODULES = (motions, harmonic_balance, migration, subharmonic, integrators)
MODULES = (motions, harmonic_balance, migration, subharmonic, orbits, balance_map)
VARIABLES: dict[str, Variable] = {
    name: entry for module in MODULES for name, entry in module.VARIABLES.items()
}
