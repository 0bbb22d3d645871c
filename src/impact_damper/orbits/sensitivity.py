"""Exact derivatives of motions and of periodic orbits by their parameters.

The variations of a motion are the derivatives of its end and of its derivative matrix, by Duhamel's
integral; at contacts, where the force jumps, they have additional terms.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from impact_damper.kernel.equation import (
    acceleration_by_parameters,
    forcing_amplitude,
    spring,
    spring_slope,
    spring_slope_changes,
)
from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    COUNT,
    DAMPING,
    DASHPOT,
    DESIGN,
    FREQUENCY,
    INVERSE_MASS_RATIO,
    design_slopes,
)
from impact_damper.orbits.orbit import Orbit
from impact_damper.orbits.paths import INTEGRALS, POINTS, Path, follow_path


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

    def matrix_changes(self, first, parameters):
        """Return the changes of `Path.matrix` along n directions, shape (n, 4, 4)."""
        changes = self.changes(first, parameters)
        inner = self._smooth(changes[0], parameters) + self._at_events(changes[2], parameters)
        return self.path.matrix @ inner

    def _smooth(self, change, parameters):
        """Return the part of B between events, shape (n, 4, 4), from the change of Z1.

        A_d is a sum of products of a column and a row, so each term of B is an integral over a
        column of P^-1 times a row of P.
        """
        p, tangents, inverse = self.path.p, self.path.tangents, self._inverse
        both, pushed, loose = self._columns
        weights = np.outer(self.path.lengths, INTEGRALS[-1]).ravel()

        def integral(column, row):
            return (weights * column) @ row.reshape(-1, len(weights)).T

        touching = np.abs(self.path.contacts[0])
        x = self.path.states[0]
        stiff = spring_slope_changes(p, x, change, parameters)
        bent = integral(both, stiff[:, None] * tangents[0]).reshape(4, -1, 4).swapaxes(0, 1)
        drag = integral(both, tangents[1])
        spring, dashpot = (integral(touching * pushed, tangents[i]) for i in (2, 3))
        wall = p[CONTACT_STIFFNESS] * tangents[2] + p[DASHPOT] * tangents[3]
        lighter = integral(touching * loose, wall)
        own = integral(both, spring_slope.py_func(p, x) * tangents[0])
        whole = integral(inverse[:, 0], tangents[1]) + integral(inverse[:, 2], tangents[3])
        whole -= own + p[DAMPING] * drag + integral(touching * pushed, wall)
        parts = np.stack([drag, spring, dashpot, lighter, whole / p[FREQUENCY]])
        kinds = [DAMPING, CONTACT_STIFFNESS, DASHPOT, INVERSE_MASS_RATIO, FREQUENCY]
        return -bent - np.tensordot(parameters[kinds].T, parts, axes=1)

    def _at_events(self, change, parameters):
        """Return the part of B from the events, shape (n, 4, 4), computed from the change of Z2."""
        p, third = self.path.p, np.eye(4)[2]
        column = np.array([0.0, 1.0, 0.0, 1.0 + p[INVERSE_MASS_RATIO]])
        total = np.zeros((parameters.shape[1], 4, 4))
        jumped = parameters[DASHPOT][:, None] * column
        jumped[:, 3] += p[DASHPOT] * parameters[INVERSE_MASS_RATIO]
        for point, wall, begun in zip(*self.path.events, strict=True):
            away = wall * parameters[CLEARANCE] - change[:, point]
            delay = away / self.path.states[3, point]
            jump = np.eye(4) - begun * p[DASHPOT] * np.outer(column, third)
            before, after = (self._jacobian(point, touching) for touching in (begun < 0, begun > 0))
            bend = jump @ before - after @ jump
            added = delay[:, None, None] * bend - begun * jumped[:, :, None] * third
            total += self._inverse[..., point + 1] @ added @ self.path.tangents[..., point]
        return total

    def _jacobian(self, point, touching):
        """Return the Jacobian A at a point, in flight or in contact, shape (4, 4)."""
        p = self.path.p
        stiffness = spring_slope.py_func(p, self.path.states[0, point])
        free = np.array([-stiffness, -p[DAMPING], 0.0, 0.0])
        wall = touching * np.array([0.0, 0.0, p[CONTACT_STIFFNESS], p[DASHPOT]])
        unit = np.eye(4)
        return np.array([unit[1], free - wall, unit[3], free - (1 + p[INVERSE_MASS_RATIO]) * wall])


# Two extrema of |Z1|, two moduli of multipliers, or two multipliers count as equal if they differ
# relatively by less than EQUAL.
EQUAL = 1e-6


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of an orbit with respect to its packed parameters.

    orbit: Orbit.
    state_slopes: Derivatives of the state at the phase of the orbit; shape (4, packed.COUNT).
    maximum_displacement: max |Z1|.
    displacement_slopes: Derivatives of max |Z1|; shape (packed.COUNT,).
    displacement_smooth: Whether max |Z1| is differentiable. It has a kink if |Z1| is largest at two
        phases with different derivatives.
    modulus: Modulus of the largest Floquet multiplier.
    modulus_slopes: Derivatives of the modulus; shape (packed.COUNT,).
    modulus_smooth: Whether the modulus is differentiable. It has a kink if two multipliers that are
        not a conjugate pair have the largest modulus, or if a real multiplier is double.
    matrix_slopes: Total derivatives of R_y, which is the root of the orbit (`Orbit.root`) or,
        without a root, its monodromy matrix. n is `Orbit.active`; shape (packed.COUNT, n, n).
    """

    orbit: Orbit
    state_slopes: np.ndarray
    maximum_displacement: float
    displacement_slopes: np.ndarray
    displacement_smooth: bool
    modulus: float
    modulus_slopes: np.ndarray
    modulus_smooth: bool
    matrix_slopes: np.ndarray

    def by_design(self, slopes) -> dict:
        """Return derivatives with respect to the parameters `packed.DESIGN`, keyed by name."""
        values = np.asarray(slopes) @ design_slopes(self.orbit.p)
        return dict(zip(DESIGN, np.moveaxis(values, -1, 0), strict=True))


