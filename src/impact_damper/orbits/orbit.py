"""A periodic orbit, stable or unstable: its multipliers, contacts, motion and flights."""

import math
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from impact_damper.kernel.single import side_of
from impact_damper.model.packed import (
    CONTACT_STIFFNESS,
    DAMPING,
    DASHPOT,
    FREQUENCY,
    INVERSE_MASS_RATIO,
)
from impact_damper.motions import records
from impact_damper.motions.records import survey
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, STROBE
from impact_damper.orbits import segments
from impact_damper.orbits.segments import flow_all

# Increase of the phase W T in one forcing cycle, radian.
TURN = 2 * math.pi
# An orbit has converged if its residual is at most bound x max(1, largest component of a state).
# Without contacts the bound is RESIDUAL. With contacts it is the larger of two numbers: RESIDUAL,
# and STIFF_RESIDUAL times the natural frequency of a contact.
RESIDUAL, STIFF_RESIDUAL = 1e-12, 7e-15
# The phase at which an orbit begins should be at least this far from a contact, radian.
MARGIN = 0.15
# A list of contacts at first has room for 2 x CONTACTS x (forcing cycles + segments) contacts.
CONTACTS = 64


@dataclass(frozen=True)
class Orbit:
    """A periodic orbit, or an approximation of one, divided into m segments of time.

    p: Array of all parameters (`model.packed`).
    periods: Period n in forcing cycles.
    phases: Phases W T at which the segments begin, and at which the last segment ends, (m + 1,).
    states: States at which the segments begin, shape (m, 4).
    sign: -1 if the segments cover half the period of a symmetric orbit, otherwise 1.
    ends: States to which integration leads at the ends of the segments, shape (m, 4).
    factors: Derivatives of `ends` by `states`, (m, 4, 4); factors[-1] is multiplied by `sign`.
    contact_time: Total time in contact in all segments.
    maps: Number of times that all segments were integrated to find the orbit.
    """

    p: np.ndarray
    periods: int
    phases: np.ndarray
    states: np.ndarray
    sign: int
    ends: np.ndarray
    factors: np.ndarray
    contact_time: float
    maps: int = 1

    @property
    def phase(self):
        """Phase W T of the first state, radian."""
        return float(self.phases[0])

    @property
    def state(self):
        """State at which the first segment begins, shape (4,)."""
        return self.states[0]

    @property
    def cycle(self):
        """Increase of the phase W T over all segments: a period, or half of it if `sign` is -1."""
        return self.phases[-1] - self.phases[0]

    @cached_property
    def defects(self):
        """Last state of each segment minus first state of the next segment, shape (m, 4)."""
        defects = np.empty_like(self.ends)
        defects[:-1] = self.ends[:-1] - self.states[1:]
        defects[-1] = self.sign * self.ends[-1] - self.states[0]
        return defects

    @cached_property
    def residual(self):
        """Largest modulus of a component of `defects`."""
        return float(np.abs(self.defects).max())

    @property
    def converged(self):
        """Whether the residual is as small as a rounding error."""
        bound = RESIDUAL
        if self.contact_time > 0:
            stiffness = self.p[CONTACT_STIFFNESS] * (1 + self.p[INVERSE_MASS_RATIO])
            bound = max(bound, STIFF_RESIDUAL * math.sqrt(stiffness))
        return bool(self.residual <= bound * max(1.0, np.abs(self.states).max()))

    @cached_property
    def matrix(self):
        """`sign` times the derivative of the last state by the first state, shape (4, 4)."""
        return reduce(lambda product, factor: factor @ product, self.factors)

    @property
    def monodromy(self):
        """Derivative of the state after one period by the first state, shape (4, 4)."""
        return self.matrix @ self.matrix if self.sign < 0 else self.matrix

    @property
    def amplification(self):
        """Largest factor by which a disturbance grows from the first state to the last state."""
        return np.linalg.norm(self.matrix, 2) if np.all(np.isfinite(self.matrix)) else np.inf

    @property
    def touching(self):
        """Total time in contact in one period."""
        return self.contact_time * (2 if self.sign < 0 else 1)

    @property
    def active(self):
        """Number of unknown components of a state: 4, or 2 (Z1, Z1') if there is no contact."""
        return 4 if self.contact_time > 0 else 2

    @cached_property
    def multipliers(self):
        """Floquet multipliers by descending modulus, shape (4,). Without contacts two are NaN."""
        values = np.full(4, complex(np.nan, np.nan))
        active = self.cycle_multipliers ** (2 if self.sign < 0 else 1)
        values[: self.active] = active[np.lexsort((-active.imag, -np.abs(active)))]
        return values

    @cached_property
    def cycle_multipliers(self):
        """Eigenvalues of `Orbit.matrix`: 4 if the orbit has a contact, otherwise 2."""
        n = self.active
        return segments.multipliers(self.factors[:, :n, :n])

    @property
    def stable(self):
        """True if all multipliers are less than 1 in modulus."""
        return bool(abs(self.multipliers[0]) < 1)

    @property
    def liouville_error(self):
        """Relative error of the determinant of the monodromy matrix.

        Liouville's theorem gives the value exp(-h t - c (1 + 1/rm) t_c). Here t is the period,
        t_c the time in contact, h the damping, rm the mass ratio, c the walls' dashpot coefficient.
        """
        p = self.p
        rate = p[DAMPING] * self.cycle / p[FREQUENCY]
        rate += p[DASHPOT] * (1 + p[INVERSE_MASS_RATIO]) * self.contact_time
        logarithm = np.sum(np.linalg.slogdet(self.factors)[1]) + rate
        return abs(math.expm1((2 if self.sign < 0 else 1) * logarithm))

    @cached_property
    def _surveyed(self):
        """Three results: contacts, largest |Z1|, and the complex first harmonics of Z1 and Z2."""
        states, phases = self.states.copy(), self.phases
        if side_of(self.p, states[0]) != 0:
            # The first state lies in a contact. This contact begins again shortly before the cycle
            # ends, and ends in the next cycle. So two cycles are integrated.
            phases = self.phases[0] + np.array([0.0, 2 * self.cycle])
        times = phases / self.p[FREQUENCY]
        room, sums = 2 * CONTACTS * (self.periods + len(states)), np.empty((2, 2))
        while True:
            log, given = np.empty((room, 5)), states.copy()
            count, largest = survey(self.p, given, phases, times, POLISH_TOLERANCE, log, sums)
            if count <= room:
                break
            room = count
        within = log[:count, 1] < self.phases[-1] / self.p[FREQUENCY]
        return log[:count][within], largest, sums @ [1, 1j]

    @cached_property
    def contacts(self):
        """A row for each contact: wall (-1 or 1), times of beginning and end, Z2' at both times."""
        log = self._surveyed[0]
        if self.sign > 0:
            return log
        shift = self.cycle / self.p[FREQUENCY]
        return np.concatenate([log, log * [-1, 1, 1, -1, -1] + [0, shift, shift, 0, 0]])

    @cached_property
    def sequence(self):
        """Walls in the order of contacts, such as "+-". Where the orbit begins has no effect."""
        walls = "".join("+" if wall > 0 else "-" for wall in self.contacts[:, 0])
        return min((walls[k:] + walls[:k] for k in range(len(walls))), default="")

    @property
    def least_speed(self):
        """Smallest relative speed |Z2'| at which a contact begins, NaN without contacts."""
        return np.min(np.abs(self.contacts[:, 3]), initial=np.inf) if self.touching else np.nan

    @property
    def restitution(self):
        """Smallest ratio of |Z2'| after a contact to |Z2'| before it, NaN without contacts."""
        before, after = np.abs(self.contacts[:, 3]), np.abs(self.contacts[:, 4])
        return np.min(after / before, initial=np.inf) if self.touching else np.nan

    def at(self, phase):
        """Return the state at the phase W T = `phase`, which must not be below the first phase."""
        # With several segments, a multiple of `cycle` is subtracted to get a phase in one of them.
        turns = int((phase - self.phases[0]) // self.cycle) if len(self.states) > 1 else 0
        local = phase - turns * self.cycle
        k = min(max(int(np.searchsorted(self.phases, local, "right")) - 1, 0), len(self.states) - 1)
        state = self.states[k].copy()
        segments.run(self.p, state, np.empty((0, 4)), self.phases[k], max(local, self.phases[k]))
        return self.sign**turns * state

    @cached_property
    def deviation(self):
        """Deviation from symmetry or, if `periods` is even, from an orbit of half the period.

        It is the first state plus the state half a period later, or for even `periods` the first
        state minus the state half a period later, shape (4,). A symmetric orbit (`sign` -1) gets
        (1, 1, 1, 1) instead of zeros, because callers look for changes of sign along a branch.
        """
        if self.sign < 0:
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
        """Record (`records.MOTION`) with largest |Z1|, contacts per cycle, asymmetry, harmonics."""
        record = np.zeros(1, records.MOTION)[0]
        _, largest, harmonics = self._surveyed
        record["maximum_displacement"] = largest
        record["contacts"] = len(self.contacts) / self.periods
        begin = self.phase + (STROBE - self.phase) % TURN
        sums = self.at(begin) + self.at(begin + self.periods * TURN / 2)
        record["asymmetry"] = np.max(np.abs(sums)) if self.periods % 2 else np.nan
        record["harmonic_displacement"], record["harmonic_relative"] = harmonics
        return record

    def is_same(self, other, tolerance=1e-6):
        """Return whether `other` is this orbit or its mirror image. First phases do not matter."""
        if other.periods != self.periods:
            return False
        first = self.phase + (STROBE - self.phase) % TURN + TURN / 2
        mirrored = [-self.at(first + k * TURN) for k in range(self.periods)]
        states = np.concatenate([self.strobe_states, mirrored])
        return bool(np.min(np.max(np.abs(states - other.strobe_states[0]), axis=1)) < tolerance)

    def repeats_sooner(self, tolerance=1e-6):
        """Return whether the state repeats after fewer forcing cycles than `periods`."""
        shift = np.max(np.abs(self.strobe_states - self.strobe_states[0]), axis=1)
        return any(shift[k] < tolerance for k in range(1, self.periods) if self.periods % k == 0)

    def margin(self, phases):
        """Return the distance from each phase to the nearest contact, radian; -1 in a contact."""
        begins, ends = (self.p[FREQUENCY] * self.contacts[:, k] for k in (1, 2))
        cycle, phases = self.periods * TURN, np.asarray(phases)[..., None]
        ahead, behind = (begins - phases) % cycle, (phases - ends) % cycle
        inside = (phases - begins) % cycle < (ends - begins)
        distances = np.where(inside, -1.0, np.minimum(ahead, behind))
        return np.min(distances, axis=-1, initial=np.inf)

    def flight_phase(self):
        """Return `phase`, or the middle of the longest flight if `phase` is too near a contact."""
        if not self.touching or self.margin(self.phase) > MARGIN:
            return self.phase
        ends = self.p[FREQUENCY] * self.contacts[:, 2]
        begins = self.p[FREQUENCY] * np.append(self.contacts[1:, 1], self.contacts[0, 1])
        flights = (begins - ends) % (self.periods * TURN)
        k = np.argmax(flights)
        return self.phase + (ends[k] + flights[k] / 2 - self.phase) % (self.periods * TURN)


def integrate(p, periods, phases, states, sign=1) -> Orbit:
    """Integrate segments from their first `states`. The `Orbit` returned need not be periodic."""
    states, phases = np.array(states, float), np.asarray(phases, float)
    ends, tangents = states.copy(), np.empty((len(states), 4, 4))
    touching = flow_all(p, ends, tangents, phases / p[FREQUENCY], POLISH_TOLERANCE)
    factors = tangents.transpose(0, 2, 1).copy()
    factors[-1] *= sign
    return Orbit(p, periods, phases, states, sign, ends, factors, touching)
