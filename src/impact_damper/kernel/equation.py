"""The equation of motion of the primary mass without the damper, for kernels.

    Z1'' = (F + U W^2 + V/W^2) cos(W T) - h Z1' - omega_l^2 Z1 - k3 Z1^3

This is equation (3) of the paper with four more parameters k3, F, U and V, which are fields of
`parameters.Oscillator`. Kernels that evaluate the equation call the functions of this module. The
modules of the variational equations call the functions that return its derivatives. The module
`recurrence` has the Taylor series of the equation.

Symbols are as in `system.parameters`.
"""

import math
from functools import partial

import numpy as np

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    COUNT,
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
    """Return the amplitude F + U W^2 + V/W^2 of the forcing per unit of primary mass.

    Parameters
    ----------
    p : array or pointer
        Packed parameters. For several trajectories side by side there is one row of `lanes` numbers
        for each parameter.
    lane, lanes : int
        Index of the trajectory, and number of trajectories side by side.
    """
    frequency = p[FREQUENCY * lanes + lane]
    without = p[FORCE * lanes + lane] + p[UNBALANCE * lanes + lane] * frequency * frequency
    return without + p[SHAKER * lanes + lane] / (frequency * frequency)


@partial(kernel_only, fastmath=False)
def external_force(p, t):
    """Return the forcing at a time per unit of primary mass.

    Without fast math the product is rounded before a caller adds it, so that a multiplication by
    the amplitude 1 changes no digit.
    """
    return forcing_amplitude(p) * math.cos(p[FREQUENCY] * t)


@kernel_only
def spring(p, x, lane=0, lanes=1):
    """Return the restoring force of the spring at Z1 = x per unit of primary mass.

    The parameters `p`, `lane` and `lanes` are as in `forcing_amplitude`.
    """
    return (p[STIFFNESS * lanes + lane] + p[CUBIC * lanes + lane] * x * x) * x


@kernel_only
def spring_slope(p, x, lane=0, lanes=1):
    """Return the derivative of `spring` with respect to x, from the same parameters."""
    return p[STIFFNESS * lanes + lane] + 3.0 * p[CUBIC * lanes + lane] * x * x


@kernel
def acceleration(p, y, t):
    """Return Z1'', which in flight is also Z2'', at the state y = (Z1, Z1', Z2, Z2') and time t."""
    return external_force(p, t) - p[DAMPING] * y[1] - spring(p, y[0])


def acceleration_by_parameters(p, x, v, cosine):
    """Return the derivatives of `acceleration` with respect to the packed parameters.

    The derivatives hold at a fixed phase W T of the forcing.

    Parameters
    ----------
    p : array, shape (COUNT,)
    x, v, cosine : arrays, shape (n,)
        Z1, Z1' and cos(W T).

    Returns
    -------
    numpy.ndarray, shape (COUNT, n)
    """
    frequency = p[FREQUENCY]
    slopes = np.zeros((COUNT, len(x)))
    slopes[DAMPING], slopes[STIFFNESS], slopes[CUBIC] = -v, -x, -(x**3)
    slopes[FORCE], slopes[UNBALANCE] = cosine, frequency**2 * cosine
    slopes[SHAKER] = cosine / frequency**2
    growth = p[UNBALANCE] * frequency - p[SHAKER] / frequency**3
    slopes[FREQUENCY] = 2 * growth * cosine
    return slopes


def spring_slope_changes(p, x, change, parameters):
    """Return first-order changes of `spring_slope` under k changes of Z1 and of the parameters.

    Parameters
    ----------
    p : array, shape (COUNT,)
    x : array, shape (n,)
        Z1.
    change : array, shape (k, n)
        Changes of Z1.
    parameters : array, shape (COUNT, k)
        Changes of the packed parameters.

    Returns
    -------
    numpy.ndarray, shape (k, n)
    """
    bent = np.outer(parameters[CUBIC], x) + 2 * p[CUBIC] * change
    return parameters[STIFFNESS][:, None] + 3 * x * bent


@kernel
def no_return(p):
    """Return the |Z1| beyond which a primary mass that moves outward never comes back.

    A softening spring (k3 < 0) pushes outward where |Z1| exceeds b = omega_l / sqrt(-k3). Where
    |Z1| exceeds the larger of 2 b and (4 A / (-3 k3))^(1/3), this push is at least as large as the
    amplitude A of the forcing: -k3 |Z1|^3 - omega_l^2 |Z1| >= -3/4 k3 |Z1|^3 >= A. The contact
    forces of the loose mass are neglected. For k3 >= 0 the function returns infinity.
    """
    if p[CUBIC] >= 0.0:
        return math.inf
    barrier = math.sqrt(p[STIFFNESS] / -p[CUBIC])
    return max(2.0 * barrier, (4.0 * abs(forcing_amplitude(p)) / (-3.0 * p[CUBIC])) ** (1.0 / 3.0))


@kernel_only
def has_escaped(p, x, v):
    """Return whether |x| exceeds `no_return` and a mass with Z1 = x and Z1' = v moves outward.

    With a softening spring the function also returns True if x or v is not finite.
    """
    return p[CUBIC] < 0.0 and not (abs(x) <= no_return(p) or x * v <= 0.0)


@kernel_only
def energy(p, y):
    """Return the energy of both masses and all springs per unit of primary mass.

    Z1' - Z2' is the velocity of the loose mass. Without forcing the energy never grows.
    """
    x, v = y[0], y[1]
    total = 0.5 * v * v + (0.5 * p[STIFFNESS] + 0.25 * p[CUBIC] * x * x) * x * x
    if p[INVERSE_MASS_RATIO] > 0.0:
        total += 0.5 * (v - y[3]) ** 2 / p[INVERSE_MASS_RATIO]
        depth = max(abs(y[2]) - p[CLEARANCE], 0.0)
        total += 0.5 * p[CONTACT_STIFFNESS] * depth * depth
    return total
