"""Runs of integrators from one state: what they come to, what is read off, and the work.

The work of a run is in floating-point operations (`work.operations`):

- Taylor series: steps in flight and in contact times the operations of one, the generated series
  included. The search for an event evaluates a polynomial FLIGHT_ROUNDS and CONTACT_ROUNDS times
  a step, means over the scenes.
- Runge-Kutta-Merson: steps tried, those of locating contacts included, times the operations of
  one: five evaluations of the rate, the combinations of them, and the estimate of the error.
- SciPy's methods: evaluations of the rate times its operations and those of combining it with the
  others (`COMBINING`); Jacobians by differences are evaluations too; for each factorisation
  2/3 n^3 operations, n = 4, with a complex one beside it for Radau.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from impact_damper.kernel import side_of, step, workspace
from impact_damper.recording import measured, trace
from impact_damper.rivals import scipy_methods
from impact_damper.rivals.equations import rate, wall_at
from impact_damper.rivals.merson import advance_merson, estimated_step
from impact_damper.work import operations

FLIGHT_ROUNDS, CONTACT_ROUNDS = 2, 5
MOST_CONTACTS = 10_000
MOST_ENDS = 400_000
HALVINGS = 54
SIZE = 4
# Operations, beside those of the rate, for each evaluation. A stage of DOP853 adds on average 6
# products to each of the 4 components, and a twelfth of its 12 new values and 2 estimates 4 more.
# LSODA updates and predicts an array of about 6 derivatives, 21 additions a component, and a
# solution by the factors, 2 n^2. An iteration of Radau has 3 evaluations, 9 products a
# component to transform them and back each, and solutions of a real and a complex system.
COMBINING = {
    "DOP853": SIZE * 2 * (6 + 4),
    "LSODA": SIZE * 2 * 21 + 2 * SIZE**2,
    "Radau": SIZE * 2 * 6 + (2 + 8) * SIZE**2 // 3,
}
FACTORISING = {"DOP853": 0, "LSODA": 2 * SIZE**3 // 3, "Radau": (2 + 8) * SIZE**3 // 3 // 2}


class Run(NamedTuple):
    """A motion by some method.

    Attributes
    ----------
    status : str
        "ended", "failed" or "capped".
    operations : int
        Counted work.
    state : numpy.ndarray, shape (4,)
        At the end.
    contact_times : numpy.ndarray
        When contacts begin.
    displacement : float
        Largest |Z1|.
    times, ends : numpy.ndarray, shapes (n,) and (n, 4)
        Where steps end, or samples; the start first.
    """

    status: str
    operations: int
    state: np.ndarray
    contact_times: np.ndarray
    displacement: float
    times: np.ndarray
    ends: np.ndarray


def stopped(status, work):
    """A run that did not come to its end."""
    nothing = np.full(4, np.nan), np.empty(0), np.nan, np.empty(0), np.empty((0, 4))
    return Run(status, work, *nothing)


def taylor(p, start, t, periods, tolerance, samples=64):
    """By the event-driven Taylor series; `times` are samples, so many a period."""
    period = 2 * math.pi / p[0]
    times = t + period / samples * np.arange(periods * samples + 1)
    times[-1] = t + periods * period
    states, log = np.empty((len(times), 4)), np.empty((MOST_CONTACTS, 5))
    y = start.copy()
    count = trace(p, y, t, times, tolerance, states, log)
    largest = measured(p, start, periods, tolerance)["maximum_displacement"]
    flights, contacts = taylor_steps(p, start, t, periods, tolerance)
    work = flights * step_work(0) + contacts * step_work(1)
    status = "ended" if np.isfinite(states).all() else "failed"
    return Run(status, work, y, log[:count, 1].copy(), float(largest), times, states)


def taylor_steps(p, start, t, periods, tolerance):
    """Steps of the Taylor series in flight and in contact."""
    y, none, work = start.copy(), np.empty((0, 4)), workspace()
    side, counts = side_of(p, y), [0, 0]
    period = 2 * math.pi / p[0]
    for _ in range(periods):
        now, end = t, t + period
        while now < end:
            counts[side != 0] += 1
            length, side = step(p, y, none, side, now, end - now, tolerance, work)
            now = end if length >= end - now else now + length
    return tuple(counts)


def step_work(side, tangents=0):
    """Operations of one step of the Taylor series with so many tangents."""
    rounds = CONTACT_ROUNDS if side != 0 else FLIGHT_ROUNDS
    return operations(step, rounds, side=side, tangents=np.empty((tangents, 4)))


def runge_kutta_merson(p, start, t, periods, tolerance, locate):
    """By the paper's method, through the kink or with contacts located."""
    y, period = start.copy(), 2 * math.pi / p[0]
    side, h, tries = side_of(p, y), 1e-3 * period, 0
    times, ends = [np.array([t])], [start[None]]
    rows = np.empty((MOST_ENDS, 5))
    each = operations(estimated_step)
    for k in range(periods):
        side, h, steps, _, _, more = advance_merson(
            p, y, side, t, t + period, h, tolerance, locate, rows
        )
        tries += more
        if not 0 <= steps <= MOST_ENDS:
            return stopped("failed", tries * each)
        times.append(rows[:steps, 0] + k * period)
        ends.append(rows[:steps, 1:].copy())
    return read_off(p, tries * each, np.concatenate(times), np.concatenate(ends))


