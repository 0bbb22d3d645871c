"""A periodic orbit, stable or unstable: its multipliers, contacts, motion and flights.

Its state is stored at a phase at which the loose mass is in flight, so that the map over the period
is smooth and well scaled.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from impact_damper.kernel.single import side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import DAMPING, DASHPOT, FREQUENCY, INVERSE_MASS_RATIO
from impact_damper.motions import records, traces
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.orbits import segments

# Phases W T, radian: a forcing cycle, and the strobe, at which states are compared.
TURN = 2 * math.pi
STROBE = math.pi / 2
# The phase of an orbit is kept if the nearest contact is further away than MARGIN (radian).
MARGIN = 0.15
# Largest number of contacts in a forcing cycle that can be listed.
CONTACTS = 64


@dataclass(frozen=True)
class Orbit:
    """A periodic orbit.

    p: Packed parameters; shape (packed.COUNT,).
    periods: Period n in forcing cycles.
    phase: Phase W T of the state, radian, with the forcing frequency W.
    state: Z1, Z1', Z2, Z2' at this phase. Z1 is the displacement of the primary mass, and Z2 its
        displacement relative to the loose mass; shape (4,).
    monodromy: Derivative of the map over n cycles; shape (4, 4).
    root: For a symmetric orbit of odd n, the derivative of the map over n/2 cycles followed by a
        change of sign. It is called root because its square is the monodromy matrix; shape (4, 4).
    residual: Largest difference between the state and the state a period later.
    touching: Time in contact during a period.
    converged: Whether the residual is at most `segments.RESIDUAL` times the largest component of
        the state, or times 1 if all components are smaller. If not, the state is the best state
        that Newton's method found.
    maps: How often Newton's method integrated over the period.
    chain: Segments of an orbit that was found by multiple shooting. The state is that at the
        beginning of the first segment. The monodromy matrix and its root are products of the
        derivatives of the segments. Their small entries are inaccurate, because rounding errors are
        relative to the largest entry. All other properties are computed from the segments, without
        this loss.
    """

    p: np.ndarray
    periods: int
    phase: float
    state: np.ndarray
    monodromy: np.ndarray
    root: np.ndarray | None
    residual: float
    touching: float
    converged: bool
    maps: int = 1
    chain: segments.Chain | None = None

    @property
    def cycle(self):
        """Length of a cycle of the orbit, radian.

        A cycle is the period or, for an orbit with a root, half the period, after which the motion
        repeats with a change of sign.
        """
        return self.periods * TURN * (1.0 if self.root is None else 0.5)

    @property
    def factors(self):
        """Derivatives of the m segments of a cycle, shape (m, 4, 4); m is 1 without a chain."""
        if self.chain is not None:
            return self.chain.factors
        return (self.monodromy if self.root is None else self.root)[None]

    @property
    def amplification(self):
        """Norm of the derivative of the map over a cycle."""
        matrix = self.monodromy if self.root is None else self.root
        return np.linalg.norm(matrix, 2) if np.all(np.isfinite(matrix)) else np.inf

    @property
    def active(self):
        """Number of unknowns: 4, or 2 (Z1, Z1') if the loose mass touches no wall and rests."""
        return 4 if self.touching > 0 else 2

    @cached_property
    def multipliers(self):
        """Floquet multipliers by descending modulus, shape (4,); two are NaN without contacts."""
        values = np.full(4, complex(np.nan, np.nan))
        n = self.active
        active = self.cycle_multipliers if self.root is None else self.cycle_multipliers**2
        values[:n] = active[np.lexsort((-active.imag, -np.abs(active)))]
        return values

    @cached_property
    def cycle_multipliers(self):
        """Eigenvalues of the derivative of the map over a cycle, shape (active,)."""
        n = self.active
        return segments.multipliers(self.factors[:, :n, :n])

    @property
    def stable(self):
        """True if all multipliers are less than 1 in modulus."""
        return bool(abs(self.multipliers[0]) < 1)

    @property
    def liouville_error(self):
        """Relative error of the determinant of the monodromy matrix.

        By Liouville's theorem the determinant is exp(-h n 2 pi/W - c (1 + 1/rm) t_c), with the
        damping h, the mass ratio rm, the time in contact t_c and the coefficient c of the dashpot
        of a wall.
        """
        p = self.p
        contact_damping = p[DASHPOT] * (1 + p[INVERSE_MASS_RATIO])
        rate = p[DAMPING] * self.periods * TURN / p[FREQUENCY] + contact_damping * self.touching
        cycles = 1 if self.root is None else 2
        return abs(math.expm1(cycles * segments.log_determinant(self.factors) + rate))

    @cached_property
    def contacts(self):
        """Contacts in the order of time, shape (k, 5).

        A row holds the wall (-1 or 1), the times of beginning and end, and Z2' at both.
        """
        if self.chain is not None:
            log = self.chain.surveyed[0]
            if self.root is None:
                return log
            shift = self.cycle / self.p[FREQUENCY]
            return np.concatenate([log, log * [-1, 1, 1, -1, -1] + [0, shift, shift, 0, 0]])
        begin = self.phase / self.p[FREQUENCY]
        end = begin + self.periods * TURN / self.p[FREQUENCY]
        # If the first state lies in a contact, the end of this contact is reached at once, but its
        # beginning only a period later.
        touching = side_of(self.p, self.state) != 0
        last = end + touching * (end - begin)
        _, log = traces.trace(self.p, self.state, begin, [last], POLISH_TOLERANCE)
        if len(log) > (1 + touching) * self.periods * CONTACTS:
            raise ArithmeticError(
                f"{len(log)} contacts in an orbit: more than {CONTACTS} in a forcing cycle"
            )
        log = log[touching:]
        return log[log[:, 1] < end]

    @cached_property
    def sequence(self):
        """Walls touched in the order of time, such as "+-" for one contact with each wall.

        Of all cyclic shifts of these signs the first in alphabetical order is taken, so that the
        sequence does not depend on the first contact.
        """
        walls = "".join("+" if wall > 0 else "-" for wall in self.contacts[:, 0])
        return min((walls[k:] + walls[:k] for k in range(len(walls))), default="")

    @property
    def least_speed(self):
        """Smallest |Z2'| at which a contact begins, NaN without contacts; small near a grazing."""
        return np.min(np.abs(self.contacts[:, 3]), initial=np.inf) if self.touching else np.nan

    @property
    def restitution(self):
        """Smallest ratio of |Z2'| after a contact to |Z2'| before it, NaN without contacts."""
        before, after = np.abs(self.contacts[:, 3]), np.abs(self.contacts[:, 4])
        return np.min(after / before, initial=np.inf) if self.touching else np.nan

    def at(self, phase):
        """Return the state, shape (4,), at a phase W T (radian) not before the orbit's phase."""
        if self.chain is not None:
            return self.chain.at(phase)
        y = self.state.copy()
        begin = self.phase / self.p[FREQUENCY]
        end = begin + (phase - self.phase) / self.p[FREQUENCY]
        side = side_of(self.p, y)
        advance(self.p, y, np.empty((0, 4)), side, begin, end, POLISH_TOLERANCE, workspace())
        return y

    @cached_property
    def deviation(self):
        """Difference, shape (4,), between the state and its image half a period later.

        For odd n the image is mirrored, so the difference is 0 for a symmetric orbit. For even n
        it is 0 for an orbit of half the period. A branch of orbits meets a branch of such orbits
        of more symmetry where the difference changes sign. A symmetric orbit has no such branch to
        meet; its difference is replaced by ones.
        """
        if self.root is not None:
            return np.ones(4)
        half = self.at(self.phase + self.periods * np.pi)
        return self.state + half if self.periods % 2 else self.state - half

    @cached_property
    def strobe_states(self):
        """States at W T = pi/2 in each forcing cycle of the period, shape (n, 4)."""
        first = self.phase + (STROBE - self.phase) % TURN
        return np.array([self.at(first + k * TURN) for k in range(self.periods)])

    @cached_property
    def record(self):
        """Largest |Z1|, contacts, asymmetry and first harmonics: a `records.MOTION`."""
        if self.chain is not None:
            return self._record_of_chain()
        return records.measured(self.p, self.strobe_states[0], self.periods, POLISH_TOLERANCE)

    def _record_of_chain(self):
        """Return the `record` from the segments."""
        record = np.zeros(1, records.MOTION)[0]
        _, largest, harmonics = self.chain.surveyed
        record["maximum_displacement"] = largest
        record["contacts"] = len(self.contacts) / self.periods
        begin = self.phase + (STROBE - self.phase) % TURN
        sums = self.at(begin) + self.at(begin + self.periods * TURN / 2)
        record["asymmetry"] = np.max(np.abs(sums)) if self.periods % 2 else np.nan
        # The first harmonic is a mean over the period. A symmetric orbit has the same mean over
        # half the period.
        record["harmonic_displacement"], record["harmonic_relative"] = harmonics
        return record

    def is_same(self, other, tolerance=1e-6):
        """Return whether `other` is this orbit or its mirror image, up to a shift in time."""
        if other.periods != self.periods:
            return False
        first = self.phase + (STROBE - self.phase) % TURN + TURN / 2
        mirrored = [-self.at(first + k * TURN) for k in range(self.periods)]
        states = np.concatenate([self.strobe_states, mirrored])
        return bool(np.min(np.max(np.abs(states - other.strobe_states[0]), axis=1)) < tolerance)

    def repeats_sooner(self, tolerance=1e-6):
        """Return whether the state repeats after fewer than n cycles."""
        shift = np.max(np.abs(self.strobe_states - self.strobe_states[0]), axis=1)
        return any(shift[k] < tolerance for k in range(1, self.periods) if self.periods % k == 0)

    def margin(self, phases):
        """Return the distances of phases from the nearest contact, radian; -1 during a contact."""
        begins, ends = (self.p[FREQUENCY] * self.contacts[:, k] for k in (1, 2))
        cycle, phases = self.periods * TURN, np.asarray(phases)[..., None]
        ahead, behind = (begins - phases) % cycle, (phases - ends) % cycle
        inside = (phases - begins) % cycle < (ends - begins)
        distances = np.where(inside, -1.0, np.minimum(ahead, behind))
        return np.min(distances, axis=-1, initial=np.inf)

    def flight_phase(self):
        """Return a phase (radian) far from contacts, less than a period after the orbit's phase.

        This is the orbit's phase if it is further than MARGIN from all contacts, otherwise the
        phase in the middle of the longest flight.
        """
        if not self.touching or self.margin(self.phase) > MARGIN:
            return self.phase
        ends = self.p[FREQUENCY] * self.contacts[:, 2]
        begins = self.p[FREQUENCY] * np.append(self.contacts[1:, 1], self.contacts[0, 1])
        flights = (begins - ends) % (self.periods * TURN)
        k = np.argmax(flights)
        return self.phase + (ends[k] + flights[k] / 2 - self.phase) % (self.periods * TURN)
