"""The paper of Chatterjee, Mallik and Ghosh (1995), recomputed with the library `impact_damper`."""

from chatterjee1995.variables import (
    accuracy,
    balance_map,
    contact,
    design_rules,
    harmonics,
    integrators,
    policies,
    published,
    studies,
    subharmonic,
)
from impact_damper.data.variables import register

register(
    accuracy,
    balance_map,
    contact,
    design_rules,
    harmonics,
    integrators,
    policies,
    published,
    studies,
    subharmonic,
)
