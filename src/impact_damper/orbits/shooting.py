"""Periodic orbits, stable or not, by Newton's method on the event-driven flow.

The state of an orbit is given at a phase W T of the forcing that lies in flight, far from
contacts: there the map over its period is smooth and well scaled. The derivative of the
map is that of the variational equations, saltation at the dashpot included.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from impact_damper.kernel.single import advance, side_of, workspace
from impact_damper.motions import records
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, flow_map
from impact_damper.system.packed import DAMPING, DASHPOT, FREQUENCY, INVERSE_MASS_RATIO

TURN = 2 * math.pi
STROBE = math.pi / 2
# A phase is kept while the nearest contact is further off than this, in radians of the forcing.
MARGIN = 0.15
RESIDUAL = 1e-12
ITERATIONS = 20
FAR, NEAR = 10.0, 1e-6
CONTACTS = 64  # most contacts a forcing period that are listed


@dataclass(frozen=True)
class Orbit:
    """A periodic orbit.

    Attributes
    ----------
    p : numpy.ndarray, shape (packed.COUNT,)
        Packed parameters.
    periods : int
        Its period n in forcing periods.
    phase : float
        Phase W T of the state, radian.
    state : numpy.ndarray, shape (4,)
        Z1, Z1', Z2, Z2' at that phase.
    monodromy : numpy.ndarray, shape (4, 4)
        Derivative of the map over n periods.
    root : numpy.ndarray, shape (4, 4), or None
        For a symmetric orbit of odd n the derivative of the map over n/2 periods and a change of
        sign, whose square the monodromy matrix is.
    residual : float
        Largest difference of the state from its return.
    touching : float
        Time in contact.
    converged : bool
        Whether the residual is at most 1e-12 times the state's size; if not, the orbit is only
        where Newton's method gave up.
    maps : int
        Maps over its period that Newton's method took to it.
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

    @property
    def active(self):
        """Dimension of the problem: 2 where no wall is touched, for then the loose mass rests."""
        return 4 if self.touching > 0 else 2

    @cached_property
    def multipliers(self):
        """Floquet multipliers by descending modulus, shape (4,); two are NaN without contacts."""
        values = np.full(4, complex(np.nan, np.nan))
        n = self.active
        if self.root is None:
            found = np.linalg.eigvals(self.monodromy[:n, :n])
        else:
            found = np.linalg.eigvals(self.root[:n, :n]) ** 2
        values[:n] = found[np.lexsort((-found.imag, -np.abs(found)))]
        return values

    @property
    def stable(self):
        """Whether all multipliers are less than 1 in modulus."""
        return bool(abs(self.multipliers[0]) < 1)

    @property
    def liouville_error(self):
        """Relative error of the determinant of the monodromy matrix.

        It must be exp(-h n 2 pi/W - 2 zeta_c sqrt(r1 rm) (1 + 1/rm) t_c), t_c the time in contact.
        """
        p = self.p
        contact_damping = p[DASHPOT] * (1 + p[INVERSE_MASS_RATIO])
        rate = p[DAMPING] * self.periods * TURN / p[FREQUENCY] + contact_damping * self.touching
        return abs(np.linalg.det(self.monodromy) * math.exp(rate) - 1)

    @cached_property
    def contacts(self):
        """Contacts in order, shape (k, 5): wall, beginning, end, and Z2' at both.

        Raises
        ------
        ArithmeticError
            If there are more than 64 a forcing period.
        """
        begin = self.phase / self.p[FREQUENCY]
        end = begin + self.periods * TURN / self.p[FREQUENCY]
        # A contact under way at the phase is whole where it comes again.
        touching = side_of(self.p, self.state) != 0
        last = end + touching * (end - begin)
        log = np.empty(((1 + touching) * self.periods * CONTACTS, 5))
        count = records.trace(
            self.p,
            self.state.copy(),
            begin,
            np.array([last]),
            POLISH_TOLERANCE,
            np.empty((1, 4)),
            log,
        )
        if count > len(log):
            raise ArithmeticError(f"{count} contacts an orbit: more than {CONTACTS} a period")
        log = log[touching:count]
        return log[log[:, 1] < end]

    @property
    def sequence(self):
        """Walls touched in order, as "+-", begun where the text comes first in the alphabet."""
        walls = "".join("+" if wall > 0 else "-" for wall in self.contacts[:, 0])
        return min((walls[k:] + walls[:k] for k in range(len(walls))), default="")

    @property
    def least_speed(self):
        """Least relative speed at which a contact begins: small near grazing; NaN without."""
        return np.min(np.abs(self.contacts[:, 3]), initial=np.inf) if self.touching else np.nan

    @property
    def restitution(self):
        """Least ratio of the relative speeds after and before a contact; NaN without."""
        before, after = np.abs(self.contacts[:, 3]), np.abs(self.contacts[:, 4])
        return np.min(after / before, initial=np.inf) if self.touching else np.nan

    def at(self, phase):
        """The state at a phase not before the orbit's own."""
        y = self.state.copy()
        begin = self.phase / self.p[FREQUENCY]
        end = begin + (phase - self.phase) / self.p[FREQUENCY]
        side = side_of(self.p, y)
        advance(self.p, y, np.empty((0, 4)), side, begin, end, POLISH_TOLERANCE, workspace())
        return y

    @cached_property
    def strobe_states(self):
        """States at W T = pi/2 of every forcing period, shape (n, 4)."""
        first = self.phase + (STROBE - self.phase) % TURN
        return np.array([self.at(first + k * TURN) for k in range(self.periods)])

    @cached_property
    def record(self):
        """Extremum of |Z1|, contacts, asymmetry and first harmonics: a `recording.MOTION`."""
        return records.measured(self.p, self.strobe_states[0], self.periods, POLISH_TOLERANCE)

    def is_same(self, other, tolerance=1e-6):
        """Whether another orbit is this one or its mirror image, begun in any forcing period."""
        if other.periods != self.periods:
            return False
        first = self.phase + (STROBE - self.phase) % TURN + TURN / 2
        mirrored = [-self.at(first + k * TURN) for k in range(self.periods)]
        states = np.concatenate([self.strobe_states, mirrored])
        return bool(np.min(np.max(np.abs(states - other.strobe_states[0]), axis=1)) < tolerance)

    def repeats_sooner(self, tolerance=1e-6):
        """Whether the state returns after a proper divisor of the periods already."""
        shift = np.max(np.abs(self.strobe_states - self.strobe_states[0]), axis=1)
        return any(shift[k] < tolerance for k in range(1, self.periods) if self.periods % k == 0)

    def margin(self, phase):
        """Distance of a phase from the nearest contact, radian; negative inside one."""
        begins, ends = (self.p[FREQUENCY] * self.contacts[:, k] for k in (1, 2))
        cycle = self.periods * TURN
        ahead, behind = (begins - phase) % cycle, (phase - ends) % cycle
        inside = (phase - begins) % cycle < (ends - begins)
        return -1.0 if inside.any() else np.min([ahead, behind], initial=np.inf)

    def quiet_phase(self):
        """A phase far from contacts: the orbit's own if it is, or else amid its longest flight.

        It lies less than the orbit's length after the own one.
        """
        if not self.touching or self.margin(self.phase) > MARGIN:
            return self.phase
        ends = self.p[FREQUENCY] * self.contacts[:, 2]
        begins = self.p[FREQUENCY] * np.append(self.contacts[1:, 1], self.contacts[0, 1])
        flights = (begins - ends) % (self.periods * TURN)
        k = np.argmax(flights)
        return self.phase + (ends[k] + flights[k] / 2 - self.phase) % (self.periods * TURN)


