"""Pseudo-arclength continuation of periodic orbits in one parameter.

The unknowns are the states at the beginning of an orbit's segments, at phases of the forcing at
which it is in flight, and the parameter. A mild orbit is one segment (single shooting); one that
amplifies disturbances strongly is cut into several (`segments`). A step goes along the tangent of
the branch and is corrected by Newton's method at right angles to the tangent, so that folds are
passed. The derivative with respect to the parameter is a central difference; its error affects
the direction of a step, not the orbit.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from impact_damper.orbits import segments
from impact_damper.orbits.orbit import TURN, Orbit
from impact_damper.orbits.shooting import AMPLIFYING, orbit_of, shoot
from impact_damper.system.packed import CLEARANCE

# Change of the parameter in the central difference.
NUDGE = 2e-7
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
FIRST_STEP, SHORTEST_STEP = 0.01, 1e-9
# The longest steps on symmetric or stable orbits, and on others, as shares of the unknowns' size.
LONGEST, LONGEST_UNSTABLE = 0.02, 0.06
FARTHEST_GUESS = 0.08
# A correction by more than this share of the step may have led to another branch.
ASIDE = 0.2
# An orbit is cut again if a contact comes closer to a section than this, in radians, or if a
# segment amplifies by this factor more than when it was cut; and made one segment again if it
# amplifies less than this share of AMPLIFYING.
NEAR_SECTION, ROUGHER, MILD = 0.02, 4.0, 0.5


class Point(NamedTuple):
    """A point of a branch.

    Attributes
    ----------
    value : float
        The parameter.
    orbit : Orbit
    x : numpy.ndarray, shape (m n + 1,)
        The unknowns: for each of m segments Z1, Z1', with a damper Z2, Z2' too, then the parameter.
    tangent : numpy.ndarray, shape (m n + 1,)
        Unit tangent of the branch, in the metric of the problem.
    problem : Problem
        The equations that the unknowns solve.
    bend : numpy.ndarray, shape (m n + 1,), or float
        Estimate of the derivative of the tangent by the length, for the guess of the next point.
    """

    value: float
    orbit: Orbit
    x: np.ndarray
    tangent: np.ndarray
    problem: "Problem"
    bend: np.ndarray | float = 0.0


@dataclass(frozen=True)
class Problem:
    """The equations that the orbits of a branch solve.

    The distance of two points is the root of the mean square over the segments of the distance of
    their states, and of the square of the difference of the parameter.

    Attributes
    ----------
    family : callable
        Maps the parameter to packed parameters.
    periods : int
        Period of the orbits in forcing periods.
    phases : numpy.ndarray, shape (m + 1,)
        Phases W T at which the segments begin, and at which the last one ends, radian.
    loose : numpy.ndarray, shape (2,)
        Z2 - Z1 and Z2' - Z1'. Without a damper they have no effect and are kept constant.
    damped : bool
        Whether the damper is on.
    symmetric : bool
        Whether orbits are found as symmetric ones, by the map over half the period. This map is
        regular where an orbit loses its symmetry; the map over the period is not.
    rough : float
        Largest norm of the derivative of a segment when the orbit was cut into them.
    """

    family: Callable[[float], np.ndarray]
    periods: int
    phases: np.ndarray
    loose: np.ndarray
    damped: bool
    symmetric: bool
    rough: float = 0.0

    @classmethod
    def of(cls, family, orbit, *, symmetric=None):
        """Return the problem that an orbit of a family solves.

        Whether it is a symmetric one is seen from the orbit unless `symmetric` says so.
        """
        if symmetric is None:
            symmetric = bool(orbit.record["asymmetry"] < SYMMETRIC)
        cycle = orbit.periods * TURN * (0.5 if symmetric else 1.0)
        cutting = orbit.chain is not None
        return cls(
            family,
            orbit.periods,
            segments.cut(orbit, cycle) if cutting else orbit.phase + np.array([0.0, cycle]),
            orbit.state[2:] - orbit.state[:2],
            bool(np.isfinite(orbit.p[CLEARANCE])),
            symmetric,
        )

    @property
    def cycle(self):
        """Phase over which orbits are integrated, radian."""
        return self.phases[-1] - self.phases[0]

    @property
    def metric(self):
        """Weights of the squares of the unknowns in a distance, shape (m n + 1,)."""
        m = len(self.phases) - 1
        return np.append(np.full(m * (4 if self.damped else 2), 1 / m), 1.0)

    def length(self, vector):
        """Return the length of a difference of unknowns."""
        return float(np.sqrt(self.metric @ vector**2))

    def unknowns(self, orbit, value):
        """Return the unknowns of an orbit at a value of the parameter."""
        size = 4 if self.damped else 2
        return np.append([orbit.at(phase)[:size] for phase in self.phases[:-1]], value)

    def _states(self, x):
        """Return the states at the beginning of the segments, shape (m, 4)."""
        if self.damped:
            return x[:-1].reshape(-1, 4)
        return np.concatenate([x[:2], x[:2] + self.loose])[None]

    def shoot(self, x):
        """Return the `Orbit` at the unknowns x, without iteration, and its defect, shape (m n,).

        The defect is the states after each segment less the states that they should be.
        """
        p, states = self.family(x[-1]), self._states(x)
        if len(states) == 1:
            phase, symmetric = self.phases[0], self.symmetric
            orbit, end = shoot(p, states[0], self.periods, phase, symmetric=symmetric)
            return orbit, (end - states[0])[: len(x) - 1]
        sign = -1 if self.symmetric else 1
        orbit = orbit_of(segments.chain_of(p, self.phases, states, sign), self.periods)
        return orbit, orbit.chain.defects.ravel()

    def rate(self, value):
        """Return the derivative of the packed parameters by the parameter, shape (COUNT,)."""
        ahead, behind = self.family(value + NUDGE), self.family(value - NUDGE)
        # without a damper the clearance is infinite
        return np.subtract(ahead, behind, out=np.zeros(len(ahead)), where=ahead < np.inf) / (
            2 * NUDGE
        )

    def rows(self, x, orbit, rate=None):
        """Return the derivative of the defect by the unknowns, shape (m n, m n + 1).

        `rate` is the one at a parameter nearby, if it is known.
        """
        n = 4 if self.damped else 2
        states = self._states(x)
        change = NUDGE * (self.rate(x[-1]) if rate is None else rate)
        ahead, behind = (
            segments.ends_of(orbit.p + nudge, self.phases, states)[:, :n]
            for nudge in (change, -change)
        )
        by_parameter = (ahead - behind) / (2 * NUDGE)
        by_parameter[-1] *= -1 if self.symmetric else 1
        return np.column_stack([segments.cyclic(orbit.factors[:, :n, :n]), by_parameter.ravel()])

    def correct(self, x, border):
        """Return the point that Newton's method reaches at right angles to `border`, or None.

        Where branches cross the matrix is singular: its smallest singular value is left out. The
        last corrections are then rounding errors, which no longer shrink, so convergence is
        judged by the residual.
        """
        x, last, row = x.copy(), np.inf, self.metric * border
        rate = self.rate(x[-1])
        for _ in range(NEWTON):
            orbit, defect = self.shoot(x)
            try:
                rows = self.rows(x, orbit, rate)
                matrix = np.vstack([rows, row])
                change = _solved(matrix, -np.append(defect, 0.0))
            except (np.linalg.LinAlgError, ValueError):
                return None
            if not border[:-1].any():
                change[-1] = 0.0  # the parameter is given, to the last digit
            size = np.max(np.abs(change))
            if not size < LARGEST:
                return None
            if orbit.converged and (size < CLOSE or last / 2 < size < ROUNDING):
                return self.point(x, orbit, rows, row)
            x, last = x + change, size
        return None

    def point(self, x, orbit, rows, row):
        """Return the point at converged unknowns, its tangent with a positive product by `row`."""
        tangent = _solved(np.vstack([rows, row]), np.eye(len(x))[-1])
        return Point(x[-1], orbit, x, tangent / self.length(tangent), self)

    def step(self, point, length):
        """Return the point a step along the branch from a point, or None."""
        bent = length**2 / 2 * point.bend
        return self.near(point.x + length * point.tangent + bent, point.tangent, length)

    def near(self, x, border, length):
        """Return the point that Newton's method finds close to a guess, relative to a length."""
        found = self.correct(x, border)
        aside = ASIDE * abs(length) + min(ROUNDING, abs(length))
        return None if found is None or self.length(found.x - x) > aside else found

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
        turned = np.sign((self.metric * near.tangent) @ point.tangent)
        return near._replace(tangent=near.tangent * turned)

    def begin(self, orbit, value, direction):
        """Return the point of an orbit at a parameter value, or None.

        Along the tangent the parameter falls (direction -1) or rises (1).
        """
        x = self.unknowns(orbit, value)
        return self.correct(x, direction * np.eye(len(x))[-1])

    def holds_still(self, point):
        """Return whether the sections of a point are still good ones."""
        orbit = point.orbit
        if not self.damped:
            return True
        if len(self.phases) == 2 and self.rough == 0:
            return orbit.amplification <= AMPLIFYING and orbit.quiet_phase() == orbit.phase
        norms = np.linalg.norm(orbit.factors, 2, axis=(1, 2))
        near = min(orbit.margin(phase) for phase in self.phases[:-1])
        mild = orbit.amplification < MILD * AMPLIFYING
        return not mild and near > NEAR_SECTION and np.max(norms) < ROUGHER * self.rough

    def recut(self, point, between=()):
        """Return a point with new sections, or the same point if Newton's method fails with them.

        The direction of the tangent is kept: a point displaced along it is integrated to the new
        sections. With phases `between`, segments are cut as `segments.cut` says.
        """
        orbit = point.orbit
        phases, rough = segments.cut(orbit, self.cycle, between), 1.0
        if not between and orbit.amplification <= AMPLIFYING:
            phases, rough = orbit.quiet_phase() + np.array([0.0, self.cycle]), 0.0
        problem = replace(self, phases=phases - phases[0] + phases[0] % TURN, rough=rough)
        x = np.append([orbit.at(phase) for phase in phases[:-1]], point.x[-1])
        nudged = point.x + NUDGE * point.tangent
        p, states = self.family(nudged[-1]), self._states(nudged)
        if orbit.chain is None:
            displaced = replace(orbit, p=p, state=states[0])
        else:
            displaced = replace(orbit.chain, p=p, states=states)
        ahead = np.append([displaced.at(phase) for phase in phases[:-1]], nudged[-1])
        border = (ahead - x) / problem.length(ahead - x)
        moved = problem.correct(x, border)
        if moved is None:
            return point
        norms = np.linalg.norm(moved.orbit.factors, 2, axis=(1, 2))
        problem = replace(problem, rough=np.max(norms) if rough else 0.0)
        return moved._replace(problem=problem)


def _solved(matrix, right):
    """Solve linear equations; the smallest singular values are left out if the matrix has some.

    The equations of many segments are solved by elimination, which is faster, unless the result
    is so large that the matrix must be nearly singular.
    """
    if len(right) > 5:
        solution = np.linalg.solve(matrix, right)
        if np.max(np.abs(solution)) < np.max(np.abs(right)) / SINGULAR**0.5:
            return solution
    return np.linalg.lstsq(matrix, right, SINGULAR)[0]
