"""The paper of Chatterjee, Mallik and Ghosh (1995), recomputed with the library `impact_damper`."""
