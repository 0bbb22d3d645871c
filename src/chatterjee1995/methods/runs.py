"""The interface of integrators, and the contacts and peaks of a run from the ends of its steps.

Z1 is the displacement of the primary mass and Z2 its displacement relative to the loose mass. A
strobe is the time in each cycle at which the forcing has the phase W T = pi/2.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from chatterjee1995.methods.equations import rate, wall_at
from impact_damper.model.bounds import METHOD_TOLERANCE_RANGE, STEPS_RANGE, check_count
from impact_damper.model.checks import check_increasing, check_numbers
from impact_damper.model.packed import CLEARANCE

# Number of bisections that locate a root, enough for the accuracy of floating-point numbers.
HALVINGS = 54


class Run(NamedTuple):
    """A motion computed by an integrator.

    Attributes
    ----------
    status : str
        "ended", "failed", or "capped" if the run took too many evaluations of the time derivative
        of the state.
    operations : float
        Counted work, in floating-point operations.
    state : numpy.ndarray, shape (4,)
        State at the end of the run.
    contact_times : numpy.ndarray
        Times at which contacts begin.
    peak_times, peaks : numpy.ndarray
        Times of the local maxima of |Z1|, and the maxima. Both ends of the run are included.
    displacement : float
        Largest |Z1|.
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
    """The interface of an integrator for the stages (steps) of the workflow.

    A subclass implements the methods for those stages that compare it (`methods.COMPARED`). The
    docstring of each method names its stage. The methods have these arguments in common: `p`,
    packed parameters; `start`, the state (4,) at the time `begin`; `periods`, the number of forcing
    cycles; `locate`, whether a step ends where a contact begins or ends.

    Attributes
    ----------
    stability_limit : float
        Largest product h omega for which the computed motion of an undamped oscillator of frequency
        omega does not grow with fixed steps h; 0 if it grows with every step.
    """

    stability_limit = 0.0

    def run(self, p, start, begin, periods, tolerance, locate, most_evaluations) -> Run:
        """Return the run, for the stage `accuracy`.

        Slow integrators (`methods.Method.slow`) stop after `most_evaluations` evaluations of the
        time derivative of the state.
        """
        raise NotImplementedError

    def strobes(self, p, start, begin, periods, resolution, locate) -> np.ndarray:
        """Return the state after each forcing cycle, shape (periods, 4), for `method_verdicts`.

        The states after a failure are NaN. `resolution` is a tolerance, or a number of steps in a
        forcing cycle. The method `end` calls this method for the benchmarks.
        """
        raise NotImplementedError

    def flight(self, p, state, end, resolution, time):
        """Return |Z2| at the ends of the steps of a flight over [0, end], and |Z2| at `time`.

        For the stage `missed_contacts`. `state` is the state at the time 0, and `resolution` is
        that of `strobes`. Return None if the run fails.
        """
        raise NotImplementedError

    def largest_displacements(self, p, start, begin, periods, steps) -> np.ndarray:
        """Return the largest |Z1| in each forcing cycle, shape (periods,), with fixed steps.

        If the run diverges, the entries from this cycle on are NaN. For the stage `stable_steps`.
        """
        raise NotImplementedError

    def end(self, p, start, begin, periods, tolerance, locate) -> np.ndarray:
        """Return the state (4,) at the end, NaN if the run fails, for the benchmarks."""
        return self.strobes(p, start, begin, periods, tolerance, locate)[-1]


def check_resolutions(tolerances, steps):
    """Check tolerances, and the numbers of steps with which methods of fixed steps replace them.

    Parameters
    ----------
    tolerances : sequence of float
        Increasing.
    steps : sequence of int
        Increasing numbers of steps, one for each tolerance.

    Returns
    -------
    numpy.ndarray, list of int
        The tolerances, and the numbers of steps in a forcing cycle in decreasing order, because
        the smallest number of steps corresponds to the largest tolerance.

    Raises
    ------
    TypeError, ValueError
        If an argument has the wrong type or is out of range.
    """
    tolerances = check_numbers("tolerances", tolerances, **METHOD_TOLERANCE_RANGE)
    check_increasing("tolerances", tolerances)
    steps = [check_count("steps", value, **STEPS_RANGE) for value in steps]
    check_increasing("steps", steps)
    if len(steps) != len(tolerances):
        raise ValueError(f"steps: must be as many as tolerances, {len(tolerances)}; {steps} given")
    return tolerances, steps[::-1]


def read_off(p, work, times, ends):
    """Return the `Run` with given times (n,) and states `ends` (n, 4) at the ends of its steps.

    `work` is its number of operations. Beginnings of contacts and maxima of |Z1| within a step are
    located on the polynomial of degree 5 that agrees with the states and their time derivatives at
    both ends of the step.
    """
    if not np.isfinite(ends).all():
        return stopped("failed", work)
    at, peaks = turning_points(p, times, ends)
    began = beginnings(p, times, ends)
    return Run("ended", work, ends[-1], began, at, peaks, float(np.max(peaks)))


def beginnings(p, times, ends):
    """Return the times at which contacts begin. The arguments are those of `read_off`.

    A contact begins in each step from a state between the walls to a state at or beyond a wall.
    """
    place, distance = ends[:, 2], p[CLEARANCE] - np.abs(ends[:, 2])
    inside = (distance > 0) | ((distance == 0) & (place * ends[:, 3] < 0))
    steps = np.flatnonzero(inside[:-1] & ~inside[1:])
    penetration = quintics(p, times, ends, 2, steps) * np.sign(place[steps + 1])
    penetration[0] -= p[CLEARANCE]
    began = times[steps] + np.diff(times)[steps] * root(penetration, 0.0, 1.0)
    return np.where(distance[steps + 1] == 0, times[steps + 1], began)


def turning_points(p, times, ends):
    """Return the times at which Z1' is zero, and |Z1| at these times.

    The beginning and the end of the run are included. The arguments are those of `read_off`.
    """
    steps = np.flatnonzero(ends[:-1, 1] * ends[1:, 1] < 0)
    course = quintics(p, times, ends, 0, steps)
    fraction = root(polyder(course), 0.0, 1.0)
    at = times[steps] + np.diff(times)[steps] * fraction
    peaks = np.abs(polyval(fraction, course, tensor=False))
    return (
        np.concatenate([times[:1], at, times[-1:]]),
        np.concatenate([np.abs(ends[:1, 0]), peaks, np.abs(ends[-1:, 0])]),
    )


def quintics(p, times, ends, index, steps):
    """Return coefficients (6, m) of polynomials for component `index` of the state in m steps.

    The variable of each polynomial goes from 0 to 1 over the step. This is Hermite interpolation:
    value, first and second derivative agree with the state and its time derivative at both ends of
    the step.
    """
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
    """Return a root of each polynomial between low and high, by bisection.

    The columns of `coefficients` are the polynomials. The signs of a polynomial at low and high
    must differ.
    """
    sign = np.sign(polyval(low, coefficients, tensor=False))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = polyval(middle, coefficients, tensor=False) * sign > 0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return low
