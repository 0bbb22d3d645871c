"""Derivatives of motions and of periodic orbits by their parameters.

The variations of a motion are the derivatives of its states, by Duhamel's integral.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from impact_damper.kernel.equation import (
    acceleration_by_parameters,
    forcing_amplitude,
    spring,
)
from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    COUNT,
    DAMPING,
    DASHPOT,
    FREQUENCY,
    INVERSE_MASS_RATIO,
)
from impact_damper.orbits.paths import INTEGRALS, POINTS, Path, follow_path
from impact_damper.orbits.shooting import newton, shoot


@dataclass(frozen=True)
class Variations:
    """The variations of a motion.

    path: Path.
    directions: Changes of the parameters by which the variations are taken. None means that each
        parameter is changed alone, by 1; shape (COUNT, k).
    """

    path: Path
    directions: np.ndarray | None = None

    @cached_property
    def _inverse(self):
        """Inverse of P at all points, shape (4, 4, N)."""
        inverse = np.linalg.inv(self.path.tangents.transpose(2, 0, 1))
        return np.ascontiguousarray(inverse.transpose(1, 2, 0))

    @cached_property
    def _columns(self):
        """P^-1 times three unit changes of f, each of shape (4, N).

        The first is that by a force on the primary mass, which changes Z1'' and Z2'' by the same
        amount. The second is that by the force of a wall, which changes Z2'' by (1 + 1/rm) times
        the change of Z1''. The third changes Z2'' alone.
        """
        first, second = self._inverse[:, 1], self._inverse[:, 3]
        return first + second, first + (1 + self.path.p[INVERSE_MASS_RATIO]) * second, second

    @cached_property
    def _integrals(self):
        """Duhamel's integral of each direction up to all points, shape (4, k, N)."""
        rates = self._rates()
        count = rates.shape[1]
        rates = rates.reshape(4, count, len(self.path.sides), POINTS)
        integrals = self.path.lengths[:, None] * (rates @ INTEGRALS.T)
        gains = integrals[..., -1].copy()
        # A change of the clearance moves the wall and so delays the event. In the meantime the
        # dashpot's force, which jumps at the event, acts or is missing.
        for point, wall, begun in zip(*self.path.events, strict=True):
            moved = begun * wall * self.path.p[DASHPOT] * self._columns[1][:, point + 1]
            for k, share in self._along(CLEARANCE):
                gains[:, k, point // POINTS] += share * moved
        integrals[:, :, 1:] += np.cumsum(gains[..., :-1], axis=2)[..., None]
        return integrals.reshape(4, count, -1)

    def _along(self, parameter):
        """Return pairs of a direction's index and its component along a parameter, if not 0."""
        if self.directions is None:
            return [(parameter, 1.0)]
        row = self.directions[parameter]
        return [(k, row[k]) for k in np.flatnonzero(row)]

    def _rates(self):
        """Return P^-1 f_d for each direction at all points, shape (4, k, N)."""
        p, (x, v, _, w) = self.path.p, self.path.states
        walls, depth = self.path.contacts
        frequency, cosine = p[FREQUENCY], np.cos(p[FREQUENCY] * self.path.times)
        free = acceleration_by_parameters(p, x, v, cosine)
        wall = np.zeros((COUNT, len(x)))
        wall[CLEARANCE] = -p[CONTACT_STIFFNESS] * walls
        wall[CONTACT_STIFFNESS], wall[DASHPOT] = depth, np.abs(walls) * w
        both, pushed, loose = self._columns
        force = p[CONTACT_STIFFNESS] * depth + p[DASHPOT] * wall[DASHPOT]
        if self.directions is not None:
            free, wall = self.directions.T @ free, self.directions.T @ wall
        rates = both[:, None] * free - pushed[:, None] * wall
        for k, share in self._along(INVERSE_MASS_RATIO):
            rates[:, k] -= share * loose * force
        drive = forcing_amplitude.py_func(p) * cosine - p[DAMPING] * v - spring.py_func(p, x)
        moving = self._inverse[:, 0] * v + self._inverse[:, 2] * w
        later = (moving + both * drive - pushed * force) / frequency
        for k, share in self._along(FREQUENCY):
            rates[:, k] -= share * later
        return rates

    def slopes(self):
        """Return the derivatives of the last state by the directions, shape (4, k).

        The first state, and the phases of the forcing at both ends, are held fixed.
        """
        return self.path.matrix @ self._integrals[..., -1]

    def changes(self, first, parameters):
        """Return the changes of the state along n directions at all points."""
        inner = first[..., None] + parameters.T @ self._integrals
        return np.einsum("ijn,jkn->ikn", self.path.tangents, inner)


def path_of(orbit, segment=None) -> Path:
    """Return the motion of an orbit over its cycle, or over a segment."""
    k = 0 if segment is None else segment
    end = orbit.phases[-1 if segment is None else k + 1]
    return follow_path(
        orbit.p, orbit.states[k], *np.array([orbit.phases[k], end]) / orbit.p[FREQUENCY]
    )


# Changes of an orbit for differences, as fractions of the direction.
NUDGE = 1e-4
# A size has a kink if its relative slopes on both sides differ by more than this.
KINK = 0.02


def relative_slopes(orbit, direction) -> np.ndarray:
    """Return the derivatives of ln max |Z1| and of ln |largest multiplier| along a direction.

    They are central differences between orbits with other packed parameters, NaN at a kink or where
    no orbit is found.
    """
    sizes = []
    for share in (-NUDGE, 0.0, NUDGE):
        near = newton(shoot(orbit.p + share * direction, orbit.state, orbit.periods, orbit.phase))
        sizes.append([near.record["maximum_displacement"], abs(near.multipliers[0])])
        if not near.converged:
            return np.full(2, np.nan)
    behind, here, ahead = np.log(sizes)
    kinks = np.abs(ahead - 2 * here + behind) > KINK * NUDGE
    return np.where(kinks, np.nan, (ahead - behind) / (2 * NUDGE))
