"""Pseudo-arclength continuation of periodic orbits in one parameter.

The unknowns are the parameter and the states at the beginnings of an orbit's segments, at phases of
the forcing at which the loose mass is in flight. Most orbits have one segment (single shooting). An
orbit that strongly amplifies disturbances is cut into several segments (`segments`). A step goes
along the tangent of the branch and is corrected by Newton's method orthogonally to the tangent, so
that the continuation passes folds. The derivative with respect to the parameter is a central
difference. Its error changes the direction of a step, but not the orbits. Where a contact appears
within the difference, a finer difference is taken.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from impact_damper.orbits import segments
from impact_damper.orbits.orbit import TURN, Orbit
from impact_damper.orbits.shooting import AMPLIFYING, orbit_of, shoot
from impact_damper.system.packed import CLEARANCE

# Change of the parameter in the central difference. If the forward and the backward difference
# differ by more than the share BENT, a contact appears between them, and FINE_NUDGE is taken.
NUDGE, FINE_NUDGE, BENT = 2e-7, 1e-9, 1e-3
# Avoids a division by zero.
TINY = 1e-300
# Newton's method. NEWTON: largest number of corrections. LARGEST: largest size of a correction. The
# method has converged once a correction is below CLOSE, or below ROUNDING and more than half the
# correction before.
NEWTON = 10
LARGEST = 0.5
CLOSE, ROUNDING = 1e-10, 1e-4
# Singular values below SINGULAR times the largest singular value are set to zero.
SINGULAR = 1e-8
# An orbit is symmetric if its asymmetry is below SYMMETRIC.
SYMMETRIC = 1e-6
# First and shortest step, in branch length.
FIRST_STEP, SHORTEST_STEP = 0.01, 1e-9
# Longest step divided by the length of the unknowns: on symmetric or stable orbits, and on other
# orbits.
LONGEST, LONGEST_UNSTABLE = 0.02, 0.06
# Largest distance of a first guess along the tangent, in `Problem.at_value`.
FARTHEST_GUESS = 0.08
# A correction that exceeds ASIDE times the step may have led to another branch.
ASIDE = 0.2
# An orbit is cut into new segments if a contact comes closer to a section than NEAR_SECTION
# (radian), or if a segment amplifies ROUGHER times more than when it was cut. It becomes one
# segment again if it amplifies less than MILD times AMPLIFYING.
NEAR_SECTION, ROUGHER, MILD = 0.02, 4.0, 0.5


class Point(NamedTuple):
    """A point of a branch.

    Attributes
    ----------
    value : float
        The parameter.
    orbit : Orbit
    x : numpy.ndarray, shape (m n + 1,)
        The unknowns: Z1, Z1' and, with a damper, Z2, Z2' for each of m segments; then the
        parameter.
    tangent : numpy.ndarray, shape (m n + 1,)
        Unit tangent of the branch, in the metric of the problem.
    problem : Problem
        The equations that the unknowns solve.
    bend : numpy.ndarray, shape (m n + 1,), or float
        Estimate of the derivative of the tangent by the branch length, for the next first guess.
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

    The square of the distance of two points is the mean over the segments of the squared distance
    of their states, plus the squared difference of the parameter.

    Attributes
    ----------
    family : callable
        Maps the parameter to packed parameters.
    periods : int
        Period of the orbits in forcing cycles.
    phases : numpy.ndarray, shape (m + 1,)
        Phases W T at which the segments begin, and at which the last segment ends, radian.
    loose : numpy.ndarray, shape (2,)
        Z2 - Z1 and Z2' - Z1'. Without a damper they have no effect and are kept constant.
    damped : bool
        Whether there is a damper.
    symmetric : bool
        If True, only symmetric orbits are found, by the map over half the period. This map is
        regular where an orbit loses its symmetry. The map over the whole period is singular there.
    rough : float
        Largest norm of the derivative of a segment at the time when the orbit was cut.
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

        By default the attribute `symmetric` is True if the orbit is symmetric.
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
        """Weights of the squared unknowns in a squared distance, shape (m n + 1,)."""
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

        The defect is the state after each segment minus the state at which the next segment begins.
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
        # Without a damper the clearance is infinite. Its derivative is set to 0.
        return np.subtract(ahead, behind, out=np.zeros(len(ahead)), where=ahead < np.inf) / (
            2 * NUDGE
        )

    def rows(self, x, orbit, rate=None, known=None):
        """Return the derivative of the defect by the unknowns, shape (m n, m n + 1).

        Parameters
        ----------
        x : array, shape (m n + 1,)
        orbit : Orbit
            The orbit at the unknowns.
        rate : array, shape (COUNT,), optional
            Result of `rate` at a parameter nearby, if it is known.
        known : (int, array), optional
            A segment, and the derivative of its end by the parameter, shape (4,), if it is known.
        """
        n = 4 if self.damped else 2
        states = self._states(x)
        rate = self.rate(x[-1]) if rate is None else rate
        chain = orbit.chain
        ends = segments.ends_of(orbit.p, self.phases, states) if chain is None else chain.ends
        by_parameter, bent = self._slopes(orbit.p, states, ends, self.phases, rate, NUDGE)
        for k in np.flatnonzero(bent > BENT) if self.damped else ():
            if known is None or k != known[0]:
                here = orbit.p, states[k : k + 1], ends[k : k + 1], self.phases[k : k + 2]
                by_parameter[k] = self._slopes(*here, rate, FINE_NUDGE)[0][0]
        if known is not None:
            by_parameter[known[0]] = known[1]
        by_parameter[-1] *= -1 if self.symmetric else 1
        return np.column_stack([segments.cyclic(orbit.factors[:, :n, :n]), by_parameter.ravel()])

    def _slopes(self, p, states, ends, phases, rate, nudge):
        """Return the derivatives of the ends of segments by the parameter, as differences.

        Returns
        -------
        slopes : numpy.ndarray, shape (m, n)
        bent : numpy.ndarray, shape (m,)
            By how much the difference ahead and the one behind differ, as a share of their sum.
        """
        n = 4 if self.damped else 2
        ahead, behind = (
            segments.ends_of(p + change, phases, states)[:, :n]
            for change in (nudge * rate, -nudge * rate)
        )
        whole, bend = ahead - behind, ahead + behind - 2 * ends[:, :n]
        bent = np.abs(bend).max(axis=1) / (np.abs(whole).max(axis=1) + TINY)
        return whole / (2 * nudge), bent

    def correct(self, x, border):
        """Return the point that Newton's method reaches from x, or None.

        The corrections are orthogonal to `border`. Where branches cross the matrix is singular, and
        its smallest singular value is set to zero. The last corrections are then rounding errors,
        which no longer shrink, so the residual decides whether the method has converged.
        """
        x, last, row = x.copy(), np.inf, self.metric * border
        rate = self.rate(x[-1])
        for _ in range(NEWTON):
            try:
                orbit, defect = self.shoot(x)
                rows = self.rows(x, orbit, rate)
                matrix = np.vstack([rows, row])
                change = _solved(matrix, -np.append(defect, 0.0))
            except (np.linalg.LinAlgError, ValueError):
                return None
            if not border[:-1].any():
                change[-1] = 0.0  # the parameter must keep its value exactly
            size = np.max(np.abs(change))
            if not size < LARGEST:
                return None
            if orbit.converged and (size < CLOSE or last / 2 < size < ROUNDING):
                return self.point(x, orbit, rows, row)
            x, last = x + change, size
        return None

    def point(self, x, orbit, rows, row):
        """Return the point at converged unknowns; its tangent has a positive product with `row`."""
        tangent = _solved(np.vstack([rows, row]), np.eye(len(x))[-1])
        return Point(x[-1], orbit, x, tangent / self.length(tangent), self)

    def step(self, point, length):
        """Return the point at a distance `length` along the branch from a point, or None."""
        bent = length**2 / 2 * point.bend
        return self.near(point.x + length * point.tangent + bent, point.tangent, length)

    def near(self, x, border, length):
        """Return the point that Newton's method finds from a guess x, or None.

        None is also returned if the correction exceeds ASIDE times the length.
        """
        point = self.correct(x, border)
        aside = ASIDE * abs(length) + min(ROUNDING, abs(length))
        return None if point is None or self.length(point.x - x) > aside else point

    def at_value(self, point, value):
        """Return the point at a value of the parameter close to the value of a point, or None.

        The first guess lies on the tangent, at a distance of at most FARTHEST_GUESS. Near a fold
        the tangent is nearly orthogonal to the parameter. Without the limit the guess would then be
        a large state, whose integration takes minutes.
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
        """Return the point of an orbit at a value of the parameter, or None.

        Along the tangent of the point the parameter decreases (direction -1) or increases (1).
        """
        x = self.unknowns(orbit, value)
        return self.correct(x, direction * np.eye(len(x))[-1])

    def holds_still(self, point):
        """Return whether the segments of a point can be kept (see NEAR_SECTION)."""
        orbit = point.orbit
        if not self.damped:
            return True
        if len(self.phases) == 2 and self.rough == 0:
            return orbit.amplification <= AMPLIFYING and orbit.flight_phase() == orbit.phase
        norms = np.linalg.norm(orbit.factors, 2, axis=(1, 2))
        near = min(orbit.margin(phase) for phase in self.phases[:-1])
        mild = orbit.amplification < MILD * AMPLIFYING
        return not mild and near > NEAR_SECTION and np.max(norms) < ROUGHER * self.rough

    def recut(self, point, between=()):
        """Return a point with new segments, or the same point if Newton's method fails with them.

        To keep the direction of the tangent, a point displaced along the tangent is integrated to
        the new sections too. `between` is the argument of `segments.cut`.
        """
        orbit = point.orbit
        phases, rough = segments.cut(orbit, self.cycle, between), 1.0
        if not between and orbit.amplification <= AMPLIFYING:
            phases, rough = orbit.flight_phase() + np.array([0.0, self.cycle]), 0.0
        problem = replace(self, phases=phases - phases[0] + phases[0] % TURN, rough=rough)
        x = np.append([orbit.at(phase) for phase in phases[:-1]], point.x[-1])
        nudged = point.x + FINE_NUDGE * point.tangent
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
    """Return the solution of linear equations, with very small singular values set to zero.

    The equations of several segments are solved by elimination, which is faster, unless the
    solution is so large that the matrix must be nearly singular.
    """
    if len(right) > 5:
        solution = np.linalg.solve(matrix, right)
        if np.max(np.abs(solution)) < np.max(np.abs(right)) / SINGULAR**0.5:
            return solution
    return np.linalg.lstsq(matrix, right, SINGULAR)[0]
