"""Multiple shooting: an orbit as a chain of segments that begin and end in flight.

A strongly unstable orbit amplifies rounding errors over a period by its largest multiplier. Cut
into segments that amplify little, it keeps its accuracy.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from impact_damper.kernel.single import side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions.segment_runs import flow_all, list_turns, survey
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.orbits.paths import follow_path

# Multipliers whose moduli differ by more than the factor APART are separated by orthogonal
# iteration. Multipliers of similar moduli are eigenvalues of products of small blocks.
# SWEEPS: largest number of iterations.
# SETTLED: the iteration ends if its basis changes by less than this.
# COUPLED: multipliers are not separated if the basis still changes by more than this at the end.
APART = 30.0
SWEEPS, SETTLED, COUPLED = 14, 1e-15, 1e-8
# A segment ends before the norm of its derivative exceeds AMPLIFIED.
AMPLIFIED = 30.0
# Smallest distance of a section from contacts, radian.
CLEAR = 0.05
# Largest residual of a converged orbit, relative to its states.
RESIDUAL = 1e-12
# Largest mean number of contacts, and of extrema of Z2, in a segment that can be listed.
CONTACTS, TURNS = 64, 256


@dataclass(frozen=True)
class Chain:
    """A chain of m segments.

    p: Packed parameters; shape (packed.COUNT,).
    phases: Phases W T at which the segments begin, and at which the last segment ends, radian;
        shape (m + 1,).
    states: States at the beginnings of the segments; shape (m, 4).
    sign: -1 if the chain is half of a symmetric orbit, else 1.
    ends: States at the ends of the segments, by integration from `states`; shape (m, 4).
    factors: Derivatives of the ends with respect to the states, in the order of time. The last
        factor is multiplied by `sign`; shape (m, 4, 4).
    touching: Time in contact.
    """

    p: np.ndarray
    phases: np.ndarray
    states: np.ndarray
    sign: int
    ends: np.ndarray
    factors: np.ndarray
    touching: float

    @property
    def cycle(self):
        """Length of the chain, radian: the period of the orbit, or half of it."""
        return self.phases[-1] - self.phases[0]

    @cached_property
    def defects(self):
        """The differences F_k, shape (m, 4), which are zero for an orbit."""
        defects = np.empty_like(self.ends)
        defects[:-1] = self.ends[:-1] - self.states[1:]
        defects[-1] = self.sign * self.ends[-1] - self.states[0]
        return defects

    @cached_property
    def residual(self):
        """Largest defect."""
        return float(np.abs(self.defects).max())

    @property
    def converged(self):
        """Whether the residual is at most RESIDUAL times the largest component of the states.

        If all components are below 1, the residual must be at most RESIDUAL.
        """
        return bool(self.residual <= RESIDUAL * max(1.0, np.abs(self.states).max()))

    def at(self, phase):
        """Return the state, shape (4,), at a phase (radian) not before the first phase."""
        turns = int((phase - self.phases[0]) // self.cycle)
        local = phase - turns * self.cycle
        k = min(max(int(np.searchsorted(self.phases, local, "right")) - 1, 0), len(self.states) - 1)
        state = self.states[k].copy()
        _advance(self.p, state, np.empty((0, 4)), self.phases[k], max(local, self.phases[k]))
        return self.sign**turns * state

    @cached_property
    def surveyed(self):
        """Contacts in the order of time, largest |Z1|, and first harmonics.

        Contacts are an array of shape (k, 5) with the columns of `Orbit.contacts`. The first
        harmonics are the complex amplitudes of Z1 and Z2, from equally spaced samples.
        """
        log, sums = np.empty((CONTACTS * len(self.states), 5)), np.empty((2, 2))
        states = self.states.copy()
        count, largest = survey(self.p, states, self.phases, POLISH_TOLERANCE, log, sums)
        if count > len(log):
            raise ArithmeticError(f"{count} contacts in a cycle: more than {len(log)}")
        return log[:count].copy(), largest, sums @ [1, 1j]

    def turns(self, segment=None):
        """Return a row for each extremum of Z2, or for each in one segment, shape (n, 4).

        A row holds the index of the segment, the phase (radian), 1 for a maximum of |Z2| or 0 for a
        minimum, and the height |Z2| - d0, with the clearance d0.
        """
        first = 0 if segment is None else segment
        states = (self.states if segment is None else self.states[first : first + 1]).copy()
        turns = np.empty((TURNS * len(states), 4))
        count = list_turns(self.p, states, self.phases[first:], POLISH_TOLERANCE, turns)
        if count > len(turns):
            raise ArithmeticError(f"{count} extrema of Z2 in a cycle: more than {len(turns)}")
        return turns[:count] + [first, 0.0, 0.0, 0.0]

    def path(self, k):
        """Return the `paths.Path` of segment k."""
        begin, end = self.phases[k : k + 2] / self.p[FREQUENCY]
        return follow_path(self.p, self.states[k], begin, end)


def _advance(p, state, tangents, begin, end):
    """Integrate a state and solutions `tangents` of the variational equations between two phases.

    Both are changed in place. The time in contact is returned.
    """
    times = begin / p[FREQUENCY], end / p[FREQUENCY]
    side = side_of(p, state)
    return advance(p, state, tangents, side, *times, POLISH_TOLERANCE, workspace())[2]


def chain_of(p, phases, states, sign) -> Chain:
    """Return a chain after integration of all its segments; the arguments are its attributes."""
    ends, tangents = np.array(states, float), np.empty((len(states), 4, 4))
    tangents[:] = np.eye(4)
    touching = flow_all(p, ends, tangents, phases / p[FREQUENCY], POLISH_TOLERANCE)
    factors = tangents.transpose(0, 2, 1).copy()
    factors[-1] *= sign
    return Chain(p, phases, np.array(states, float), sign, ends, factors, touching)


def cyclic(factors):
    """Return the derivative of `Chain.defects` with respect to the states, shape (m n, m n).

    `factors` are those of the chain, or their leading n by n blocks, shape (m, n, n).
    """
    m, n = factors.shape[:2]
    matrix, k = np.zeros((m, n, m, n)), np.arange(m)
    matrix[k, :, k] = factors
    matrix[k, :, (k + 1) % m] -= np.eye(n)
    return matrix.reshape(m * n, m * n)


def multipliers(factors):
    """Return the eigenvalues of the product of matrices, without forming it.

    Orthogonal iteration makes the product block triangular. Each diagonal block has eigenvalues of
    similar moduli. The two vectors of a complex pair keep turning in their plane, so they stay in
    one block.
    """
    m, n = factors.shape[:2]
    if m == 1:
        return np.linalg.eigvals(factors[0]).astype(complex)
    basis, triangles = np.eye(n), np.empty((m, n, n))
    for _ in range(SWEEPS):
        first = basis
        for k, factor in enumerate(factors):
            basis, triangles[k] = np.linalg.qr(factor @ basis)
        turned = first.T @ basis
        sizes = np.sum(np.log(np.abs(triangles.diagonal(axis1=1, axis2=2)) + 1e-300), axis=0)
        coupling = np.array([np.max(np.abs(turned[j:, :j])) for j in range(1, n)])
        apart = -np.diff(sizes) > np.log(APART)
        if np.max(coupling[apart], initial=0.0) < SETTLED:
            break
    cuts = np.flatnonzero(apart & (coupling < COUPLED)) + 1
    values = np.empty(n, complex)
    for block in map(slice, [0, *cuts], [*cuts, n]):
        product = turned[block, block]
        for triangle in triangles[::-1]:
            product = product @ triangle[block, block]
        values[block] = np.linalg.eigvals(product)
    return values


def log_determinant(factors):
    """Return the logarithm of the modulus of the determinant of the product of matrices."""
    return float(np.sum(np.linalg.slogdet(factors)[1]))


def cut(orbit, cycle, between=()):
    """Return the phases at which an orbit is cut into segments, shape (m + 1,).

    Possible phases are the middles of flights. A segment ends at the last of these phases at which
    the norm of its derivative is below AMPLIFIED. If the norm is larger at all of them, the segment
    ends at the first.
    """
    if not orbit.touching:
        return np.array([orbit.phase, orbit.phase + cycle])
    places, forced = _sections(orbit, cycle, between)
    phases, state = [places[0]], orbit.at(places[0])
    product = np.eye(4)
    for place, ahead in zip(places, np.append(places[1:], places[0] + cycle), strict=True):
        tangents = np.eye(4)
        begin = orbit.at(place) if place != places[0] else state
        _advance(orbit.p, begin, tangents, place, ahead)
        grown = tangents.T @ product
        if place > phases[-1] and (place in forced or np.linalg.norm(grown, 2) > AMPLIFIED):
            phases.append(place)
            grown = tangents.T
        product = grown
    return np.array([*phases, places[0] + cycle])


def _sections(orbit, cycle, between):
    """Return the possible phases of cuts, shape (k,), and a list of those at which to cut always.

    The phases are the middles of flights, ascending from the middle of the longest flight. A flight
    is always cut before and after the phases `between`, at which the loose mass comes close to a
    wall.
    """
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
    # The contacts cover the whole period. If the cycle is half of it, each phase occurs twice, so
    # duplicates are removed. The shift by 1e-9 keeps `start` first in spite of rounding errors.
    places = np.sort(start + (np.array([*middles, start]) - start + 1e-9) % cycle - 1e-9)
    places = places[np.append(True, np.diff(places) > 1e-6)]
    places = places[places < start + cycle - 1e-6]
    forced = start + (np.array(forced) - start + 1e-9) % cycle - 1e-9
    return places, [place for place in places if np.min(np.abs(forced - place), initial=1) < 1e-6]
