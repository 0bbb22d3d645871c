"""The equation of motion of the primary mass without the damper, equation (3), for kernels.

    Z1'' = cos(W T) - h Z1' - omega_l^2 Z1 - Z1^3

Kernels that evaluate the equation call these functions. `recurrence` has its Taylor series,
where the cube is a product of series.
"""

import math

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.system.packed import DAMPING, FREQUENCY, STIFFNESS


@kernel_only
def external_force(p, t):
    """Return the forcing at a time, over the primary mass."""
    return math.cos(p[FREQUENCY] * t)


@kernel_only
def spring(p, x, lane=0, lanes=1):
    """Return the restoring force of the spring at Z1 = x, over the primary mass.

    Parameters
    ----------
    p : array or pointer
        Packed parameters; of several trajectories side by side, one row of `lanes` numbers a
        parameter.
    x : float
    lane, lanes : int
        Which trajectory, and how many stand side by side.
    """
    return (p[STIFFNESS * lanes + lane] + x * x) * x


@kernel_only
def spring_slope(p, x, lane=0, lanes=1):
    """Return the derivative of `spring` with respect to x; parameters as of `spring`."""
    return p[STIFFNESS * lanes + lane] + 3.0 * x * x


@kernel
def acceleration(p, y, t):
    """Return the acceleration of Z1, and of Z2, at a state in flight."""
    return external_force(p, t) - p[DAMPING] * y[1] - spring(p, y[0])
