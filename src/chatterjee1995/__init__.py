"""The paper of Chatterjee, Mallik and Ghosh (1995), recomputed with the library `impact_damper`."""

# These register their variables.
from chatterjee1995.variables import (  # noqa: F401
    accuracy,
    balance_map,
    contact,
    design_rules,
    harmonics,
    integrators,
    policies,
    studies,
    subharmonic,
)
