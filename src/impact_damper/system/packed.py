"""Indices of the parameters in the array that `parameters.pack` makes and kernels read.

Kernels take the parameters as an array `p` of COUNT numbers and read each by the name of its
index, as `p[FREQUENCY]`. In this order: W, h, omega_l^2, d0, r1, 1/rm, and the dashpot's
coefficient 2 zeta_c sqrt(r1 rm).
"""

NAMES = (
    "FREQUENCY",
    "DAMPING",
    "STIFFNESS",
    "CLEARANCE",
    "CONTACT_STIFFNESS",
    "INVERSE_MASS_RATIO",
    "DASHPOT",
)
COUNT = len(NAMES)
(
    FREQUENCY,
    DAMPING,
    STIFFNESS,
    CLEARANCE,
    CONTACT_STIFFNESS,
    INVERSE_MASS_RATIO,
    DASHPOT,
) = range(COUNT)