def path_of(orbit, segment=None) -> Path:
    """Return the motion of an orbit over its cycle, or over a segment."""
    k = 0 if segment is None else segment
    end = orbit.phases[-1 if segment is None else k + 1]
    return follow_path(
        orbit.p, orbit.states[k], *np.array([orbit.phases[k], end]) / orbit.p[FREQUENCY]
    )


def sensitivity(orbit) -> Sensitivity:
    """Return the derivatives of a converged orbit."""
    if not orbit.converged:
        raise ValueError(f"orbit: must have converged, its residual is {orbit.residual:.1e}")
    path, n = path_of(orbit), orbit.active
    variations = Variations(path)
    matrix, sign = orbit.matrix, orbit.sign
    state = np.linalg.solve(np.eye(n) - matrix[:n, :n], sign * variations.slopes()[:n])
    if n == 2:  # the loose mass does not move
        state = np.vstack([state, state])
    along = np.eye(COUNT)
    slopes = sign * variations.matrix_changes(state, along)[:, :n, :n]
    largest, by_parameters, alone = _displacement(path, variations.changes(state, along)[0])
    modulus, relative, simple = _modulus(matrix[:n, :n], slopes)
    power = 2 if sign < 0 else 1
    return Sensitivity(
        orbit,
        state,
        largest,
        by_parameters,
        alone,
        modulus**power,
        power * modulus**power * relative,
        simple,
        slopes,
    )


def _displacement(path, changes):
    """Return max |Z1| on a path, its derivatives, and whether it is differentiable."""
    steps, sizes, weights, _ = path.turns(0)
    at_extrema = changes.reshape(len(changes), -1, POINTS)[:, steps]
    slopes = np.sign(sizes)[:, None] * np.einsum("nek,ek->en", at_extrema, weights)
    first = int(np.argmax(np.abs(sizes)))
    largest = abs(sizes[first])
    equal = np.abs(sizes) > (1 - EQUAL) * largest
    spread = np.max(np.abs(slopes[equal] - slopes[first]))
    smooth = spread <= EQUAL**0.5 * np.max(np.abs(slopes[first]))
    return float(largest), slopes[first], bool(smooth)


def _modulus(matrix, slopes):
    """Return the largest modulus of the eigenvalues of a matrix, and its relative derivatives.

    `slopes` are the derivatives of the matrix. The third result states whether the modulus is
    differentiable.
    """
    values, right = np.linalg.eig(matrix)
    first = int(np.argmax(np.abs(values)))
    value, modulus = values[first], abs(values[first])
    left = np.linalg.inv(right)[first]
    change = np.einsum("i,nij,j->n", left, slopes, right[:, first])
    others = np.delete(values, first)
    if abs(value.imag) > EQUAL * modulus:
        others = others[np.abs(others - value.conjugate()) > EQUAL * modulus]
    smooth = np.all(np.abs(others) < (1 - EQUAL) * modulus)
    return float(modulus), (change / value).real, bool(smooth)
