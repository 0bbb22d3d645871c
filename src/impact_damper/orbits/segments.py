"""Multiple shooting: divide an orbit into segments, and combine the derivatives of segments.

Along a strongly unstable orbit rounding errors grow large. Along a short segment they stay small.
The derivative of a segment is the matrix d(last state)/d(first state).
"""

from functools import reduce

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import (
    CONTACT_ORDER,
    FLIGHT_ORDER,
    PIECES,
    assign,
    polynomial,
    series_of_loose_mass,
    side_of,
    step,
    turning_time,
    workspace,
)
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import CLEARANCE, COUNT, FREQUENCY
from impact_damper.motions.strobe_map import POLISH_TOLERANCE

# Orthogonal iteration divides the multipliers into groups of similar modulus. From one group to the
# next the modulus falls by more than the factor APART.
APART = 30.0
# Orthogonal iteration passes over all segments and turns orthogonal vectors. It ends after SWEEPS
# passes, or if a pass turns the vectors by less than SETTLED. Neighbouring groups of multipliers
# (see APART) are joined if the last pass turns the vectors by COUPLED or more.
SWEEPS, SETTLED, COUPLED = 14, 1e-15, 1e-8
# If possible, a small disturbance grows by less than this factor along a segment.
AMPLIFIED = 30.0
# If possible, segments begin at least this far from contacts, radian.
CLEAR = 0.05


def run(p, state, tangents, begin, end):
    """Integrate from the phase `begin` to the phase `end`. Overwrite `state` and `tangents`."""
    times = begin / p[FREQUENCY], end / p[FREQUENCY]
    advance(p, state, tangents, side_of(p, state), *times, POLISH_TOLERANCE, workspace())


def cyclic(factors):
    """Return the matrix d(`Orbit.defects`)/d(`Orbit.states`). `factors` is as in `Orbit`."""
    m, n = factors.shape[:2]
    matrix, k = np.zeros((m, n, m, n)), np.arange(m)
    matrix[k, :, k] = factors
    matrix[k, :, (k + 1) % m] -= np.eye(n)
    return matrix.reshape(m * n, m * n)


def multipliers(factors):
    """Return the eigenvalues of the product of the matrices `factors`, by orthogonal iteration."""
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
    """Compute the QR decompositions A_k Q_(k-1) = Q_k R_k of the matrices A_k in `factors`.

    `triangles` receives the matrices R_k. `basis` is Q_0 at first and the last Q_k at the end.
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

    From the first to the last of these phases, W T increases by `cycle`. An orbit without contacts
    is one segment. Otherwise the cuts lie in the middle of flights. If possible, small disturbances
    grow by less than the factor AMPLIFIED from one cut to the next. A flight that contains one of
    the phases in `between` is cut before and after this phase, if there is room.
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
    # If `cycle` is half the period, flights half a period apart have the same phase modulo `cycle`
    # and count once. The shift by 1e-9 keeps `start` first in spite of rounding errors.
    places = np.sort(start + (np.array([*middles, start]) - start + 1e-9) % cycle - 1e-9)
    places = places[np.append(True, np.diff(places) > 1e-6)]
    places = places[places < start + cycle - 1e-6]
    forced = start + (np.array(forced) - start + 1e-9) % cycle - 1e-9
    return places, [place for place in places if np.min(np.abs(forced - place), initial=1) < 1e-6]


# Central differences change the parameter by NUDGE. If the second difference exceeds BENT times the
# first difference, a contact appears or vanishes within NUDGE. Then FINE_NUDGE replaces NUDGE.
NUDGE, FINE_NUDGE, BENT = 2e-7, 1e-9, 1e-3


@kernel
def list_turns(p, states, phases, tolerance, turns):
    """Write the extrema of Z2 in all segments to the rows of `turns`. Return the number of extrema.

    Extrema for which no row is left are only counted. The columns of `turns` are: the index
    of the segment, the phase W T, 1 at a maximum of |Z2| or 0 at a minimum, and |Z2| - d0.
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
            length, side = step(p, y, side, t, end - t, tolerance, work)
            order = series_of_loose_mass(work, before, start, c)
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
    """Integrate all segments, overwriting their first `states`. Return the total time in contact.

    Segment k begins at times[k]. tangents[k] receives the transposed derivative of segment k.
    """
    work, touching = workspace(), 0.0
    for k in range(len(states)):
        for i in range(16):
            tangents[k, i // 4, i % 4] = 1.0 if i % 5 == 0 else 0.0
        side = side_of(p, states[k])
        begin, end = times[k], times[k + 1]
        _, _, time = advance(p, states[k], tangents[k], side, begin, end, tolerance, work)
        touching += time
    return touching


@kernel
def slopes_of_ends(p, rate, phases, states, ends, sign, tolerance, slopes):
    """Compute derivatives of the last states (`ends`) of m segments by a parameter.

    `rate` is the derivative of the array `p` by this parameter. `slopes`, shape (m, n), receives
    the first n components of each derivative. The last derivative is multiplied by `sign`.
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
