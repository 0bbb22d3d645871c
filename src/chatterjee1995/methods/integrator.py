"""The interface of integrators, and the contacts and peaks of a run from the ends of its steps."""

from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from chatterjee1995.methods.equations import rate, wall_at
from impact_damper.model.packed import CLEARANCE

# Number of bisections that locate a root, enough for the accuracy of floating-point numbers.
HALVINGS = 54


class Run(NamedTuple):
    """A motion by an integrator; `status` is "ended", "failed", or "capped" after too much work.

    `operations` are floating-point operations, `contact_times` the times at which contacts begin,
    and `peaks` the local maxima of |Z1| and |Z1| at both ends of the run, at `peak_times`.
    """

    status: str
    operations: float
    state: np.ndarray
    contact_times: np.ndarray
    peak_times: np.ndarray
    peaks: np.ndarray
    displacement: float


def stopped(status, work):
    """Return a `Run` that did not reach its end, with NaN in place of its results."""
    none = np.empty(0)
    return Run(status, work, np.full(4, np.nan), none, none, none, np.nan)


class Integrator:
    """The interface of an integrator, whose methods share their arguments.

    `p` are packed parameters, `start` the state at the time `begin`, `periods` forcing cycles; with
    `locate` steps end where contacts begin and end. `resolution` is a tolerance, or for `fixed`
    steps their number in a cycle.

    Integrators are shown in the order of `place`. Each stage in `compared` needs a method in
    REQUIRED. For `accuracy`: `located`, the values of `locate` in its runs; `tolerances`, one of
    `labels.TOLERANCE_KEYS`; `slow`, whether its runs are limited. For `stable_steps`:
    `stability_limit`, the largest product of step and frequency that keeps an undamped oscillation.
    """

    REQUIRED: ClassVar = {
        "accuracy": ("steps", "run"),
        "missed_contacts": ("flight",),
        "stable_steps": ("largest_displacements",),
    }

    name = title = tolerances = ""
    place = 0
    compared = ()
    fixed = slow = False
    located = (False, True)
    stability_limit = 0.0

    def label(self, locate):
        """Return the label of its runs with contacts located or not, such as "merson_kink"."""
        return f"{self.name}_{'located' if locate else 'kink'}"

    def steps(self, p, start, begin, periods, tolerance, locate, most_evaluations):
        """Return status, operations, times (n,) and states (n, 4) of a run."""
        raise NotImplementedError

    def run(self, p, *given) -> Run:
        """Return the run, from the arguments of `steps`."""
        status, work, times, ends = self.steps(p, *given)
        if status != "ended" or not np.isfinite(ends).all():
            return stopped("failed" if status == "ended" else status, work)
        return read_off(p, work, times, ends)

    def flight(self, p, state, end, resolution, time):
        """Return |Z2| at the ends of steps over [0, end], and at `time`; None if the run fails."""
        raise NotImplementedError

    def touches(self, p, state, levels, resolution):
        """Return whether walls at `levels` are touched; None lets the ends of steps decide."""

    def largest_displacements(self, p, start, begin, periods, steps) -> np.ndarray:
        """Return the largest |Z1| in each cycle with fixed steps, NaN from a divergence on."""
        raise NotImplementedError


def read_off(p, work, times, ends):
    """Return the `Run` of steps, from Hermite polynomials of degree 5 through their ends."""
    at, peaks = _turning_points(p, times, ends)
    began = _beginnings(p, times, ends)
    return Run("ended", work, ends[-1], began, at, peaks, float(np.max(peaks)))


def _beginnings(p, times, ends):
    """Return the times in steps from between the walls to or beyond a wall at which |Z2| = d0."""
    place, distance = ends[:, 2], p[CLEARANCE] - np.abs(ends[:, 2])
    inside = (distance > 0) | ((distance == 0) & (place * ends[:, 3] < 0))
    steps = np.flatnonzero(inside[:-1] & ~inside[1:])
    penetration = _quintics(p, times, ends, 2, steps) * np.sign(place[steps + 1])
    penetration[0] -= p[CLEARANCE]
    began = times[steps] + np.diff(times)[steps] * root(penetration, 0.0, 1.0)
    return np.where(distance[steps + 1] == 0, times[steps + 1], began)


def _turning_points(p, times, ends):
    """Return the times at which Z1' is zero, with both ends of the run, and |Z1| there."""
    steps = np.flatnonzero(ends[:-1, 1] * ends[1:, 1] < 0)
    course = _quintics(p, times, ends, 0, steps)
    fraction = root(polyder(course), 0.0, 1.0)
    at = times[steps] + np.diff(times)[steps] * fraction
    peaks = np.abs(polyval(fraction, course, tensor=False))
    return (
        np.concatenate([times[:1], at, times[-1:]]),
        np.concatenate([np.abs(ends[:1, 0]), peaks, np.abs(ends[-1:, 0])]),
    )


def _quintics(p, times, ends, index, steps):
    """Return Hermite polynomials over [0, 1], coefficients (6, m), of a component in m steps."""
    rates = [
        np.array([rate(p, wall_at(p, ends[k, 2]), times[k], tuple(ends[k])) for k in at])
        for at in (steps, steps + 1)
    ]
    left, right = (each.reshape(-1, 4) for each in rates)
    h = np.diff(times)[steps]
    first = [ends[steps, index], h * left[:, index], h**2 / 2 * left[:, index + 1]]
    rest = ends[steps + 1, index] - sum(first)
    speed = h * right[:, index] - first[1] - 2 * first[2]
    bend = h**2 / 2 * right[:, index + 1] - first[2]
    last = [10 * rest - 4 * speed + bend, -15 * rest + 7 * speed - 2 * bend]
    return np.array([*first, *last, 6 * rest - 3 * speed + bend])


def root(coefficients, low, high):
    """Return a root of each polynomial, a column, between low and high, where its signs differ."""
    sign = np.sign(polyval(low, coefficients, tensor=False))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = polyval(middle, coefficients, tensor=False) * sign > 0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return low
