"""Runs of integrators from one state: what they come to, what is read off, and the work.

The work of a run is in floating-point operations (`work.operations`):

- Taylor series: see `series_runs`.
- Runge-Kutta-Merson: steps tried, those of locating contacts included, times the operations of
  one: five evaluations of the rate, the combinations of them, and the estimate of the error.
- SciPy's methods: evaluations of the rate times its operations and those of combining it with the
  others (`COMBINING`); Jacobians by differences are evaluations too; for each factorisation
  2/3 n^3 operations, n = 4, with a complex one beside it for Radau.
"""

import math

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from impact_damper.contact.rigid_impacts import MOST_IMPACTS, rebound, rigid_map
from impact_damper.kernel.single import side_of, step, workspace
from impact_damper.rivals import scipy_methods
from impact_damper.rivals.equations import rate, wall_at
from impact_damper.rivals.merson import advance_merson, estimated_step
from impact_damper.rivals.operations import operations
from impact_damper.rivals.taylor_runs import FLIGHT, MEETING, Run, root, steps_work, stopped
from impact_damper.system.packed import CLEARANCE, DASHPOT, FREQUENCY

MOST_ENDS = 400_000
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


def rigid(p, restitution, start, t, periods, tolerance):
    """By the rigid-impact model, in the steps of the Taylor series in flight, from the strobe on.

    A peak is the largest |Z1| of a period, its time the middle of it.
    """
    p = p.copy()
    p[DASHPOT] = 0.0
    y, none, work = start.copy(), np.empty((0, 4)), workspace()
    period, counts = 2 * math.pi / p[FREQUENCY], [0, 0, 0]
    began, peaks = [], []
    for k in range(periods):
        _, _, impacts, _, _, largest = rigid_map(p, restitution, y, tolerance)
        peaks.append(largest)
        if impacts == MOST_IMPACTS:
            return stopped("failed", steps_work(counts))
        now, end = t, t + period
        while now < end:
            length, side = step(p, y, none, 0, now, end - now, tolerance, work)
            now = end if length >= end - now else now + length
            counts[FLIGHT if side == 0 else MEETING] += 1
            if side != 0:
                began.append(now + k * period)
                rebound(p, restitution, y, none, now)
    middles = t + period * (np.arange(periods) + 0.5)
    peaks = np.array(peaks)
    done = steps_work(counts), y, np.array(began), middles, peaks, float(np.max(peaks))
    return Run("ended", *done)


def runge_kutta_merson(p, start, t, periods, tolerance, locate):
    """By the paper's method, through the kink or with contacts located."""
    y, period = start.copy(), 2 * math.pi / p[FREQUENCY]
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
    end = t + periods * 2 * math.pi / p[FREQUENCY]
    try:
        for run in scipy_methods.pieces(method, p, start, t, end, tolerance, locate, counted):
            status = "failed" if run.status < 0 else "ended"
            later, states = run.t[1:].copy(), run.y.T[1:].copy()
            if run.status == 1:
                states[-1, 2] = math.copysign(p[CLEARANCE], states[-1, 2])
            times.append(later)
            ends.append(states)
    except scipy_methods.TooManyEvaluations:
        status = "capped"
    each = operations(rate) + COMBINING[method]
    work = float(counted.evaluations * each + counted.factorisations * FACTORISING[method])
    if status != "ended":
        return stopped(status, work)
    return read_off(p, work, np.concatenate(times), np.concatenate(ends))


def read_off(p, work, times, ends):
    """A run by what its step ends show: contacts begun, and peaks of |Z1|.

    Between the ends of a step a polynomial of degree 5 is laid through the states and rates there.
    """
    if not np.isfinite(ends).all():
        return stopped("failed", work)
    at, peaks = turning_points(p, times, ends)
    began = beginnings(p, times, ends)
    return Run("ended", work, ends[-1], began, at, peaks, float(np.max(peaks)))


def beginnings(p, times, ends):
    """When contacts begin: between a state within the walls and one at or beyond a wall."""
    place, gap = ends[:, 2], p[CLEARANCE] - np.abs(ends[:, 2])
    inside = (gap > 0) | ((gap == 0) & (place * ends[:, 3] < 0))
    steps = np.flatnonzero(inside[:-1] & ~inside[1:])
    penetration = quintics(p, times, ends, 2, steps) * np.sign(place[steps + 1])
    penetration[0] -= p[CLEARANCE]
    began = times[steps] + np.diff(times)[steps] * root(penetration, 0.0, 1.0)
    return np.where(gap[steps + 1] == 0, times[steps + 1], began)


def turning_points(p, times, ends):
    """When Z1' vanishes, and |Z1| there; the first and the last state are added."""
    steps = np.flatnonzero(ends[:-1, 1] * ends[1:, 1] < 0)
    course = quintics(p, times, ends, 0, steps)
    share = root(polyder(course), 0.0, 1.0)
    at = times[steps] + np.diff(times)[steps] * share
    peaks = np.abs(polyval(share, course, tensor=False))
    return (
        np.concatenate([times[:1], at, times[-1:]]),
        np.concatenate([np.abs(ends[:1, 0]), peaks, np.abs(ends[-1:, 0])]),
    )


def quintics(p, times, ends, index, steps):
    """Coefficients (6, m) of a component of the state over some steps, from 0 to 1 in each."""
    rates = [
        np.array([rate(p, wall_at(p, ends[k, 2]), times[k], tuple(ends[k])) for k in at])
        for at in (steps, steps + 1)
    ]
    left, right = (each.reshape(-1, SIZE) for each in rates)
    h = np.diff(times)[steps]
    first = [ends[steps, index], h * left[:, index], h**2 / 2 * left[:, index + 1]]
    rest = ends[steps + 1, index] - sum(first)
    speed = h * right[:, index] - first[1] - 2 * first[2]
    bend = h**2 / 2 * right[:, index + 1] - first[2]
    last = [10 * rest - 4 * speed + bend, -15 * rest + 7 * speed - 2 * bend]
    return np.array([*first, *last, 6 * rest - 3 * speed + bend])
