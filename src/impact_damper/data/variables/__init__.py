"""Registry of the variables in all datasets: name, description, symbol, units, flags.

Each module holds the variables of one subject. A name may occur in one module only.
"""

from impact_damper.data.variables import (
    absorbers,
    accuracy,
    balance_map,
    basins,
    contact,
    costs,
    design_rules,
    designs,
    harmonic_balance,
    harmonics,
    integrators,
    machines,
    migration,
    motions,
    orbits,
    policies,
    published,
    studies,
    subharmonic,
    transients,
)
from impact_damper.data.variables.variable import Variable

MODULES = (
    motions,
    harmonic_balance,
    migration,
    basins,
    subharmonic,
    orbits,
    harmonics,
    design_rules,
    contact,
    integrators,
    balance_map,
    accuracy,
    studies,
    policies,
    published,
    machines,
    absorbers,
    costs,
    transients,
    designs,
)
VARIABLES: dict[str, Variable] = {}
for module in MODULES:
    twice = VARIABLES.keys() & module.VARIABLES.keys()
    if twice:
        raise ValueError(f"{', '.join(sorted(twice))}: registered in two modules")
    VARIABLES |= module.VARIABLES