def scipy_run(method, p, start, t, periods, tolerance, locate, most_evaluations):
    """By one of SciPy's methods, through the kink or with contacts as events."""
    counted = scipy_methods.Counted(most_evaluations)
    times, ends, status = [np.array([t])], [start[None]], "failed"
    end = t + periods * 2 * math.pi / p[0]
    try:
        for run in scipy_methods.pieces(method, p, start, t, end, tolerance, locate, counted):
            status = "failed" if run.status < 0 else "ended"
            later, states = run.t[1:].copy(), run.y.T[1:].copy()
            if run.status == 1:
                states[-1, 2] = math.copysign(p[3], states[-1, 2])
            times.append(later)
            ends.append(states)
    except scipy_methods.TooManyEvaluations:
        status = "capped"
    each = operations(rate) + COMBINING[method]
    work = counted.evaluations * each + counted.factorisations * FACTORISING[method]
    if status != "ended":
        return stopped(status, work)
    return read_off(p, work, np.concatenate(times), np.concatenate(ends))


def read_off(p, work, times, ends):
    """A run by what its step ends show: contacts begun, and the largest |Z1| between them.

    A contact begins between a state within the walls and one at or beyond a wall. In between, a
    polynomial of degree 5 is laid through the states and their rates at both ends.
    """
    if not np.isfinite(ends).all():
        return stopped("failed", work)
    x, z = quintics(p, times, ends, 0), quintics(p, times, ends, 2)
    place, w = ends[:, 2], ends[:, 3]
    gap = p[3] - np.abs(place)
    inside = (gap > 0) | ((gap == 0) & (place * w < 0))
    enters = np.flatnonzero(inside[:-1] & ~inside[1:])
    z = z[:, enters] * np.sign(place[enters + 1])
    z[0] -= p[3]
    lengths = np.diff(times)
    began = times[enters] + lengths[enters] * root(z)
    began = np.where(gap[enters + 1] == 0, times[enters + 1], began)
    turning = np.flatnonzero(ends[:-1, 1] * ends[1:, 1] < 0)
    top = polyval(root(polyder(x[:, turning])), x[:, turning], tensor=False)
    largest = max(np.max(np.abs(ends[:, 0])), np.max(np.abs(top), initial=0.0))
    return Run("ended", work, ends[-1], began, float(largest), times, ends)


def quintics(p, times, ends, index):
    """Coefficients (6, n - 1) of a component of the state over each step, from 0 to 1 in it."""
    rates = np.array(
        [rate(p, wall_at(p, y[2]), t, tuple(y)) for t, y in zip(times, ends, strict=True)]
    )
    h = np.diff(times)
    value, slope, bend = ends[:, index], rates[:, index], rates[:, index + 1]
    first = [value[:-1], h * slope[:-1], 0.5 * h**2 * bend[:-1]]
    left = value[1:] - sum(first)
    speed = h * slope[1:] - first[1] - 2 * first[2]
    change = h**2 * bend[1:] - 2 * first[2]
    rest = [
        10 * left - 4 * speed + change / 2,
        -15 * left + 7 * speed - change,
        6 * left - 3 * speed + change / 2,
    ]
    return np.array([*first, *rest])


def root(coefficients):
    """A root in [0, 1] of each polynomial (columns), whose signs at 0 and 1 differ."""
    low = np.zeros(coefficients.shape[1])
    high = np.ones_like(low)
    sign = np.sign(coefficients[0])
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = polyval(middle, coefficients, tensor=False) * sign > 0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return low
