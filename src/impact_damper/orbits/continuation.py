"""Pseudo-arclength continuation of periodic orbits in one parameter.

A branch is the curve of the periodic orbits over the parameter. The unknowns of a point of a branch
are the parameter and the states at the beginnings of the orbit's segments, at phases of the forcing
at which the loose mass is in flight. Most orbits have one segment (single shooting). An orbit that
strongly amplifies disturbances is cut into several segments (`segments`), together called a chain.

A step goes along the tangent of the branch. Newton's method then corrects its end orthogonally to
the tangent, so that the continuation passes folds, at which the branch turns back. The derivative
with respect to the parameter is a central difference. Its error changes the direction of a step,
but not the orbits. Where a contact appears within the difference, a finer difference is taken.

In shapes, m is the number of segments and n the number of unknowns of a state: 4 with a damper, or
2 without. Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose
mass and W T the phase of the forcing.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import CLEARANCE
from impact_damper.motions.segment_runs import NUDGE, correction, slopes_of_ends
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.orbits import segments
from impact_damper.orbits.orbit import TURN, Orbit
from impact_damper.orbits.shooting import orbit_of

# Newton's method. The size of a correction is the largest change of an unknown.
# NEWTON: largest number of corrections.
# LARGEST: largest size of a correction.
NEWTON = 10
LARGEST = 0.5
# Newton's method has converged in one of three cases. In each of them the residual of the orbit
# must be small too.
# CLOSE: the size of the last correction is below CLOSE.
# ROUNDING: it is below ROUNDING and more than half that of the correction before. The corrections
#   are then rounding errors, which no longer shrink.
# SURE: the size of the correction before the last is below SURE.
CLOSE, ROUNDING = 1e-10, 1e-4
# SHRINKING: Newton's method has failed if a correction exceeds SHRINKING times the one before,
# unless it is smaller than SURE.
SURE, SHRINKING = 1e-6, 0.7
# The derivative by the parameter is expensive. It is computed again only after a correction below
# REFINED, if the corrections since its last computation add up to more than UNMOVED.
REFINED, UNMOVED = 1e-4, 5e-6
# A linear system is nearly singular if its solution exceeds the right side by the factor
# SINGULAR^-0.5. Then singular values below SINGULAR times the largest one are set to zero.
SINGULAR = 1e-8
# An orbit is symmetric if its asymmetry, the entry of `records.MOTION`, is below SYMMETRIC.
SYMMETRIC = 1e-6
# First and shortest step along a branch, as a distance in the metric of `Problem`.
FIRST_STEP, SHORTEST_STEP = 0.01, 1e-9
# Longest step, divided by the length of the vector of unknowns.
# LONGEST: if the orbits are symmetric or stable.
# LONGEST_UNSTABLE: if they are neither.
# SMALLEST: the length of the vector counts as SMALLEST if it is shorter.
LONGEST, LONGEST_UNSTABLE, SMALLEST = 0.02, 0.06, 0.05
# Largest distance of a first guess along the tangent, in `Problem.at_value`.
FARTHEST_GUESS = 0.08
# ASIDE: corrections that add up to more than ASIDE times the step may have led to another branch.
# FAILING: Newton's method is stopped if the first correction exceeds FAILING times this limit.
ASIDE, FAILING = 0.2, 2.0


class Point(NamedTuple):
    """A point of a branch.

    Attributes
    ----------
    value : float
        The parameter.
    orbit : Orbit
    x : numpy.ndarray, shape (m n + 1,)
        The unknowns: Z1, Z1' and, with a damper, Z2, Z2' at the beginning of each segment; then
        the parameter.
    tangent : numpy.ndarray, shape (m n + 1,)
        Tangent of the branch, of length 1 in the metric of the problem.
    problem : Problem
        The equations that the unknowns solve.
    bend, twist : numpy.ndarray, shape (m n + 1,), or float
        Estimates of the first and second derivative of the tangent with respect to the length of
        the branch. They improve the first guess of the next point.
    """

    value: float
    orbit: Orbit
    x: np.ndarray
    tangent: np.ndarray
    problem: "Problem"
    bend: np.ndarray | float = 0.0
    twist: np.ndarray | float = 0.0


@dataclass(frozen=True)
class Problem:
    """The equations that the orbits of a branch solve.

    They state that each segment ends where the next begins. The metric of the problem defines the
    distance of two points: its square is the mean over the segments of the squared distance of
    their states, plus the squared difference of the parameter.

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
        """Return the problem that an orbit solves.

        `family` and `symmetric` are attributes of the problem. By default `symmetric` is True if
        the orbit is symmetric.
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
        """Length of the chain, radian: the period or, for symmetric orbits, half the period."""
        return self.phases[-1] - self.phases[0]

    @cached_property
    def metric(self):
        """Weights of squared differences of unknowns in a squared distance, shape (m n + 1,)."""
        m = len(self.phases) - 1
        return np.append(np.full(m * (4 if self.damped else 2), 1 / m), 1.0)

    def length(self, vector):
        """Return the length of a vector of differences of unknowns, in the metric."""
        return float(np.sqrt(self.metric @ vector**2))

    def unknowns(self, orbit, value):
        """Return the unknowns, shape (m n + 1,), of an orbit at a value of the parameter."""
        size = 4 if self.damped else 2
        return np.append([orbit.at(phase)[:size] for phase in self.phases[:-1]], value)

    def states(self, x):
        """Return the states at the beginning of the segments, shape (m, 4)."""
        if self.damped:
            return x[:-1].reshape(-1, 4)
        return np.concatenate([x[:2], x[:2] + self.loose])[None]

    def flow(self, x):
        """Return the `segments.Chain` at the unknowns x, of one segment or of several."""
        sign = -1 if self.symmetric else 1
        return segments.chain_of(self.family(x[-1]), self.phases, self.states(x), sign)

    def orbit_of(self, chain):
        """Return the `Orbit` of a chain. It holds the chain only if there are several segments."""
        orbit = orbit_of(chain, self.periods)
        return orbit if len(chain.states) > 1 else replace(orbit, chain=None)

    def shoot(self, x):
        """Return the `Orbit` at the unknowns x, without iteration, and its defect, shape (m n,).

        The defect holds for each segment the state at its end minus the state at which the next
        segment begins. It is zero for a periodic orbit.
        """
        chain = self.flow(x)
        return self.orbit_of(chain), self._defect(chain)

    def _defect(self, chain):
        """Return the defects of a chain, shape (m n,), in the components that are unknown."""
        return chain.defects[:, : 4 if self.damped else 2].ravel()

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
            The index of a segment, and the derivative of the state at its end by the parameter,
            shape (4,), if this derivative is known.
        """
        rate = self.rate(x[-1]) if rate is None else rate
        states, n = self.states(x), 4 if self.damped else 2
        chain, sign = orbit.chain or self.flow(x), -1 if self.symmetric else 1
        slopes = np.empty((len(states), n))
        slopes_of_ends(
            orbit.p, rate, self.phases, states, chain.ends, sign, POLISH_TOLERANCE, slopes
        )
        if known is not None:
            last = known[0] == len(states) - 1
            slopes[known[0]] = known[1] * (sign if last else 1)
        return self._matrix(orbit.factors, slopes)

    def _matrix(self, factors, slopes):
        """Return the derivative of the defect by the unknowns, shape (m n, m n + 1).

        It is put together from the derivatives of the states at the ends of the segments: `factors`
        by the states at the beginnings, `slopes` by the parameter.
        """
        n = 4 if self.damped else 2
        return np.column_stack([segments.cyclic(factors[:, :n, :n]), slopes.ravel()])

    def correct(self, x, border, most=np.inf):
        """Return the point that Newton's method reaches from the unknowns x, or None if it fails.

        The corrections are orthogonal to `border`, a vector of the shape of x. The method fails if
        the first correction is longer than `most`. It also fails if the corrections do not shrink
        although the residual is not small, as happens when a contact appears or vanishes on the
        way. Where branches cross, the matrix of the linear system is singular, and its smallest
        singular value is set to zero.

        After a correction below SURE the next one would be below CLOSE, because Newton's method
        doubles the number of correct digits in each step. The derivative by the parameter, the most
        expensive part, is computed for the first guess and once close to the orbit.
        """
        x, size, moved, row = x.copy(), np.inf, 0.0, self.metric * border
        rate, m, sign = self.rate(x[-1]), len(self.phases) - 1, -1 if self.symmetric else 1
        slopes, out = np.empty((m, 4 if self.damped else 2)), np.empty((len(x), 2))
        for number in range(NEWTON):
            fresh = number == 0 or (size < REFINED and moved > UNMOVED)
            moved = 0.0 if fresh else moved
            ends, tangents, states = np.empty((m, 4)), np.empty((m, 4, 4)), self.states(x)
            try:
                p = self.family(x[-1])
                touching, residual = correction(
                    *(p, rate, self.phases, states, sign, row, fresh, POLISH_TOLERANCE),
                    *(ends, tangents, slopes, out),
                )
                factors = tangents.transpose(0, 2, 1)
                factors[-1] *= sign
                chain = segments.Chain(p, self.phases, states, sign, ends, factors, touching)
                largest = np.max(np.abs(out), axis=0)
                if not np.all(largest < np.array([residual, 1.0]) / SINGULAR**0.5):
                    out = self._least(chain, slopes, row)
            except (np.linalg.LinAlgError, ValueError):
                return None
            change = out[:, 0]
            if not border[:-1].any():
                change[-1] = 0.0  # the parameter must keep its value exactly
            last, size = size, np.max(np.abs(change))
            if not size < LARGEST or (number == 0 and self.length(change) > most):
                return None
            settled = fresh and (size < CLOSE or last / 2 < size < ROUNDING)
            if (last < SURE or settled) and chain.converged:
                return self._point(x, chain, out[:, 1])
            if size > max(SHRINKING * last, SURE) and not chain.converged:
                return None
            x, moved = x + change, moved + size
        return None

    def _least(self, chain, slopes, row):
        """Return the array `out` of `correction`, computed with very small singular values as zero.

        Its first column is the correction, its second column a vector along the branch.
        """
        matrix = np.vstack([self._matrix(chain.factors, slopes), row])
        right = np.zeros((len(row), 2))
        right[:-1, 0], right[-1, 1] = -self._defect(chain), 1.0
        return np.linalg.lstsq(matrix, right, SINGULAR)[0]

    def _point(self, x, chain, tangent):
        """Return the `Point` at converged unknowns x; `tangent` is a vector along the branch."""
        return Point(x[-1], self.orbit_of(chain), x, tangent / self.length(tangent), self)

    def step(self, point, length):
        """Return the next point of the branch, at the distance `length`; None if a step fails."""
        bent = length**2 / 2 * point.bend + length**3 / 6 * point.twist
        return self.near(point.x + length * point.tangent + bent, point.tangent, length)

    def near(self, x, border, length):
        """Return the point that Newton's method finds close to a guess x of the unknowns, or None.

        The distance of the point from the guess must be at most about ASIDE times `length`, the
        length of the step. The corrections are orthogonal to `border`.
        """
        aside = ASIDE * abs(length) + min(ROUNDING, abs(length))
        point = self.correct(x, border, FAILING * aside)
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
        """Return the point of an orbit at a value of the parameter; None if Newton's method fails.

        `direction` is the sign of the parameter's change along the tangent of the point, -1 or 1.
        """
        x = self.unknowns(orbit, value)
        return self.correct(x, direction * np.eye(len(x))[-1])