def shoot(p, state, periods, phase, *, symmetric=False):
    """The orbit that a state would be, with what the map makes of it; not iterated.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters.
    state : array, shape (4,)
    periods : int
        Forcing periods n after which it should return; odd if symmetric.
    phase : float
        Phase W T of the state, radian.
    symmetric : bool
        Ask for its mirror image after n/2 periods instead: (Z, T) to (-Z, T + half a period)
        maps motions to motions.

    Returns
    -------
    Orbit
    numpy.ndarray, shape (4,)
        The state after the periods, or the mirrored one after half of them.
    """
    whole, sign = (periods // 2, -1) if symmetric else (periods, 1)
    begin = phase / p[FREQUENCY]
    end, matrix, touching = flow_map(p, state, begin, whole, symmetric, POLISH_TOLERANCE)
    end, matrix = sign * end, sign * matrix
    residual = float(np.max(np.abs(end - state)))
    converged = residual <= RESIDUAL * max(1.0, np.max(np.abs(state)))
    if symmetric:
        made = matrix @ matrix, matrix, residual, 2 * touching, converged
    else:
        made = matrix, None, residual, touching, converged
    return Orbit(p, periods, phase, state, *made), end


def find_orbit(p, state, periods=1, phase=STROBE):
    """Newton's method from a state near an orbit; the phase is moved into flight at the end.

    Where no wall is touched only Z1 and Z1' are sought, and the loose mass keeps its place.

    Parameters
    ----------
    p, state, periods, phase
        As of `shoot`.

    Returns
    -------
    Orbit
        `converged` says whether it is one.
    """
    orbit = _newton(p, np.array(state, float), periods, phase)
    # Inside a contact rounding grows as fast as the contact swings, so "near" is enough.
    if not orbit.residual < NEAR or orbit.quiet_phase() == orbit.phase:
        return orbit
    phase = orbit.quiet_phase()
    moved = _newton(p, orbit.at(phase), periods, phase % TURN)
    return replace(moved, maps=orbit.maps + moved.maps)


def _newton(p, state, periods, phase):
    best, end = shoot(p, state, periods, phase)
    orbit = best
    maps = 1
    for _ in range(ITERATIONS):
        n = orbit.active
        matrix = np.eye(n) - orbit.monodromy[:n, :n]
        try:
            change = np.linalg.solve(matrix, (end - orbit.state)[:n])
        except np.linalg.LinAlgError:
            break
        if not np.max(np.abs(change)) < FAR:
            break
        moved = orbit.state.copy()
        moved[:n] += change
        if n == 2:
            moved[2:] += change
        orbit, end = shoot(p, moved, periods, phase)
        maps += 1
        if best.converged and orbit.residual >= best.residual:
            break
        if orbit.residual < best.residual or not best.converged:
            best = orbit
    return replace(best, maps=maps)
