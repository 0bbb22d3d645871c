"""The paper of Chatterjee, Mallik and Ghosh (1995), recomputed with the library `impact_damper`."""

from chatterjee1995 import variables  # noqa: F401  registers the variables
