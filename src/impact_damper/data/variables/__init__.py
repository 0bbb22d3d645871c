"""Registry of the variables in all datasets: name, description, symbol, units, flags.

Each module holds the variables of one subject. A name may occur in one module only.
"""

from impact_damper.data.variables import (
    absorbers,
    basins,
    costs,
    designs,
    harmonic_balance,
    machines,
    migration,
    motions,
    orbits,
    transients,
)
from impact_damper.data.variables.variable import Variable

VARIABLES: dict[str, Variable] = {}


def register(*modules) -> None:
    """Add the variables of modules, in their constant `VARIABLES`, to the registry."""
    for module in modules:
        twice = VARIABLES.keys() & module.VARIABLES.keys()
        if twice:
            raise ValueError(f"{', '.join(sorted(twice))}: registered in two modules")
        VARIABLES.update(module.VARIABLES)


register(
    absorbers,
    basins,
    costs,
    designs,
    harmonic_balance,
    machines,
    migration,
    motions,
    orbits,
    transients,
)
