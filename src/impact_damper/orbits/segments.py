"""Multiple shooting: the division of an orbit into segments, and the algebra of their derivatives.

A strongly unstable orbit is accurate if each of its segments amplifies rounding errors little.
"""

from functools import reduce

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions.strobe_map import POLISH_TOLERANCE

# Smallest ratio of the moduli of two multipliers that orthogonal iteration separates.
APART = 30.0
# Orthogonal iteration: largest number of sweeps; change of the basis below which iteration ends;
# last change of the basis above which multipliers are not separated.
SWEEPS, SETTLED, COUPLED = 14, 1e-15, 1e-8
# Largest norm of the derivative of a segment, if possible.
AMPLIFIED = 30.0
# Smallest distance of an edge of a segment from contacts, radian.
CLEAR = 0.05


def run(p, state, tangents, begin, end):
    """Integrate a state and its tangents in place, from the phase `begin` to the phase `end`."""
    times = begin / p[FREQUENCY], end / p[FREQUENCY]
    advance(p, state, tangents, side_of(p, state), *times, POLISH_TOLERANCE, workspace())


def cyclic(factors):
    """Return the derivative of `Orbit.defects` by the states, shape (m n, m n)."""
    m, n = factors.shape[:2]
    matrix, k = np.zeros((m, n, m, n)), np.arange(m)
    matrix[k, :, k] = factors
    matrix[k, :, (k + 1) % m] -= np.eye(n)
    return matrix.reshape(m * n, m * n)


def multipliers(factors):
    """Return the eigenvalues of a product of matrices, without computing the product.

    Orthogonal iteration makes the product block triangular. Each diagonal block has eigenvalues of
    similar moduli, such as a complex pair.
    """
    m, n = factors.shape[:2]
    if m == 1:
        return np.linalg.eigvals(factors[0]).astype(complex)
    factors, basis, triangles = np.ascontiguousarray(factors), np.eye(n), np.zeros((m, n, n))
    for _ in range(SWEEPS):
        first = basis.copy()
        sweep(factors, basis, triangles)
        turned = first.T @ basis
        sizes = np.log(np.abs(triangles.diagonal(axis1=1, axis2=2)) + 1e-300).sum(axis=0)
        coupling = np.array([np.abs(turned[j:, :j]).max() for j in range(1, n)])
        apart = sizes[:-1] - sizes[1:] > np.log(APART)
        if not np.any(apart & (coupling >= SETTLED)):
            break
    product = reduce(np.matmul, triangles[::-1])
    cuts = [0, *(np.flatnonzero(apart & (coupling < COUPLED)) + 1), n]
    values = np.empty(n, complex)
    for part in map(slice, cuts, cuts[1:]):
        values[part] = np.linalg.eigvals(turned[part, part] @ product[part, part])
    return values


@kernel
def sweep(factors, basis, triangles):
    """Compute the QR factors in A_k Q_(k-1) = Q_k R_k of matrices A_k, by Gram-Schmidt.

    `triangles` receives the R_k. `basis` is Q_0 and receives the last Q_k. Each vector is made
    orthogonal twice, because rounding errors remain after the first time.
    """
    m, n = factors.shape[:2]
    moved = np.empty((n, n))
    for k in range(m):
        for j in range(n):
            for i in range(n):
                moved[i, j] = 0.0
                triangles[k, i, j] = 0.0
                for s in range(n):
                    moved[i, j] += factors[k, i, s] * basis[s, j]
            for i in range(2 * j):
                product = 0.0
                for s in range(n):
                    product += moved[s, i % j] * moved[s, j]
                triangles[k, i % j, j] += product
                for s in range(n):
                    moved[s, j] -= product * moved[s, i % j]
            for s in range(n):
                triangles[k, j, j] += moved[s, j] ** 2
            triangles[k, j, j] = np.sqrt(triangles[k, j, j])
            for s in range(n):
                moved[s, j] /= triangles[k, j, j]
        for i in range(n):
            for j in range(n):
                basis[i, j] = moved[i, j]


def cut(orbit, cycle, between=()):
    """Return the phases at which an orbit is cut into segments, shape (m + 1,).

    The phases lie in the middle of flights. The norm of a segment's derivative is below AMPLIFIED
    if possible. The phases `between` divide flights into parts, and each part is always cut.
    """
    if not orbit.touching:
        return np.array([orbit.phase, orbit.phase + cycle])
    places, forced = _sections(orbit, cycle, between)
    phases, product = [places[0]], np.eye(4)
    for place, ahead in zip(places, np.append(places[1:], places[0] + cycle), strict=True):
        tangents = np.eye(4)
        run(orbit.p, orbit.at(place), tangents, place, ahead)
        grown = tangents.T @ product
        if place > phases[-1] and (place in forced or np.linalg.norm(grown, 2) > AMPLIFIED):
            phases.append(place)
            grown = tangents.T
        product = grown
    return np.array([*phases, places[0] + cycle])


def _sections(orbit, cycle, between):
    """Return phases of possible cuts, the first in the longest flight, and of forced cuts."""
    log, first = orbit.contacts, orbit.phase
    begins, ends = (orbit.p[FREQUENCY] * log[:, k] for k in (1, 2))
    following = np.append(begins[1:], begins[0] + orbit.periods * 2 * np.pi)
    middles, forced, longest = [], [], (0.0, first)
    for end, begin in zip(ends, following, strict=True):
        turns = sorted(end + (phase - end) % cycle for phase in between)
        marks = [end, *(turn for turn in turns if turn < begin), begin]
        for low, high in zip(marks, marks[1:], strict=False):
            middle = first + ((low + high) / 2 - first) % cycle
            if high - low > 2 * CLEAR:
                middles.append(middle)
                forced += [middle] * (len(marks) > 2)
            longest = max(longest, (high - low, middle))
    start = longest[1]
    # If the cycle is half the period, each phase occurs twice. With the shift by 1e-9, `start`
    # remains first in spite of rounding errors.
    places = np.sort(start + (np.array([*middles, start]) - start + 1e-9) % cycle - 1e-9)
    places = places[np.append(True, np.diff(places) > 1e-6)]
    places = places[places < start + cycle - 1e-6]
    forced = start + (np.array(forced) - start + 1e-9) % cycle - 1e-9
    return places, [place for place in places if np.min(np.abs(forced - place), initial=1) < 1e-6]
