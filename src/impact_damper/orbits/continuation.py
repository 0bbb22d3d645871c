"""Pseudo-arclength continuation of periodic orbits in one parameter.

The unknowns are the state of an orbit, at a phase of the forcing at which it is in flight, and the
parameter. A step goes along the tangent of the branch and is corrected by Newton's method at right
angles to the tangent, so that folds are passed. The derivative with respect to the parameter is a
central difference; its error affects the direction of a step, not the orbit.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from impact_damper.orbits.shooting import TURN, Orbit, shoot
from impact_damper.system.packed import CLEARANCE

# Change of the parameter in the central difference.
NUDGE = 1e-5
# Newton's method: most corrections, and the largest of them. It has converged once a correction is
# below CLOSE, or below ROUNDING and no longer halved by the next.
NEWTON = 16
LARGEST = 0.5
CLOSE, ROUNDING = 1e-10, 1e-4
# Singular values below this share of the largest are left out.
SINGULAR = 1e-8
# An orbit with a smaller asymmetry is symmetric.
SYMMETRIC = 1e-6
# Steps, in branch length.
FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 0.01, 0.04, 1e-7
FARTHEST_GUESS = 2 * LONGEST_STEP
# Least cosine between the tangents at both ends of a step.
STRAIGHT = 0.98
# A correction by more than this share of the step may have led to another branch.
ASIDE = 0.2


class Point(NamedTuple):
    """A point of a branch.

    Attributes
    ----------
    value : float
        The parameter.
    orbit : Orbit
    x : numpy.ndarray
        The n unknowns Z1, Z1', with a damper Z2, Z2' too, and the parameter: shape (n + 1,).
    tangent : numpy.ndarray, shape (n + 1,)
        Unit tangent of the branch.
    """

    value: float
    orbit: Orbit
    x: np.ndarray
    tangent: np.ndarray


@dataclass(frozen=True)
class Problem:
    """The equations that the orbits of a branch solve.

    Attributes
    ----------
    family : callable
        Maps the parameter to packed parameters.
    periods : int
        Period of the orbits in forcing periods.
    phase : float
        Phase W T at which their states are given, radian.
    loose : numpy.ndarray, shape (2,)
        Z2 - Z1 and Z2' - Z1'. Without a damper they have no effect and are kept constant.
    damped : bool
        Whether the damper is on.
    symmetric : bool
        Whether orbits are found as symmetric ones, by the map over half the period. This map is
        regular where an orbit loses its symmetry; the map over the period is not.
    """

    family: Callable[[float], np.ndarray]
    periods: int
    phase: float
    loose: np.ndarray
    damped: bool
    symmetric: bool

    @classmethod
    def of(cls, family, orbit):
        """Return the problem that an orbit of a family solves."""
        return cls(
            family,
            orbit.periods,
            orbit.phase,
            orbit.state[2:] - orbit.state[:2],
            bool(np.isfinite(orbit.p[CLEARANCE])),
            bool(orbit.record["asymmetry"] < SYMMETRIC),
        )

    def shoot(self, x):
        """Return the `Orbit` at the unknowns x, without iteration, and its defect, shape (n,).

        The defect is the state after the map less the state before.
        """
        state = x[:-1] if self.damped else np.concatenate([x[:2], x[:2] + self.loose])
        p = self.family(x[-1])
        orbit, end = shoot(p, state, self.periods, self.phase, symmetric=self.symmetric)
        return orbit, (end - state)[: len(x) - 1]

    def rows(self, x, orbit):
        """Return the derivative of the defect with respect to the unknowns, shape (n, n + 1)."""
        n = len(x) - 1
        matrix = orbit.monodromy if orbit.root is None else orbit.root
        nudge = np.zeros(n + 1)
        nudge[-1] = NUDGE
        by_parameter = (self.shoot(x + nudge)[1] - self.shoot(x - nudge)[1]) / (2 * NUDGE)
        return np.column_stack([matrix[:n, :n] - np.eye(n), by_parameter])

    def correct(self, x, border):
        """Return the point that Newton's method reaches at right angles to `border`, or None.

        Where branches cross the matrix is singular: its smallest singular value is left out. The
        last corrections are then rounding errors, which no longer shrink, so convergence is
        judged by the residual.
        """
        x, last = x.copy(), np.inf
        for _ in range(NEWTON):
            orbit, defect = self.shoot(x)
            try:
                rows = self.rows(x, orbit)
                matrix = np.vstack([rows, border])
                change = np.linalg.lstsq(matrix, -np.append(defect, 0.0), SINGULAR)[0]
            except (np.linalg.LinAlgError, ValueError):
                return None
            size = np.max(np.abs(change))
            if not size < LARGEST:
                return None
            if orbit.converged and (size < CLOSE or last / 2 < size < ROUNDING):
                return self.point(x, orbit, rows, border)
            x, last = x + change, size
        return None

    def point(self, x, orbit, rows, border):
        """Return the point at converged unknowns, its tangent within 90 degrees of `border`."""
        tangent = np.linalg.lstsq(np.vstack([rows, border]), np.eye(len(x))[-1], SINGULAR)[0]
        return Point(x[-1], orbit, x, tangent / np.linalg.norm(tangent))

    def step(self, point, length):
        """Return the point a step along the branch from a point, or None."""
        x = point.x + length * point.tangent
        ahead = self.correct(x, point.tangent)
        aside = ASIDE * abs(length) + ROUNDING
        return None if ahead is None or np.linalg.norm(ahead.x - x) > aside else ahead

    def at_value(self, point, value):
        """Return the point at a value of the parameter close to that of a point, or None.

        The first guess lies on the tangent. Near a fold, where the tangent is at right angles to
        the parameter, it would lie far away, in states that take minutes to integrate: it is
        taken at most FARTHEST_GUESS along the tangent.
        """
        length = (value - point.x[-1]) / (point.tangent[-1] or np.inf)
        x = point.x + np.clip(length, -FARTHEST_GUESS, FARTHEST_GUESS) * point.tangent
        x[-1] = value
        near = self.correct(x, np.eye(len(x))[-1])
        if near is None:
            return None
        return near._replace(tangent=near.tangent * np.sign(near.tangent @ point.tangent))

    def begin(self, orbit, value, direction):
        """Return the point of an orbit at a parameter value, or None.

        Along the tangent the parameter falls (direction -1) or rises (1).
        """
        size = 4 if self.damped else 2
        x = np.append(orbit.state[:size], value)
        return self.correct(x, direction * np.eye(size + 1)[-1])

    def rephased(self, point):
        """Return problem and point at a phase far from contacts, or None if Newton's method fails.

        Both are returned unchanged if the present phase is far enough from all contacts. The
        direction of the tangent is kept: a point displaced along it is integrated to the new phase.
        """
        orbit = point.orbit
        phase = orbit.quiet_phase()
        if phase == orbit.phase:
            return self, point
        problem = replace(self, phase=phase % TURN)
        x = np.append(orbit.at(phase), point.x[-1])
        nudged = point.x + NUDGE * point.tangent
        family = self.family(nudged[-1])
        ahead = replace(orbit, p=family, state=nudged[:-1]).at(phase)
        border = np.append(ahead, nudged[-1]) - x
        moved = problem.correct(x, border / np.linalg.norm(border))
        return None if moved is None else (problem, moved)
