"""Multiple shooting: an orbit as a chain of segments that begin and end in flight.

A strongly unstable orbit amplifies rounding errors over a period by its largest multiplier. To keep
its accuracy, the orbit is cut into segments that amplify little. The unknowns are the states y_k at
the beginnings of the segments. They solve F_k = Phi_k(y_k) - y_(k+1) = 0 for all segments k, where
Phi_k is the flow over segment k, which integrates a state from its beginning to its end. The last
segment leads back to the first, with a change of sign if the chain is half of a symmetric orbit.
The derivatives of the flows are called factors. The multipliers of the orbit are the eigenvalues of
the product of the factors and are computed without forming the product. The sections, at which one
segment ends and the next begins, lie at phases of the forcing at which the loose mass is in flight,
so that the flow is smooth there.

Z1 is the displacement of the primary mass and Z2 its displacement relative to the loose mass.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from impact_damper.kernel.single import side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.motions import traces
from impact_damper.motions.segment_runs import flow_all, largest_displacement, separate
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.orbits.paths import follow_path
from impact_damper.system.packed import FREQUENCY

# Multipliers whose moduli differ by more than the factor APART are separated by orthogonal
# iteration. Multipliers of similar moduli are eigenvalues of products of small blocks.
# SWEEPS: largest number of iterations.
# SETTLED: the iteration ends if its basis changes by less than this.
APART = 30.0
SWEEPS, SETTLED = 14, 1e-15
# A segment ends before the norm of its derivative exceeds AMPLIFIED.
AMPLIFIED = 30.0
# Smallest distance of a section from contacts, radian.
CLEAR = 0.05
# Largest number of contacts in a segment that can be listed.
CONTACTS = 512


@dataclass(frozen=True)
class Chain:
    """A chain of m segments.

    Attributes
    ----------
    p : numpy.ndarray, shape (packed.COUNT,)
        Packed parameters.
    phases : numpy.ndarray, shape (m + 1,)
        Phases W T at which the segments begin, and at which the last segment ends, radian.
    states : numpy.ndarray, shape (m, 4)
        States at the beginnings of the segments.
    sign : int
        -1 if the chain is half of a symmetric orbit, else 1.
    ends : numpy.ndarray, shape (m, 4)
        States at the ends of the segments, by integration from `states`.
    factors : numpy.ndarray, shape (m, 4, 4)
        Derivatives of the ends with respect to the states, in the order of time. The last factor is
        multiplied by `sign`.
    touching : float
        Time in contact.
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

    def at(self, phase):
        """Return the state, shape (4,), at a phase (radian) not before the first phase."""
        turns = int((phase - self.phases[0]) // self.cycle)
        local = phase - turns * self.cycle
        k = min(max(int(np.searchsorted(self.phases, local, "right")) - 1, 0), len(self.states) - 1)
        state = self.states[k].copy()
        _advance(self.p, state, np.empty((0, 4)), self.phases[k], max(local, self.phases[k]))
        return self.sign**turns * state

    def log(self):
        """Return the contacts in the order of time, shape (k, 5).

        A row holds the wall (-1 or 1), the times of beginning and end, and Z2' at both.

        Raises
        ------
        ArithmeticError
            If a segment has more than CONTACTS contacts.
        """
        logs = []
        for k, state in enumerate(self.states):
            begin, end = self.phases[k : k + 2] / self.p[FREQUENCY]
            log, last = np.empty((CONTACTS, 5)), np.empty((1, 4))
            count = traces.trace(
                self.p, state.copy(), begin, np.array([end]), POLISH_TOLERANCE, last, log
            )
            if count > CONTACTS:
                raise ArithmeticError(f"{count} contacts in a segment: more than {CONTACTS}")
            logs.append(log[:count])
        return np.concatenate(logs)

    def samples(self, first, spacing):
        """Return equally spaced phases over the chain, shape (n,), and the states, shape (n, 4).

        Parameters
        ----------
        first, spacing : float
            Spacing of the phases, and a phase from which they are counted, radian. The latter need
            not lie on the chain.
        """
        begin = self.phases[0] + (first - self.phases[0]) % spacing
        count = round(self.cycle / spacing)
        places = begin + spacing * np.arange(count)
        states = np.empty((count, 4))
        for k, state in enumerate(self.states):
            chosen = (places >= self.phases[k]) & (places < self.phases[k + 1])
            times = places[chosen] / self.p[FREQUENCY]
            part, begin = np.empty((len(times), 4)), self.phases[k] / self.p[FREQUENCY]
            traces.trace(
                self.p, state.copy(), begin, times, POLISH_TOLERANCE, part, np.empty((0, 5))
            )
            states[chosen] = part
        return places, states

    def path(self, k):
        """Return the `paths.Path` of segment k."""
        begin, end = self.phases[k : k + 2] / self.p[FREQUENCY]
        return follow_path(self.p, self.states[k], begin, end)

    def largest(self):
        """Return the largest |Z1|."""
        times = self.phases / self.p[FREQUENCY]
        return largest_displacement(self.p, self.states.copy(), times, POLISH_TOLERANCE)


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


def ends_of(p, phases, states):
    """Return the ends of the segments of a chain, shape (m, 4), without derivatives."""
    ends, none = np.array(states, float), np.empty((len(states), 0, 4))
    flow_all(p, ends, none, phases / p[FREQUENCY], POLISH_TOLERANCE)
    return ends


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

    Orthogonal iteration separates eigenvalues of different moduli. Eigenvalues of similar moduli
    are computed from the product of diagonal blocks.

    Parameters
    ----------
    factors : array, shape (m, n, n)
        In the order in which they act, so the last matrix is leftmost in the product.

    Returns
    -------
    numpy.ndarray of complex, shape (n,)
        By descending modulus.
    """
    m, n = factors.shape[:2]
    if m == 1:
        return np.linalg.eigvals(factors[0]).astype(complex)
    blocks, cuts = np.empty((n, n)), np.zeros(n + 1, int)
    groups = separate(np.ascontiguousarray(factors), APART, SWEEPS, SETTLED, blocks, cuts)
    values = np.diagonal(blocks).astype(complex)
    for begin, end in zip(cuts[:groups], cuts[1:], strict=False):
        if end > begin + 1:
            values[begin:end] = np.linalg.eigvals(blocks[begin:end, begin:end])
    return values


def log_determinant(factors):
    """Return the logarithm of the modulus of the determinant of the product of matrices."""
    return float(np.sum(np.linalg.slogdet(factors)[1]))


def cut(orbit, cycle, between=()):
    """Return the phases at which an orbit is cut into segments, shape (m + 1,).

    Possible phases are the middles of flights. A segment ends at the last of these phases at which
    the norm of its derivative is below AMPLIFIED. If the norm is larger at all of them, the segment
    ends at the first.

    Parameters
    ----------
    orbit : Orbit
    cycle : float
        Range of phases that the segments cover, radian: the period or half the period.
    between : sequence of float
        Phases at which the loose mass comes close to a wall in flight. Such a flight is cut twice,
        before and after this phase.
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
