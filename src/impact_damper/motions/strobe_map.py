"""Periodic orbits: the map over whole forcing periods, Newton's method on it, and following.

Motions are looked at once a forcing period, at the phase W T = pi/2: well between the
contacts of a damper at its design point, which fall near 0 and pi.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import inlined, kernel, kernel_only
from impact_damper.kernel.single import advance, assign, side_of, workspace
from impact_damper.system.packed import CONTACT_STIFFNESS, FREQUENCY, INVERSE_MASS_RATIO

CONVERGED = 1e-9
POLISH_TOLERANCE = 1e-12
SAME_STATE = 1e-4


@kernel
def strobe_time(p):
    """The time within a forcing period at which motions are looked at."""
    return 0.5 * math.pi / p[FREQUENCY]


@inlined
def one_period(p, y, tangents, side, tolerance, work):
    """Integrate from strobe to strobe; returns what `advance` returns."""
    t = strobe_time(p)
    return advance(p, y, tangents, side, t, t + 2.0 * math.pi / p[FREQUENCY], tolerance, work)


@kernel_only
def speed_weight(p, side):
    """Weight of Z2' in `distance`: 1 in flight; in contact it moves faster than Z2 by 1/weight."""
    if side == 0:
        return 1.0
    return 1.0 / math.sqrt(1.0 + p[CONTACT_STIFFNESS] * (1.0 + p[INVERSE_MASS_RATIO]))


@kernel
def distance(a, b, weight):
    """Largest difference of two states, the loose mass's speed multiplied by the weight."""
    d = max(abs(a[0] - b[0]), abs(a[1] - b[1]))
    return max(d, max(abs(a[2] - b[2]), weight * abs(a[3] - b[3])))


@kernel
def flow(p, state, tangents, begin, periods, half, tolerance):
    """Integrate over whole forcing periods from `begin` on, and half a one more if asked for.

    The state and the tangents (rows) are replaced. Returns the contacts begun and the time in
    contact. No array is returned: numba loses a Ctrl-C that arrives while it makes one.
    """
    period = 2.0 * math.pi / p[FREQUENCY]
    work = workspace()
    side = side_of(p, state)
    contacts = 0
    touching = 0.0
    for k in range(periods + half):
        end = begin + (period if k < periods else 0.5 * period)
        side, begun, time = advance(p, state, tangents, side, begin, end, tolerance, work)
        contacts += begun
        touching += time
    return contacts, touching


def flow_map(p, y, begin, periods, half, tolerance):
    """Return what a state becomes by `flow`, the derivative (4, 4), and the time in contact."""
    state, tangents = y.copy(), np.eye(4)
    _, touching = flow(p, state, tangents, begin, periods, half, tolerance)
    return state, tangents.T.copy(), touching


@inlined
def period_map(p, y, periods, tolerance):
    """Return what a state at the strobe becomes, the derivative (4, 4), and the contacts begun."""
    half = np.bool_(False)  # a literal would have the map compiled for it alone
    state, tangents = y.copy(), np.eye(4)
    contacts, _ = flow(p, state, tangents, strobe_time(p), periods, half, tolerance)
    return state, tangents.T.copy(), contacts


@kernel
def solve(matrix, right):
    """Solve a small linear system by elimination, in place; returns the determinant.

    Numba's own solver takes longer to compile than all the rest of this module.
    """
    size = len(right)
    determinant = 1.0
    for k in range(size):
        pivot = k
        for i in range(k + 1, size):
            if abs(matrix[i, k]) > abs(matrix[pivot, k]):
                pivot = i
        for j in range(size):
            matrix[k, j], matrix[pivot, j] = matrix[pivot, j], matrix[k, j]
        right[k], right[pivot] = right[pivot], right[k]
        determinant *= matrix[k, k] if pivot == k else -matrix[k, k]
        if matrix[k, k] == 0.0:
            return 0.0
        for i in range(k + 1, size):
            factor = matrix[i, k] / matrix[k, k]
            for j in range(k, size):
                matrix[i, j] -= factor * matrix[k, j]
            right[i] -= factor * right[k]
    for k in range(size - 1, -1, -1):
        for j in range(k + 1, size):
            right[k] -= matrix[k, j] * right[j]
        right[k] /= matrix[k, k]
    return determinant


@kernel
def largest(values):
    """Largest modulus of some numbers."""
    size = 0.0
    for value in values:
        size = max(size, abs(value))
    return size


@kernel
def dominant(values):
    """The value of largest modulus, of a conjugate pair the one with positive imaginary part."""
    found = values[0]
    for value in values:
        if abs(value) > abs(found):
            found = value
    return complex(found.real, abs(found.imag))


@kernel
def polish(p, y, periods, reach, tolerance):
    """Newton's method for a fixed point of the map over `periods` from a state near it.

    Without contacts the loose mass keeps its place and only (Z1, Z1') is sought. Returns
    whether it converged to an orbit within `reach` of the start, the residual, and the
    dominant Floquet multiplier; y is replaced only if it converged.
    """
    orbit = y.copy()
    for _ in range(10):
        state, matrix, contacts = period_map(p, orbit, periods, tolerance)
        active = 4 if contacts > 0 or side_of(p, orbit) != 0 else 2
        newton = matrix[:active, :active].copy()
        change = orbit[:active] - state[:active]
        residual = largest(change)
        for i in range(active):
            newton[i, i] -= 1.0
        if abs(solve(newton, change)) < 1e-12:
            break
        if largest(change) < CONVERGED:
            assign(y, orbit)
            square = matrix[:active, :active].astype(np.complex128)
            return True, residual, dominant(np.linalg.eigvals(square))
        for i in range(active):
            orbit[i] += change[i]
            if active == 2:
                orbit[i + 2] += change[i]
        if not distance(orbit, y, 0.0) < reach:
            break
    return False, np.nan, complex(np.nan, np.nan)


@kernel
def repeats_sooner(p, y, periods, tolerance):
    """Whether a state of an orbit returns after a proper divisor of the periods already."""
    work = workspace()
    none = np.empty((0, 4))
    state = y.copy()
    side = side_of(p, y)
    for n in range(1, periods):
        side, _, _ = one_period(p, state, none, side, tolerance, work)
        if periods % n == 0 and distance(state, y, 0.0) < SAME_STATE:
            return True
    return False
