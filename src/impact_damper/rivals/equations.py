"""The equations of motion for integrators that evaluate the rate of the state, a tuple.

Equations (3), (4) and (20) to (24). A contact acts while |Z2| exceeds the clearance, so it ends
at zero penetration, and the dashpot's force jumps at both ends.
"""

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.equation import external_force, spring
from impact_damper.system.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    DAMPING,
    DASHPOT,
    INVERSE_MASS_RATIO,
)


@kernel
def wall_at(p, z):
    """Return the wall that acts at a position Z2: -1, 0 within the clearance, or 1."""
    if z > p[CLEARANCE]:
        return 1
    if z < -p[CLEARANCE]:
        return -1
    return 0


@kernel
def rate(p, side, t, y):
    """Return the rate of the state (Z1, Z1', Z2, Z2') while a wall acts.

    `side` is the wall: -1, 0 for none, or 1.
    """
    return rate_under(p, side, external_force(p, t), y)


@kernel_only
def rate_under(p, side, drive, y):
    """Return the rate as `rate` does, with the forcing `drive` given."""
    x, v, z, w = y
    force = p[CONTACT_STIFFNESS] * (z - side * p[CLEARANCE]) + p[DASHPOT] * w if side != 0 else 0.0
    a = drive - p[DAMPING] * v - spring(p, x) - force
    return v, a, w, a - p[INVERSE_MASS_RATIO] * force


@kernel_only
def rate_by_position(p, drive, y):
    """Return the rate with the wall that acts at the position, to integrate through the kink."""
    return rate_under(p, wall_at(p, y[2]), drive, y)


@kernel
def moved(y, h, k):
    """Return the state y + h k."""
    return y[0] + h * k[0], y[1] + h * k[1], y[2] + h * k[2], y[3] + h * k[3]


@kernel_only
def largest_within(x, v, x_end, v_end, h):
    """Return the largest |Z1| over a step h, if Z1' changes linearly."""
    largest = max(abs(x), abs(x_end))
    if v * v_end < 0.0:
        largest = max(largest, abs(x + 0.5 * h * v * v / (v - v_end)))
    return largest
