"""Pseudo-arclength continuation of periodic orbits in one parameter: equations and steps."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from impact_damper.model.packed import CLEARANCE
from impact_damper.motions.records import SYMMETRIC
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.orbits import segments
from impact_damper.orbits.orbit import TURN, Orbit, integrate
from impact_damper.orbits.segments import FINE_NUDGE, NUDGE, slopes_of_ends
from impact_damper.orbits.shooting import AMPLIFYING

# Newton's method fails after NEWTON corrections, or if an unknown must change by LARGEST or more.
NEWTON, LARGEST = 10, 0.5
# A correction is the largest change of an unknown in one iteration. Newton's method has converged
# if the residual is as small as a rounding error and one of these is true:
# - The correction before the last one is below SURE.
# - d(`Orbit.defects`)/d(parameter) is up to date, and the last correction is below CLOSE. ROUNDING
#   replaces CLOSE if the last correction is more than half of the correction before it.
# The method fails if a correction exceeds both SURE and SHRINKING times the correction before it.
CLOSE, ROUNDING, SURE, SHRINKING = 1e-10, 1e-4, 1e-6, 0.7
# The derivative of `Orbit.defects` by the parameter is expensive. It is updated only if Newton's
# last correction is below REFINED and corrections since the last update add up to over UNMOVED.
REFINED, UNMOVED = 1e-4, 5e-6
# A linear system is nearly singular if its solution is more than SINGULAR^-0.5 times as large as
# its right side. Then singular values below SINGULAR times the largest one count as zero.
SINGULAR = 1e-8
# Lengths of the first and of the shortest step along a branch, measured by `Problem.length`.
FIRST_STEP, SHORTEST_STEP = 0.01, 1e-9
# A step is at most LONGEST times as long as the vector of unknowns, or LONGEST_UNSTABLE times if
# orbits are neither symmetric nor stable. The length of this vector counts as at least SMALLEST.
LONGEST, LONGEST_UNSTABLE, SMALLEST = 0.02, 0.06, 0.05
# The first guess in `Problem.at_value` is at most this far from the given point.
FARTHEST_GUESS = 0.08
# A point is rejected if its distance from its first guess exceeds about ASIDE x length of the step.
# Newton's first correction may be at most FAILING times as long as this largest distance.
ASIDE, FAILING = 0.2, 2.0


class Point(NamedTuple):
    """A point of a branch: the `value` of the parameter that varies, and the orbit there.

    The m n + 1 unknowns `x` are the states at which the m segments begin, and the parameter. A
    state has n = 4 unknown components, or without a damper n = 2 (Z1, Z1'). `tangent`, `bend` and
    `twist` are the first three derivatives of `x` by the length along the branch.
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
    """The equations for the orbits of a branch: each segment ends where the next one begins.

    Two points with the parameters v and w have the squared distance (v - w)^2 + D. D is the mean
    over the segments of |s - t|^2. A segment begins with the state s in one point, t in the other.

    family: Function of `Point.value` that returns the array `p` of all parameters.
    periods: Period in forcing cycles.
    phases: Phases W T at which the segments begin, and at which the last segment ends.
    loose: The constant (Z2 - Z1, Z2' - Z1'), from which Z2 and Z2' follow if there is no damper.
    damped: Whether there is a damper.
    symmetric: Whether all orbits are symmetric. The segments then cover half the period.
    rough: The largest norm of a matrix in `Orbit.factors` just after `recut` has made several
    segments, otherwise 0. `holds_still` compares later norms with it.
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
        """Return the `Problem` of an orbit. `family` and `symmetric` are fields of `Problem`."""
        if symmetric is None:
            symmetric = bool(orbit.record["asymmetry"] < SYMMETRIC)
        cycle = orbit.periods * TURN * (0.5 if symmetric else 1.0)
        several = len(orbit.states) > 1
        return cls(
            family,
            orbit.periods,
            segments.cut(orbit, cycle) if several else orbit.phase + np.array([0.0, cycle]),
            orbit.state[2:] - orbit.state[:2],
            bool(np.isfinite(orbit.p[CLEARANCE])),
            symmetric,
        )

    @property
    def size(self):
        """Number n of unknown components of a state: 4, or 2 without a damper."""
        return 4 if self.damped else 2

    @property
    def sign(self):
        """-1 if the segments cover half the period of symmetric orbits, otherwise 1."""
        return -1 if self.symmetric else 1

    @property
    def cycle(self):
        """Increase of the phase W T in the period or, for symmetric orbits, in half the period."""
        return self.phases[-1] - self.phases[0]

    @cached_property
    def metric(self):
        """Weight of an unknown in `length`: 1 for the parameter, else 1 / (number of segments)."""
        m = len(self.phases) - 1
        return np.append(np.full(m * self.size, 1 / m), 1.0)

    def length(self, vector):
        """Return the length of `vector`, which is the difference of two vectors of unknowns."""
        return float(np.sqrt(self.metric @ vector**2))

    def unknowns(self, orbit, value):
        """Return the vector of unknowns `x` for an orbit at a value of the parameter."""
        return np.append([orbit.at(phase)[: self.size] for phase in self.phases[:-1]], value)

    def states(self, x):
        """Return the states at which the segments begin, a row for each, from the unknowns x."""
        if self.damped:
            return x[:-1].reshape(-1, 4)
        return np.concatenate([x[:2], x[:2] + self.loose])[None]

    def shoot(self, x):
        """Integrate segments from the states in x. The `Orbit` returned need not be periodic."""
        states = self.states(x)
        return integrate(self.family(x[-1]), self.periods, self.phases, states, self.sign)

    def rate(self, value):
        """Return the derivative of the array `p` by the parameter that varies, at its `value`."""
        ahead, behind = self.family(value + NUDGE), self.family(value - NUDGE)
        # Without a damper the clearance is infinite. Its rate of change is set to 0.
        change = np.subtract(ahead, behind, out=np.zeros(len(ahead)), where=ahead < np.inf)
        return change / (2 * NUDGE)

    def rows(self, x, orbit):
        """Return the derivative of `Orbit.defects` by the unknowns: a row for each component."""
        slopes = self._slopes(orbit, self.rate(x[-1]))
        factors = orbit.factors[:, : self.size, : self.size]
        return np.column_stack([segments.cyclic(factors), slopes.ravel()])

    def _slopes(self, orbit, rate):
        slopes = np.empty((len(orbit.states), self.size))
        given = orbit.p, rate, self.phases, orbit.states, orbit.ends, self.sign
        slopes_of_ends(*given, POLISH_TOLERANCE, slopes)
        return slopes

    def correct(self, x, border, most=np.inf):
        """Return the point that Newton's method reaches from the unknowns x, or None if it fails.

        Corrections are orthogonal to `border`. The first correction must not be longer than `most`.
        """
        x, size, moved, row = x.copy(), np.inf, 0.0, self.metric * border
        rate, slopes = None, None
        for number in range(NEWTON):
            fresh = number == 0 or (size < REFINED and moved > UNMOVED)
            moved = 0.0 if fresh else moved
            try:
                rate = self.rate(x[-1]) if rate is None else rate
                orbit = self.shoot(x)
                slopes = self._slopes(orbit, rate) if fresh else slopes
                out = self._solved(orbit, slopes, row)
            except (np.linalg.LinAlgError, ValueError):
                return None
            change = out[:, 0]
            if not border[:-1].any():
                change[-1] = 0.0  # the parameter must keep its value exactly
            last, size = size, np.max(np.abs(change))
            if not size < LARGEST or (number == 0 and self.length(change) > most):
                return None
            settled = fresh and (size < CLOSE or last / 2 < size < ROUNDING)
            if (last < SURE or settled) and orbit.converged:
                return Point(x[-1], orbit, x, out[:, 1] / self.length(out[:, 1]), self)
            if size > max(SHRINKING * last, SURE) and not orbit.converged:
                return None
            x, moved = x + change, moved + size
        return None

    def _solved(self, orbit, slopes, row):
        matrix, right = np.empty((len(row), len(row))), np.zeros((len(row), 2))
        matrix[:-1, :-1] = segments.cyclic(orbit.factors[:, : self.size, : self.size])
        matrix[:-1, -1], matrix[-1] = slopes.ravel(), row
        right[:-1, 0], right[-1, 1] = -orbit.defects[:, : self.size].ravel(), 1.0
        most = np.array([orbit.residual, 1.0]) / SINGULAR**0.5
        with suppress(np.linalg.LinAlgError):
            out = np.linalg.solve(matrix, right)
            if np.all(np.max(np.abs(out), axis=0) < most):
                return out
        return np.linalg.lstsq(matrix, right, SINGULAR)[0]

    def near(self, x, border, length):
        """Return the corrected guess x, or None if it moved by more than about ASIDE x `length`."""
        aside = ASIDE * abs(length) + min(ROUNDING, abs(length))
        point = self.correct(x, border, FAILING * aside)
        return None if point is None or self.length(point.x - x) > aside else point

    def at_value(self, point, value):
        """Return the point near `point` with the parameter `value`, or None if it is not found."""
        length = (value - point.x[-1]) / (point.tangent[-1] or np.inf)
        x = point.x + np.clip(length, -FARTHEST_GUESS, FARTHEST_GUESS) * point.tangent
        x[-1] = value
        near = self.correct(x, np.eye(len(x))[-1])
        if near is None:
            return None
        turned = np.sign((self.metric * near.tangent) @ point.tangent)
        return near._replace(tangent=near.tangent * turned)


def point_at_distance(origin, point, ahead, distance):
    """Return the point between `point` and `ahead` at a `distance` from `origin`.

    The distance is measured along the tangent of `origin`. If Newton's method fails, return None.
    """
    row = origin.problem.metric * origin.tangent
    first, last = (row @ (end.x - origin.x) for end in (point, ahead))
    x = _cubic(point, ahead, (distance - first) / (last - first))
    x += (distance - row @ (x - origin.x)) / (last - first) * (ahead.x - point.x)
    return origin.problem.near(x, origin.tangent, distance)


def point_at_value(point, ahead, value):
    """Return the point at parameter `value` between `point` and `ahead`, or None if not found."""
    problem, chord = point.problem, ahead.x - point.x

    def beyond(fraction):
        return _cubic(point, ahead, fraction)[-1] - value

    # By a rounding error, `value` may lie just outside the range from `point` to `ahead`.
    ends = beyond(0.0), beyond(1.0)
    inside = ends[0] * ends[1] < 0
    fraction = brentq(beyond, 0.0, 1.0) if inside else float(np.argmin(np.abs(ends)))
    x = _cubic(point, ahead, fraction)
    x[-1] = value
    near = problem.near(x, np.eye(len(x))[-1], problem.length(chord))
    if near is None:
        return None
    turned = np.sign((problem.metric * near.tangent) @ chord)
    return near._replace(tangent=near.tangent * turned)


def _cubic(point, ahead, fraction):
    """Return unknowns on a cubic curve from `point`, fraction 0, to `ahead`, fraction 1."""
    row = point.problem.metric * point.tangent
    chord = ahead.x - point.x
    length = row @ chord
    aside = chord - length * point.tangent
    slope = length * (ahead.tangent / (row @ ahead.tangent) - point.tangent)
    bent = fraction**2 * ((3 - 2 * fraction) * aside + (fraction - 1) * slope)
    return point.x + fraction * length * point.tangent + bent


# A step is rejected if it exceeds one of these bounds, because it may lead to another branch.
# TURNED: angle between the tangents at the two ends of the step, radian.
# SKEW: length of the difference of two unit vectors. One has the direction from the first to the
# last point of the step, the other the direction of the mean of the two tangents.
TURNED, SKEW = 0.5, 0.03
# The next step is made so long that the angle between the tangents at its two ends is expected to
# be AIM x TURNED or less. A step is at most GROWTH times as long as the step before. After a
# rejected step it is at least SHRINKAGE times as long as the rejected step.
AIM, GROWTH, SHRINKAGE = 0.65, 1.5, 0.3


def next_point(point, span, length):
    """Make a step of `length` from `point`. Return the new point, or None if it is rejected.

    Also return the factor by which to multiply `length` for the next step. A step that leaves the
    range `span` of the parameter is shortened to end there.
    """
    problem = point.problem
    bent = length**2 / 2 * point.bend + length**3 / 6 * point.twist
    ahead = problem.near(point.x + length * point.tangent + bent, point.tangent, length)
    if ahead is not None and np.clip(ahead.value, *span) != ahead.value:
        ahead = point_at_value(point, ahead, float(np.clip(ahead.value, *span)))
    if ahead is None:
        return None, 0.5
    chord = ahead.x - point.x
    mean = (point.tangent + ahead.tangent) / 2
    straight = problem.length(mean)
    turned = 2 * np.arccos(min(straight, 1.0)) / TURNED
    chord /= problem.length(chord) or 1.0
    skew = problem.length(chord - mean / straight) / SKEW
    ease = AIM / max(turned, skew**0.5, AIM / GROWTH)
    if max(turned, skew) > 1:
        return None, max(min(ease, AIM), SHRINKAGE)
    return ahead, ease


def with_bend(point, ahead):
    """Return `ahead` with estimates of its derivatives `bend` and `twist` (see `Point`)."""
    length = ahead.problem.length(ahead.x - point.x)
    chord = (ahead.x - point.x) / length
    bend = (2 * point.tangent + 4 * ahead.tangent - 6 * chord) / length
    twist = 6 * (point.tangent + ahead.tangent - 2 * chord) / length**2
    return ahead._replace(bend=bend, twist=twist)


def folds_twice(point, ahead):
    """Return whether a cubic curve through both points, tangent to the branch, has two folds."""
    length = point.problem.length(ahead.x - point.x)
    first, last = length * point.tangent[-1], length * ahead.tangent[-1]
    chord = ahead.value - point.value
    # With u from 0 to 1 on the step, d(parameter)/du is first + middle u + bend u^2.
    bend, middle = 3 * (first + last) - 6 * chord, 6 * chord - 4 * first - 2 * last
    if first * last <= 0 or not 0 < -middle * bend < 2 * bend**2:
        return False
    return first * (first - middle**2 / (4 * bend)) < 0


# An orbit with several segments is divided anew if one of these is true:
# - A segment begins closer than NEAR_SECTION (radian) to a contact.
# - The largest norm in `Orbit.factors` has grown by the factor ROUGHER since the last division.
# - One segment is enough, because `Orbit.amplification` is below MILD x `shooting.AMPLIFYING`.
NEAR_SECTION, ROUGHER, MILD = 0.02, 4.0, 0.5


def holds_still(point):
    """Return False if the orbit of `point` must be divided into new segments, otherwise True."""
    problem, orbit = point.problem, point.orbit
    if not problem.damped:
        return True
    if len(problem.phases) == 2 and problem.rough == 0:
        return orbit.amplification <= AMPLIFYING and orbit.flight_phase() == orbit.phase
    mild = orbit.amplification < MILD * AMPLIFYING
    still = np.max(_norms(orbit)) < ROUGHER * problem.rough
    return bool(not mild and still and np.min(orbit.margin(problem.phases[:-1])) > NEAR_SECTION)


def recut(point, between=()):
    """Return `point` with its orbit in new segments, or unchanged if Newton's method fails.

    A flight that contains one of the phases in `between` is cut before and after this phase.
    """
    before, orbit = point.problem, point.orbit
    phases, rough = segments.cut(orbit, before.cycle, between), 1.0
    if not between and orbit.amplification <= AMPLIFYING:
        phases, rough = orbit.flight_phase() + np.array([0.0, before.cycle]), 0.0
    problem = replace(before, phases=phases - phases[0] + phases[0] % TURN, rough=rough)
    x = np.append([orbit.at(phase) for phase in phases[:-1]], point.x[-1])
    nudged = point.x + FINE_NUDGE * point.tangent
    displaced = replace(orbit, p=before.family(nudged[-1]), states=before.states(nudged))
    ahead = np.append([displaced.at(phase) for phase in phases[:-1]], nudged[-1])
    border = (ahead - x) / problem.length(ahead - x)
    moved = problem.correct(x, border)
    if moved is None:
        return point
    problem = replace(problem, rough=np.max(_norms(moved.orbit)) if rough else 0.0)
    return moved._replace(problem=problem)


def _norms(orbit):
    return np.sqrt(np.sum(orbit.factors**2, axis=(1, 2)))
