"""Kernels of Newton's method for an orbit in segments: derivatives, and the next correction.

The unknowns are the states at the beginnings of the segments and a parameter. The orbit closes if
each segment ends where the next one begins. One more equation fixes the distance along a branch.
"""

import numpy as np

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.single import assign, side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import CLEARANCE, COUNT, FREQUENCY

# NUDGE       change of the parameter forward and backward in the central difference
# BENT        largest difference of the forward and the backward difference, divided by their sum.
#             If it is larger, a contact has appeared or vanished within the change.
# FINE_NUDGE  change of the parameter in this case
NUDGE, FINE_NUDGE, BENT = 2e-7, 1e-9, 1e-3


@kernel
def slopes_of_ends(p, rate, phases, states, ends, sign, tolerance, slopes):
    """Compute the derivatives of the ends of segments by a parameter, as central differences.

    Parameters
    ----------
    p, rate : array, shape (packed.COUNT,)
        Packed parameters, and their derivatives by the parameter.
    phases : array, shape (m + 1,)
        Phases W T at which the segments begin, and at which the last one ends, radian.
    states, ends : array, shape (m, 4)
        States at the beginnings and at the ends of the segments.
    sign : int
        -1 if the segments cover half a symmetric orbit, else 1. The last end is multiplied by it.
    tolerance : float
        Largest local error of a step.
    slopes : array, shape (m, n)
        Receives the derivatives of the first n components, n = 2 without a damper or 4 with one.
    """
    work, none = workspace(), np.empty((0, 4))
    ahead, behind, moved = np.empty(4), np.empty(4), np.empty(COUNT)
    m, n = slopes.shape
    for k in range(m):
        for nudge in (NUDGE, FINE_NUDGE):
            for way in (1.0, -1.0):
                y = ahead if way > 0.0 else behind
                assign(y, states[k])
                for i in range(COUNT):
                    moved[i] = p[i] + way * nudge * rate[i]
                begin, end = phases[k] / moved[FREQUENCY], phases[k + 1] / moved[FREQUENCY]
                advance(moved, y, none, side_of(moved, y), begin, end, tolerance, work)
            whole, bend = 0.0, 0.0
            for i in range(n):
                whole = max(whole, abs(ahead[i] - behind[i]))
                bend = max(bend, abs(ahead[i] + behind[i] - 2.0 * ends[k, i]))
                slopes[k, i] = (ahead[i] - behind[i]) / (2.0 * nudge)
            if bend <= BENT * whole or not p[CLEARANCE] < np.inf:
                break
    for i in range(n):
        slopes[m - 1, i] *= sign


@kernel
def correction(p, rate, phases, states, sign, row, fresh, tolerance, ends, tangents, slopes, out):
    """Integrate all segments, and compute a correction of Newton's method.

    Parameters
    ----------
    p, rate, phases, states, sign, tolerance, slopes
        As in `slopes_of_ends`.
    row : array, shape (m n + 1,)
        The correction is orthogonal to this row.
    fresh : bool
        Whether `slopes` are computed; otherwise they are taken as they are.
    ends : array, shape (m, 4)
        Receives the states at the ends of the segments.
    tangents : array, shape (m, 4, 4)
        Receives the transposed derivatives of the ends by the states.
    out : array, shape (m n + 1, 2)
        Receives the correction, and a vector along the branch whose scalar product with `row` is 1.
        Both are NaN or infinite if the matrix is singular.

    Returns
    -------
    touching : float
        Time in contact.
    residual : float
        Largest difference between the end of a segment and the beginning of the next one.
    """
    work, touching, residual = workspace(), 0.0, 0.0
    m, n = slopes.shape
    for k in range(m):
        assign(ends[k], states[k])
        for i in range(4):
            for j in range(4):
                tangents[k, i, j] = 1.0 if i == j else 0.0
        begin, end = phases[k] / p[FREQUENCY], phases[k + 1] / p[FREQUENCY]
        side = side_of(p, states[k])
        _, _, time = advance(p, ends[k], tangents[k], side, begin, end, tolerance, work)
        touching += time
    if fresh:
        slopes_of_ends(p, rate, phases, states, ends, sign, tolerance, slopes)
    matrix = np.zeros((m * n + 1, m * n + 3))
    for k in range(m):
        ahead, way = (k + 1) % m, float(sign) if k == m - 1 else 1.0
        for i in range(4):
            defect = way * ends[k, i] - states[ahead, i]
            residual = max(residual, abs(defect))
            if i < n:
                place = k * n + i
                for j in range(n):
                    matrix[place, k * n + j] = way * tangents[k, j, i]
                matrix[place, ahead * n + i] -= 1.0
                matrix[place, m * n] = slopes[k, i]
                matrix[place, m * n + 1] = -defect
    for j in range(m * n + 1):
        matrix[m * n, j] = row[j]
    matrix[m * n, m * n + 2] = 1.0
    eliminate(matrix, out)
    return touching, residual


@kernel_only
def eliminate(matrix, out):
    """Solve sparse linear equations for the two right sides in the last columns of a matrix.

    Rows whose factor is zero are skipped, so that the work for cyclic blocks grows with the square
    of the number of rows.
    """
    size = len(matrix)
    for k in range(size):
        pivot = k
        for i in range(k + 1, size):
            if abs(matrix[i, k]) > abs(matrix[pivot, k]):
                pivot = i
        if pivot != k:
            for j in range(k, size + 2):
                matrix[k, j], matrix[pivot, j] = matrix[pivot, j], matrix[k, j]
        for i in range(k + 1, size):
            if matrix[i, k] != 0.0:
                factor = matrix[i, k] / matrix[k, k]
                for j in range(k + 1, size + 2):
                    matrix[i, j] -= factor * matrix[k, j]
    for side in range(2):
        for k in range(size - 1, -1, -1):
            value = matrix[k, size + side]
            for j in range(k + 1, size):
                value -= matrix[k, j] * out[j, side]
            out[k, side] = value / matrix[k, k]
