"""The rate (derivative by T) of the state (Z1, Z1', Z2, Z2'), by (3), (4) and (20) to (24)."""

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.equation import external_force, spring
from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    DAMPING,
    DASHPOT,
    INVERSE_MASS_RATIO,
)

# Floating-point operations of one evaluation of the rate: 20 for the cosine, and 23 others.
RATE_OPERATIONS = 43


@kernel
def wall_at(p, z):
    """Return the wall that the loose mass presses at Z2 = z: -1 or 1, or 0 if it presses none."""
    if z > p[CLEARANCE]:
        return 1
    if z < -p[CLEARANCE]:
        return -1
    return 0


@kernel
def ahead(p, side, z):
    """Return the distance to the nearest wall, or in contact (`side` not 0) the penetration."""
    return p[CLEARANCE] - abs(z) if side == 0 else side * z - p[CLEARANCE]


@kernel
def rate(p, side, t, y):
    """Return the derivative of the state y by T. `side` is the wall in contact, or 0 in flight."""
    return rate_under(p, side, external_force(p, t), y)


@kernel_only
def rate_under(p, side, drive, y):
    """Return the derivative of the state y by T, under the external force `drive`."""
    x, v, z, w = y
    force = p[CONTACT_STIFFNESS] * (z - side * p[CLEARANCE]) + p[DASHPOT] * w if side != 0 else 0.0
    a = drive - p[DAMPING] * v - spring(p, x) - force
    return v, a, w, a - p[INVERSE_MASS_RATIO] * force


@kernel_only
def rate_by_position(p, drive, y):
    """Return dy/dT under an external force `drive`. If |Z2| > d0, the loose mass presses a wall."""
    return rate_under(p, wall_at(p, y[2]), drive, y)


@kernel
def moved(y, h, k):
    """Return the state y + h k. The step is h, and k is the derivative of the state."""
    return y[0] + h * k[0], y[1] + h * k[1], y[2] + h * k[2], y[3] + h * k[3]


@kernel_only
def largest_within(x, v, x_end, v_end, h):
    """Estimate the largest |Z1| in a step h, from Z1 and Z1' at both ends of the step."""
    largest = max(abs(x), abs(x_end))
    if v * v_end < 0.0:
        largest = max(largest, abs(x + 0.5 * h * v * v / (v - v_end)))
    return largest
