"""Places of the parameters in the packed array that `parameters.pack` makes and kernels read.

Kernels take plain arrays of numbers, so each parameter has a place, and is read by its name.
"""

# W, h, omega_l^2, d0, r1, 1/rm and the dashpot's coefficient, in this order.
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
