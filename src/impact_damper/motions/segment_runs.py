"""Kernels of multiple shooting: runs over segments of an orbit, and products of derivatives.

In multiple shooting an orbit is a chain of segments. Each segment begins in a state of its own, and
Newton's method makes the end of each segment equal to the beginning of the next.

Z1 is the displacement of the primary mass.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.single import (
    CONTACT_ORDER,
    FLIGHT_ORDER,
    Q,
    X,
    assign,
    polynomial,
    side_of,
    step,
    workspace,
)
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import CLEARANCE, FREQUENCY
from impact_damper.motions.extrema import PIECES, extremum, turning_time
from impact_damper.motions.records import SAMPLES
from impact_damper.motions.strobe_map import STROBE
from impact_damper.motions.traces import record_beginning, series_of_step


@kernel
def survey(p, states, phases, tolerance, log, sums):
    """Record contacts, the largest |Z1| and first harmonics of a motion in segments.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters.
    states : array, shape (m, 4)
        States at the beginnings of the segments, replaced by the states at their ends.
    phases : array, shape (m + 1,)
        Phases W T at which the segments begin, and at which the last one ends, radian.
    tolerance : float
        Largest local error of a step.
    log : array, shape (n, 5)
        Receives a row for each of the first n contacts, as from `traces.trace`.
    sums : array, shape (2, 2)
        Receives real and imaginary part of the mean of 2 exp(-i W T) Z1 (row 0) and of
        2 exp(-i W T) Z2 (row 1), from SAMPLES samples in a forcing cycle.

    Returns
    -------
    contacts : int
        Number of contacts.
    largest : float
        Largest |Z1|.
    """
    work, start = workspace(), np.empty(4)
    frequency, spacing = p[FREQUENCY], 2.0 * math.pi / SAMPLES
    sample = math.ceil((phases[0] - STROBE) / spacing)
    last = sample + round((phases[-1] - phases[0]) / spacing)
    weight, contacts, largest = 2.0 / (last - sample), 0, 0.0
    for i in range(2):
        sums[i, 0] = sums[i, 1] = 0.0
    for k in range(len(states)):
        y, t, end = states[k], phases[k] / frequency, phases[k + 1] / frequency
        side, largest = side_of(p, y), max(largest, abs(y[0]))
        while t < end:
            assign(start, y)
            before = side
            order = FLIGHT_ORDER if side == 0 else CONTACT_ORDER
            length, side = step(p, y, side, t, end - t, tolerance, work)
            largest = extremum(work[X:], order, length, largest)
            ahead = end if length >= end - t else t + length
            final = k == len(states) - 1 and ahead == end
            while sample < last and (final or STROBE + sample * spacing < ahead * frequency):
                phase = STROBE + sample * spacing
                x, _, z, _ = series_of_step(work, before, start, phase / frequency - t)
                z += before * p[CLEARANCE] if before != 0 else 0.0
                cosine, sine = weight * math.cos(phase), weight * math.sin(phase)
                sums[0, 0] += x * cosine
                sums[0, 1] -= x * sine
                sums[1, 0] += z * cosine
                sums[1, 1] -= z * sine
                sample += 1
            t = ahead
            if before == 0 and side != 0:
                contacts = record_beginning(log, contacts, side, t, y[3])
            elif before != 0 and side == 0 and contacts <= len(log):
                log[contacts - 1, 2], log[contacts - 1, 4] = t, y[3]
    return contacts, largest


@kernel
def list_turns(p, states, phases, tolerance, turns):
    """List the extrema of Z2 of a motion in segments; return their number.

    Parameters
    ----------
    p, states, phases, tolerance
        As in `survey`.
    turns : array, shape (n, 4)
        Receives a row for each of the first n extrema: segment, phase W T, 1 for a maximum of |Z2|
        or 0 for a minimum, and |Z2| minus the clearance.
    """
    work, start = workspace(), np.empty(4)
    c = np.empty(max(FLIGHT_ORDER, CONTACT_ORDER) + 1)
    count = 0
    for k in range(len(states)):
        y, t, end = states[k], phases[k] / p[FREQUENCY], phases[k + 1] / p[FREQUENCY]
        side = side_of(p, y)
        while t < end:
            assign(start, y)
            before = side
            order, first = (FLIGHT_ORDER, X) if side == 0 else (CONTACT_ORDER, Q)
            length, side = step(p, y, side, t, end - t, tolerance, work)
            for i in range(order + 1):
                c[i] = work[first + i]
            if before == 0:
                c[0] += start[2] - start[0]
                c[1] += start[3] - start[1]
            else:
                c[0] += before * p[CLEARANCE]
            _, begun = polynomial(c, order, 0.0)
            for piece in range(1, PIECES + 1):
                place = length * piece / PIECES
                _, slope = polynomial(c, order, place)
                if begun * slope <= 0.0 and begun != slope:
                    turn = turning_time(c, order, place - length / PIECES, place, begun, slope)
                    if count < len(turns):
                        turns[count, 0], turns[count, 1] = k, (t + turn) * p[FREQUENCY]
                        value, _ = polynomial(c, order, turn)
                        turns[count, 2] = 1.0 if value * (begun - slope) > 0.0 else 0.0
                        turns[count, 3] = abs(value) - p[CLEARANCE]
                    count += 1
                begun = slope
            t = end if length >= end - t else t + length
    return count


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
        Solutions of the variational equations at the beginnings of the segments, none or four for
        each segment, replaced by the solutions at their ends.
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
def separate(factors, apart, sweeps, settled, coupled, blocks, cuts):
    """Separate the eigenvalues of a product of matrices by modulus; return the number of groups.

    Orthogonal iteration makes the product block triangular. Each diagonal block has the eigenvalues
    of one group.

    Parameters
    ----------
    factors : array, shape (m, n, n)
        Factors of the product, the rightmost factor first.
    apart : float
        Two neighbouring moduli belong to different groups if their ratio exceeds this number, and
        if the subspaces of the groups turn by less than the square root of `settled` in the last
        iteration.
    sweeps : int
        Largest number of iterations.
    settled : float
        The iteration stops once the subspaces of the groups turn by less than this angle (radian)
        in an iteration.
    coupled : float
        While the subspaces of two groups turn by more than this angle (radian) in an iteration, the
        groups count as one. The two vectors of a complex pair keep turning in their plane, so they
        stay one group even if the ratio of their growth factors exceeds `apart`.
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
                coupling = 0.0
                for row in range(j, n):
                    for column in range(j):
                        coupling = max(coupling, abs(turned[row, column]))
                moved = max(moved, coupling)
                if coupling < coupled:
                    cuts[groups] = j
                    groups += 1
            before = size
        cuts[groups] = n
        if moved < settled:
            break
    # The two vectors of a complex pair never stop turning in their plane. If they were separated
    # because the ratio of their growth factors exceeds `apart`, they are joined again.
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
