"""The interface of integrators, and the search for contacts and turning points within steps."""

from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from chatterjee1995.methods.equations import rate, wall_at
from impact_damper.model.packed import CLEARANCE

HALVINGS = 54  # number of bisections that locate a root to the accuracy of floating-point numbers


class Run(NamedTuple):
    """A computed motion. Its `state` is the last state, its `displacement` the largest |Z1|.

    `status` is "ended", "failed", or "capped" after too many evaluations. Contacts begin at the
    times `contact_times`. `peaks` are the values of |Z1| at turning points of Z1, at the times
    `peak_times`. With rigid walls `peaks` are the largest |Z1| in each cycle.
    """

    status: str
    operations: float
    state: np.ndarray
    contact_times: np.ndarray
    peak_times: np.ndarray
    peaks: np.ndarray
    displacement: float


def stopped(status, work):
    """Return a `Run` without results (NaN or empty), for a motion that did not reach its end."""
    none = np.empty(0)
    return Run(status, work, np.full(4, np.nan), none, none, none, np.nan)


class Integrator:
    """The interface of an integrator. An argument has the same meaning in all functions.

    `p` are packed parameters, `start` is the state at the time `begin`, and `periods` the number of
    forcing cycles. If `locate` is true, steps end where contacts begin and end. `resolution` is the
    number of steps in a cycle if all steps are equal (`fixed`), and otherwise a tolerance.

    Figures show integrators in the order of `place`. `compared` names the stages that use the
    integrator. REQUIRED lists functions for each stage: the integrator defines at least one of
    them. `located` holds the values of `locate` that the stage `accuracy` compares. This stage runs
    `slow` integrators for fewer cycles of a chaotic motion than the others. `tolerances` is one of
    `labels.TOLERANCE_KEYS`. An undamped linear oscillation stays bounded if the product of step and
    natural frequency is at most `stability_limit`.
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
        """Return the label of a run: "NAME_located" if steps end at contacts, else "NAME_kink"."""
        return f"{self.name}_{'located' if locate else 'kink'}"

    def steps(self, p, start, begin, periods, tolerance, locate, most_evaluations):
        """Return a status, the number of operations, and the times and states between steps."""
        raise NotImplementedError

    def run(self, p, *given) -> Run:
        """Call `steps` with these arguments, and return its results as a `Run`."""
        status, work, times, ends = self.steps(p, *given)
        if status != "ended" or not np.isfinite(ends).all():
            return stopped("failed" if status == "ended" else status, work)
        return read_off(p, work, times, ends)

    def flight(self, p, state, end, resolution, time):
        """Return |Z2| after each step and at `time` in a run without walls, or None if it fails."""
        raise NotImplementedError

    def touches(self, p, state, levels, resolution):
        """Return for each clearance in `levels` whether the integrator finds a contact.

        By default return None. A contact is then found if |Z2| from `flight` exceeds the clearance.
        """

    def largest_displacements(self, p, start, begin, periods, steps) -> np.ndarray:
        """Return the largest |Z1| of each cycle, or NaN after the motion has diverged."""
        raise NotImplementedError


def read_off(p, work, times, ends):
    """Return a `Run` whose steps end at `times` in the states `ends`, after `work` operations."""
    at, peaks = _turning_points(p, times, ends)
    began = _beginnings(p, times, ends)
    return Run("ended", work, ends[-1], began, at, peaks, float(np.max(peaks)))


def _beginnings(p, times, ends):
    place, distance = ends[:, 2], p[CLEARANCE] - np.abs(ends[:, 2])
    inside = (distance > 0) | ((distance == 0) & (place * ends[:, 3] < 0))
    steps = np.flatnonzero(inside[:-1] & ~inside[1:])
    penetration = _quintics(p, times, ends, 2, steps) * np.sign(place[steps + 1])
    penetration[0] -= p[CLEARANCE]
    began = times[steps] + np.diff(times)[steps] * root(penetration, 0.0, 1.0)
    return np.where(distance[steps + 1] == 0, times[steps + 1], began)


def _turning_points(p, times, ends):
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
    """Return one root from `low` to `high` for each polynomial, a column of `coefficients`."""
    sign = np.sign(polyval(low, coefficients, tensor=False))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = polyval(middle, coefficients, tensor=False) * sign > 0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return low
