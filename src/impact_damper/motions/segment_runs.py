"""Kernels of multiple shooting: runs over segments of an orbit, and products of derivatives."""

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import (
    CONTACT_ORDER,
    FLIGHT_ORDER,
    X,
    advance,
    side_of,
    step,
    workspace,
)
from impact_damper.motions.extrema import extremum


@kernel
def largest_displacement(p, y, t, end, tolerance):
    """Return the largest |Z1| of a motion from the time t to `end`.

    y, the state at t, is replaced by the last state.
    """
    work, none = workspace(), np.empty((0, 4))
    side, largest = side_of(p, y), abs(y[0])
    while t < end:
        order = FLIGHT_ORDER if side == 0 else CONTACT_ORDER
        length, side = step(p, y, none, side, t, end - t, tolerance, work)
        largest = extremum(work[X:], order, length, largest)
        t = end if length >= end - t else t + length
    return largest


@kernel
def flow_all(p, states, tangents, times, tolerance):
    """Integrate all segments of a chain; return the time in contact.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters.
    states : array, shape (m, 4)
        States at the beginnings of the segments, replaced by the states at their ends.
    tangents : array, shape (m, 0, 4) or (m, 4, 4)
        Solutions of the variational equations at the beginnings, replaced by those at the ends.
    times : array, shape (m + 1,)
        Ends of the segments.
    tolerance : float
        Largest local error of a step.
    """
    work, touching = workspace(), 0.0
    for k in range(len(states)):
        side = side_of(p, states[k])
        begin, end = times[k], times[k + 1]
        _, _, time = advance(p, states[k], tangents[k], side, begin, end, tolerance, work)
        touching += time
    return touching


@kernel
def sweep(factors, basis, triangles):
    """Compute the QR factors of a product of matrices, A_k Q_(k-1) = Q_k R_k.

    Each step orthogonalises by the Gram-Schmidt method, applied twice.

    Parameters
    ----------
    factors : array, shape (m, n, n)
        The matrices A_k.
    basis : array, shape (n, n)
        Orthonormal columns Q_0, replaced by Q_m.
    triangles : array, shape (m, n, n)
        Receives the upper triangular matrices R_k.
    """
    m, n = factors.shape[:2]
    moved = np.empty((n, n))
    for k in range(m):
        for i in range(n):
            for j in range(n):
                moved[i, j] = 0.0
                triangles[k, i, j] = 0.0
                for s in range(n):
                    moved[i, j] += factors[k, i, s] * basis[s, j]
        for j in range(n):
            for i in range(2 * j):
                c, product = i % j, 0.0
                for s in range(n):
                    product += moved[s, c] * moved[s, j]
                triangles[k, c, j] += product
                for s in range(n):
                    moved[s, j] -= product * moved[s, c]
            norm = 0.0
            for s in range(n):
                norm += moved[s, j] * moved[s, j]
            norm = np.sqrt(norm)
            triangles[k, j, j] = norm
            for s in range(n):
                moved[s, j] /= norm
        for i in range(n):
            for j in range(n):
                basis[i, j] = moved[i, j]
