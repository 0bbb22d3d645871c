"""The equation of motion of the primary mass without the damper, for kernels.

    Z1'' = (F + U W^2 + V/W^2) cos(W T) - h Z1' - omega_l^2 Z1 - k3 Z1^3

This is equation (3) of the paper with four more parameters of `parameters.Oscillator`: k3, F, U and
V. Kernels that evaluate the equation call these functions. `recurrence` has its Taylor series,
where the cube is a product of series.
"""

import math
from functools import partial

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.system.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    CUBIC,
    DAMPING,
    FORCE,
    FREQUENCY,
    INVERSE_MASS_RATIO,
    SHAKER,
    STIFFNESS,
    UNBALANCE,
)


@kernel_only
def forcing_amplitude(p, lane=0, lanes=1):
    """Return the amplitude F + U W^2 + V/W^2 of the forcing, over the primary mass.

    Parameters
    ----------
    p : array or pointer
        Packed parameters; of several trajectories side by side, one row of `lanes` numbers for
        each parameter.
    lane, lanes : int
        Which trajectory, and how many stand side by side.
    """
    frequency = p[FREQUENCY * lanes + lane]
    without = p[FORCE * lanes + lane] + p[UNBALANCE * lanes + lane] * frequency * frequency
    return without + p[SHAKER * lanes + lane] / (frequency * frequency)


@partial(kernel_only, fastmath=False)
def external_force(p, t):
    """Return the forcing at a time, over the primary mass.

    The product is rounded before it enters a sum, so that an amplitude of 1 changes no digit.
    """
    return forcing_amplitude(p) * math.cos(p[FREQUENCY] * t)


@kernel_only
def spring(p, x, lane=0, lanes=1):
    """Return the restoring force of the spring at Z1 = x, over the primary mass.

    Parameters `p`, `lane` and `lanes` as of `forcing_amplitude`.
    """
    return (p[STIFFNESS * lanes + lane] + p[CUBIC * lanes + lane] * x * x) * x


@kernel_only
def spring_slope(p, x, lane=0, lanes=1):
    """Return the derivative of `spring` with respect to x; parameters as of `spring`."""
    return p[STIFFNESS * lanes + lane] + 3.0 * p[CUBIC * lanes + lane] * x * x


@kernel
def acceleration(p, y, t):
    """Return the acceleration of Z1, and of Z2, at a state in flight."""
    return external_force(p, t) - p[DAMPING] * y[1] - spring(p, y[0])


@kernel
def no_return(p):
    """Return the |Z1| from which a primary mass that moves outward never comes back.

    A softening spring pushes outward beyond its barriers at |Z1| = b = omega_l / sqrt(-k3). Beyond
    the larger of 2 b and (4 A / (-3 k3))^(1/3) it pushes harder than the forcing of amplitude A
    can pull back: there -k3 |Z1|^3 - omega_l^2 |Z1| >= -3/4 k3 |Z1|^3 >= A. Contacts of the loose
    mass are left out. Infinite for other springs.
    """
    if p[CUBIC] >= 0.0:
        return math.inf
    barrier = math.sqrt(p[STIFFNESS] / -p[CUBIC])
    return max(2.0 * barrier, (4.0 * abs(forcing_amplitude(p)) / (-3.0 * p[CUBIC])) ** (1.0 / 3.0))


@kernel_only
def has_escaped(p, x, v):
    """Return whether Z1 = x is beyond the point of `no_return`, and moves outward at Z1' = v.

    With a softening spring also for numbers that are not finite.
    """
    return p[CUBIC] < 0.0 and not (abs(x) <= no_return(p) or x * v <= 0.0)


@kernel_only
def energy(p, y):
    """Return the energy of both masses and all springs, over the primary mass.

    Z1' - Z2' is the velocity of the loose mass. Without forcing, energy is only lost.
    """
    x, v = y[0], y[1]
    total = 0.5 * v * v + (0.5 * p[STIFFNESS] + 0.25 * p[CUBIC] * x * x) * x * x
    if p[INVERSE_MASS_RATIO] > 0.0:
        total += 0.5 * (v - y[3]) ** 2 / p[INVERSE_MASS_RATIO]
        depth = max(abs(y[2]) - p[CLEARANCE], 0.0)
        total += 0.5 * p[CONTACT_STIFFNESS] * depth * depth
    return total
