"""The map from the state at one strobe to the state at the next, and Newton's method for orbits.

The strobe is the forcing phase W T = pi/2. The contacts of a damper at its design point occur near
W T = 0 and W T = pi. The strobe lies midway between these contacts.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import inlined, kernel, kernel_only
from impact_damper.kernel.equation import has_escaped
from impact_damper.kernel.single import assign, side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import CONTACT_STIFFNESS, FREQUENCY, INVERSE_MASS_RATIO

STROBE = math.pi / 2
# Newton's method. ITERATIONS: largest number of corrections. It has converged if a correction is
# below CONVERGED. It fails if the determinant of its linear system is below REGULAR.
ITERATIONS, CONVERGED, REGULAR = 10, 1e-9, 1e-12
# Largest local error of a step in the integration of orbits.
POLISH_TOLERANCE = 1e-12
# Two states are equal in `repeats_sooner` if they differ by less than this number.
SAME_STATE = 1e-4


@kernel
def strobe_time(p):
    """Return the time T of the first strobe, at which W T = pi/2."""
    return 0.5 * math.pi / p[FREQUENCY]


@inlined
def one_period(p, y, tangents, side, tolerance, work):
    """Integrate the state y and its tangents in place, from one strobe to the next.

    Return the wall in contact, the number of contacts that began, and the time in contact.
    """
    t = strobe_time(p)
    return advance(p, y, tangents, side, t, t + 2.0 * math.pi / p[FREQUENCY], tolerance, work)


@kernel_only
def speed_weight(p, side):
    """Return the factor by which `distance` multiplies Z2': 1 in flight, less in contact."""
    if side == 0:
        return 1.0
    # In a contact with the natural frequency w, a velocity v leads to the penetration v/w.
    return 1.0 / math.sqrt(1.0 + p[CONTACT_STIFFNESS] * (1.0 + p[INVERSE_MASS_RATIO]))


@kernel
def distance(a, b, weight):
    """Return the largest component of |a - b| for states a, b; Z2' is multiplied by `weight`."""
    d = max(abs(a[0] - b[0]), abs(a[1] - b[1]))
    return max(d, max(abs(a[2] - b[2]), weight * abs(a[3] - b[3])))


@kernel
def flow(p, state, tangents, begin, periods, half, tolerance):
    """Integrate over `periods` forcing cycles from the time `begin`; half a cycle more if `half`.

    Change the state (4,) and the tangents (n, 4) in place, because numba loses a Ctrl-C in kernels
    that return arrays. Return the number of contacts begun and the time in contact.
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


@inlined
def period_map(p, y, periods, tolerance):
    """Run `periods` cycles from a state y to a state z. Return z, dz/dy, number of contacts."""
    half = np.bool_(False)  # for the literal False numba would compile `flow` again
    state, tangents, matrix = y.copy(), np.empty((4, 4)), np.empty((4, 4))
    for i in range(16):
        tangents[i // 4, i % 4] = 1.0 if i % 5 == 0 else 0.0
    contacts, _ = flow(p, state, tangents, strobe_time(p), periods, half, tolerance)
    for i in range(16):
        matrix[i // 4, i % 4] = tangents[i % 4, i // 4]
    return state, matrix, contacts


@kernel
def solve(matrix, right):
    """Solve `matrix` x = `right`. The solution x replaces `right`. Return the determinant."""
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
def largest_modulus(values):
    """Return the largest modulus of an array of numbers."""
    size = 0.0
    for value in values:
        size = max(size, abs(value))
    return size


@kernel
def dominant(values):
    """Return the number with the largest modulus, conjugated if its imaginary part is negative."""
    best = values[0]
    for value in values:
        if abs(value) > abs(best):
            best = value
    return complex(best.real, abs(best.imag))


@kernel
def polish(p, y, periods, reach, tolerance):
    """Move y onto an orbit that repeats after `periods` forcing cycles, by Newton's method.

    Without contacts only Z1, Z1' are unknown. A total change of Z1, Z1' or Z2 by `reach` or more is
    a failure. Return whether the method has converged, the residual, and the dominant multiplier.
    """
    orbit = y.copy()
    for _ in range(ITERATIONS):
        state, matrix, contacts = period_map(p, orbit, periods, tolerance)
        if has_escaped(p, state[0], state[1]):
            break
        active = 4 if contacts > 0 or side_of(p, orbit) != 0 else 2
        newton = matrix[:active, :active].copy()
        change = orbit[:active] - state[:active]
        residual = largest_modulus(change)
        for i in range(active):
            newton[i, i] -= 1.0
        # Over many periods of a chaotic motion the matrix overflows.
        if not REGULAR <= abs(solve(newton, change)) < np.inf:
            break
        if largest_modulus(change) < CONVERGED:
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
    """Return whether an orbit repeats after fewer than `periods` forcing cycles."""
    work = workspace()
    none = np.empty((0, 4))
    state = y.copy()
    side = side_of(p, y)
    for n in range(1, periods):
        side, _, _ = one_period(p, state, none, side, tolerance, work)
        if periods % n == 0 and distance(state, y, 0.0) < SAME_STATE:
            return True
    return False
