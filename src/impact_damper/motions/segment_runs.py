"""Kernels of multiple shooting: runs over segments of an orbit, and products of derivatives.

In multiple shooting an orbit is a chain of segments. Each segment begins in a state of its own, and
Newton's method makes the end of each segment equal to the beginning of the next.

Z1 is the displacement of the primary mass.
"""

import numpy as np

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.single import (
    CONTACT_ORDER,
    FLIGHT_ORDER,
    X,
    side_of,
    step,
    workspace,
)
from impact_damper.kernel.tangents import advance
from impact_damper.motions.extrema import extremum


@kernel
def largest_displacement(p, states, times, tolerance):
    """Return the largest |Z1| on all segments of a chain.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters.
    states : array, shape (m, 4)
        States at the beginnings of the segments, replaced by the states at their ends.
    times : array, shape (m + 1,)
        Beginnings of the segments, and end of the last one.
    tolerance : float
        Largest local error of a step.
    """
    work, largest = workspace(), 0.0
    for k in range(len(states)):
        y, t, end = states[k], times[k], times[k + 1]
        side, largest = side_of(p, y), max(largest, abs(y[0]))
        while t < end:
            order = FLIGHT_ORDER if side == 0 else CONTACT_ORDER
            length, side = step(p, y, side, t, end - t, tolerance, work)
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
        Solutions of the variational equations, from the beginnings of the segments to their ends;
        also replaced.
    times : array, shape (m + 1,)
        Beginnings of the segments, and end of the last one.
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


@kernel_only
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


@kernel
def separate(factors, apart, sweeps, settled, blocks, cuts):
    """Separate the eigenvalues of a product of matrices by modulus; return the number of groups.

    Orthogonal iteration makes the product block triangular. Each diagonal block has the eigenvalues
    of one group.

    Parameters
    ----------
    factors : array, shape (m, n, n)
        Factors of the product, the rightmost factor first.
    apart : float
        Two neighbouring moduli belong to different groups if their ratio exceeds this number, and
        if the subspaces of the groups turn by less than the root of `settled` in the last
        iteration.
    sweeps : int
        Largest number of iterations.
    settled : float
        The iteration ends once the subspaces of the groups turn by less than this (radian).
    blocks : array, shape (n, n)
        Receives the diagonal blocks.
    cuts : array of int, shape (n + 1,)
        Receives the first row of each group, then n.
    """
    m, n = factors.shape[:2]
    basis, first, turned = np.zeros((n, n)), np.empty((n, n)), np.empty((n, n))
    triangles = np.empty((m, n, n))
    groups = 0
    for i in range(n):
        basis[i, i] = 1.0
    for _ in range(sweeps):
        for i in range(n):
            for j in range(n):
                first[i, j] = basis[i, j]
        sweep(factors, basis, triangles)
        for i in range(n):
            for j in range(n):
                turned[i, j] = 0.0
                for s in range(n):
                    turned[i, j] += first[s, i] * basis[s, j]
        groups, cuts[0], moved, before = 1, 0, 0.0, 0.0
        for j in range(n):
            size = 0.0
            for k in range(m):
                size += np.log(abs(triangles[k, j, j]) + 1e-300)
            if j > 0 and before - size > np.log(apart):
                cuts[groups] = j
                groups += 1
                for row in range(j, n):
                    for column in range(j):
                        moved = max(moved, abs(turned[row, column]))
            before = size
        cuts[groups] = n
        if moved < settled:
            break
    # A complex pair turns in its plane for ever, and the lengths of its two axes may seem apart.
    kept = 1
    for group in range(1, groups):
        j, moved = cuts[group], 0.0
        for row in range(j, n):
            for column in range(j):
                moved = max(moved, abs(turned[row, column]))
        if moved < np.sqrt(settled):
            cuts[kept] = j
            kept += 1
    groups, cuts[kept] = kept, n
    product, next_product = np.empty((n, n)), np.empty((n, n))
    for group in range(groups):
        begin, end = cuts[group], cuts[group + 1]
        for i in range(begin, end):
            for j in range(begin, end):
                product[i, j] = 1.0 if i == j else 0.0
        for k in range(m):
            for i in range(begin, end):
                for j in range(begin, end):
                    next_product[i, j] = 0.0
                    for s in range(i, end):
                        next_product[i, j] += triangles[k, i, s] * product[s, j]
            for i in range(begin, end):
                for j in range(begin, end):
                    product[i, j] = next_product[i, j]
        for i in range(begin, end):
            for j in range(begin, end):
                blocks[i, j] = 0.0
                for s in range(begin, end):
                    blocks[i, j] += turned[i, s] * product[s, j]
    return groups
