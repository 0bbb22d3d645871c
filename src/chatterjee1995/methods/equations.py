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
    """Return the wall in contact at a position z = Z2: -1, 1, or 0 within the clearance."""
    if z > p[CLEARANCE]:
        return 1
    if z < -p[CLEARANCE]:
        return -1
    return 0


@kernel
def ahead(p, side, z):
    """In flight (`side` 0) return the distance to the nearest wall, in contact the penetration."""
    return p[CLEARANCE] - abs(z) if side == 0 else side * z - p[CLEARANCE]


@kernel
def rate(p, side, t, y):
    """Return the rate at the time t. `side` is the wall in contact (-1 or 1), or 0 in flight."""
    return rate_under(p, side, external_force(p, t), y)


@kernel_only
def rate_under(p, side, drive, y):
    """Return the rate under the external force `drive`."""
    x, v, z, w = y
    force = p[CONTACT_STIFFNESS] * (z - side * p[CLEARANCE]) + p[DASHPOT] * w if side != 0 else 0.0
    a = drive - p[DAMPING] * v - spring(p, x) - force
    return v, a, w, a - p[INVERSE_MASS_RATIO] * force


@kernel_only
def rate_by_position(p, drive, y):
    """Return the rate. The loose mass is in contact if |Z2| exceeds the clearance."""
    return rate_under(p, wall_at(p, y[2]), drive, y)


@kernel
def moved(y, h, k):
    """Return the state after a step h from y at the constant rate k."""
    return y[0] + h * k[0], y[1] + h * k[1], y[2] + h * k[2], y[3] + h * k[3]


@kernel_only
def largest_within(x, v, x_end, v_end, h):
    """Return max |Z1| at both ends of a step h and, if Z1' changes sign, at a turning point."""
    largest = max(abs(x), abs(x_end))
    if v * v_end < 0.0:
        largest = max(largest, abs(x + 0.5 * h * v * v / (v - v_end)))
    return largest
