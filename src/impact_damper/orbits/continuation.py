"""Pseudo-arclength continuation of periodic orbits in one parameter.

A point is the state of an orbit at a phase in flight, and the parameter. From point to point a
curve is followed by a step along its tangent and Newton's method at right angles to it, so that
folds are passed. The derivative by the parameter is a central difference: it decides the
direction of a step, not the orbit.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from impact_damper.orbits.shooting import TURN, Orbit, shoot
from impact_damper.system.packed import CLEARANCE

NUDGE = 1e-5
NEWTON = 16
CLOSE, ROUNDING = 1e-10, 1e-4
SINGULAR = 1e-8
SYMMETRIC = 1e-6
FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 0.01, 0.04, 1e-7
FARTHEST_GUESS = 2 * LONGEST_STEP
STRAIGHT = 0.98  # least cosine between the tangents at both ends of a step
ASIDE = 0.2  # a correction by more than this part of the step may have led to another branch


class Point(NamedTuple):
    """A point of a branch.

    Attributes
    ----------
    value : float
        The parameter.
    orbit : Orbit
    x : numpy.ndarray
        Unknowns: Z1, Z1' (and Z2, Z2' with a damper), and the parameter.
    tangent : numpy.ndarray
        Unit tangent in these.
    """

    value: float
    orbit: Orbit
    x: np.ndarray
    tangent: np.ndarray


@dataclass(frozen=True)
class Problem:
    """Orbits of a family of systems, looked at at one phase.

    Attributes
    ----------
    family : callable
        From the parameter to packed parameters.
    periods : int
    phase : float
    loose : numpy.ndarray, shape (2,)
        Z2 and Z2' less Z1 and Z1' where no damper is on, for then these do not matter.
    damped : bool
    symmetric : bool
        Whether the orbits are symmetric and found by half the map, which is regular where
        they lose their symmetry.
    """

    family: Callable[[float], np.ndarray]
    periods: int
    phase: float
    loose: np.ndarray
    damped: bool
    symmetric: bool

    @classmethod
    def of(cls, family, orbit):
        """The problem that an orbit solves."""
        return cls(
            family,
            orbit.periods,
            orbit.phase,
            orbit.state[2:] - orbit.state[:2],
            bool(np.isfinite(orbit.p[CLEARANCE])),
            bool(orbit.record["asymmetry"] < SYMMETRIC),
        )

    def shoot(self, x):
        """The orbit at some unknowns, not iterated, and how far its state is from its return."""
        state = x[:-1] if self.damped else np.concatenate([x[:2], x[:2] + self.loose])
        p = self.family(x[-1])
        orbit, end = shoot(p, state, self.periods, self.phase, symmetric=self.symmetric)
        return orbit, (end - state)[: len(x) - 1]

    def rows(self, x, orbit):
        """Derivative of the defect by the unknowns, shape (n, n + 1)."""
        n = len(x) - 1
        matrix = orbit.monodromy if orbit.root is None else orbit.root
        nudge = np.zeros(n + 1)
        nudge[-1] = NUDGE
        by_parameter = (self.shoot(x + nudge)[1] - self.shoot(x - nudge)[1]) / (2 * NUDGE)
        return np.column_stack([matrix[:n, :n] - np.eye(n), by_parameter])

    def correct(self, x, border):
        """Newton's method at right angles to a border; the point, or None if it fails.

        Where branches cross the matrix is singular. Its least singular value is left out there,
        and the last corrections are rounding that no longer shrinks: the residual decides.
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
            if not size < 0.5:
                return None
            if orbit.converged and (size < CLOSE or last / 2 < size < ROUNDING):
                return self.point(x, orbit, rows, border)
            x, last = x + change, size
        return None

    def point(self, x, orbit, rows, border):
        """The point at some unknowns, its tangent along the border."""
        tangent = np.linalg.lstsq(np.vstack([rows, border]), np.eye(len(x))[-1], SINGULAR)[0]
        return Point(x[-1], orbit, x, tangent / np.linalg.norm(tangent))

    def step(self, point, length):
        """The point a step further along the branch, or None."""
        x = point.x + length * point.tangent
        found = self.correct(x, point.tangent)
        aside = ASIDE * abs(length) + ROUNDING
        return None if found is None or np.linalg.norm(found.x - x) > aside else found

    def at_value(self, point, value):
        """Return the point at a value of the parameter close to that of a point, or None.

        The first guess lies on the tangent. Near a fold, where the tangent is at right angles to
        the parameter, it would lie far away, in states that take minutes to integrate: it is
        taken at most FARTHEST_GUESS along the tangent.
        """
        length = (value - point.x[-1]) / (point.tangent[-1] or np.inf)
        x = point.x + np.clip(length, -FARTHEST_GUESS, FARTHEST_GUESS) * point.tangent
        x[-1] = value
        found = self.correct(x, np.eye(len(x))[-1])
        if found is None:
            return None
        return found._replace(tangent=found.tangent * np.sign(found.tangent @ point.tangent))

    def begin(self, orbit, value, direction):
        """The point at an orbit, its tangent in the direction (-1 or 1) of the parameter."""
        size = 4 if self.damped else 2
        x = np.append(orbit.state[:size], value)
        return self.correct(x, direction * np.eye(size + 1)[-1])

    def rephased(self, point):
        """The problem and the point at another phase, if contacts come near; or None.

        The tangent keeps its direction: it is carried along by a short displacement.
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
        found = problem.correct(x, border / np.linalg.norm(border))
        return None if found is None else (problem, found)
