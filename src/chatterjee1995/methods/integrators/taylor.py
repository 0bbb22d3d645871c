"""The library's own integrator: Taylor series of any order, with steps that end at contacts."""

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from chatterjee1995.methods.integrator import Integrator, Run, root, stopped
from impact_damper.kernel.compiling import aligned, call_at, compiled, kernel, pointer
from impact_damper.kernel.instances import CONTACT_ORDER, FLIGHT_ORDER, instance
from impact_damper.kernel.single import (
    LENGTH,
    LONGEST,
    SIDE,
    STATE,
    TIME,
    X,
    assign,
    side_of,
    write_trajectory,
)
from impact_damper.model.packed import CLEARANCE, FREQUENCY
from impact_damper.motions import traces

# Kinds of steps. CONTACT: in contact. MEETING: last step of a flight. FLIGHT: any other step.
FLIGHT, MEETING, CONTACT = range(3)
ORDERS = FLIGHT_ORDER, CONTACT_ORDER
# A step is stored as a row: its beginning, its length, the wall in contact before it, and the wall
# in contact after it (-1, 1, or 0 for none). The columns from SERIES on hold the Taylor
# coefficients of Z1. ROWS is the largest number of steps in one call of `take_steps`.
ROWS, SERIES = 4096, 4
PARTS = 8  # number of parts of a step; `turning_points` finds at most one zero of Z1' in a part


@kernel
def take_steps(steps, p, y, side, t, end, tolerance, flight_order, contact_order, rows):
    """Integrate y from t to `end`, or until `rows` is full. Write each step to one of `rows`.

    `steps` is from `steps_of`. Return the number of steps, the last time and the last wall pressed.
    """
    work = aligned(steps[3])
    a, count = pointer(work), 0
    write_trajectory(p, y, side, tolerance, a)
    call_at(steps[2], a)
    while t < end and count < len(rows):
        before = a[SIDE]
        a[TIME] = t
        a[LONGEST] = end - t
        call_at(steps[0] if before == 0.0 else steps[1], a)
        length = a[LENGTH]
        row = rows[count]
        row[0], row[1], row[2], row[3] = t, length, before, a[SIDE]
        order = flight_order if before == 0.0 else contact_order
        for k in range(len(row) - SERIES):
            row[SERIES + k] = a[X + k] if k <= order else 0.0
        t = end if length >= end - t else t + length
        count += 1
    assign(y, work[STATE:])
    return count, t, np.int64(a[SIDE])


def steps_of(orders):
    """Return addresses of compiled functions, and the size of a workspace, for `take_steps`."""
    module = instance(1, *orders)
    called = module.flight_step, module.contact_step, module.constant_series
    return np.array([*(compiled(each).address for each in called), module.SIZE])


def all_steps(p, start, t, periods, tolerance, orders=ORDERS):
    """Run from `start` at the time t; return a row for each step, and the last state (or NaN)."""
    y, side = start.copy(), side_of(p, start)
    end, parts = t + periods * 2 * np.pi / p[FREQUENCY], []
    while t < end:
        rows, before = np.empty((ROWS, SERIES + max(orders) + 1)), t
        count, t, side = take_steps(steps_of(orders), p, y, side, t, end, tolerance, *orders, rows)
        parts.append(rows[:count])
        if t == before:  # the steps are so short that the time does not change
            y[:], t = np.nan, end
    return np.concatenate(parts), y


def taylor(p, start, t, periods, tolerance, orders=ORDERS):
    """Return the `Run` that begins with the state `start` at the time t."""
    rows, end = all_steps(p, start, t, periods, tolerance, orders)
    work = work_of_steps(counted(rows), orders)
    if not np.isfinite(end).all():
        return stopped("failed", work)
    begin, length, before, after = rows[:, :SERIES].T
    contacts = (begin + length)[(before == 0) & (after != 0)]
    if before[0] != 0:
        contacts = np.concatenate([begin[:1], contacts])
    step, within = turning_points(rows, rows[:, SERIES:].T)
    at = np.concatenate([begin[:1], begin[step] + within, begin[-1:] + length[-1:]])
    peaks = np.abs(polyval(within, rows[step, SERIES:].T, tensor=False))
    peaks = np.concatenate([[abs(start[0])], peaks, [abs(end[0])]])
    return Run("ended", work, end, contacts, at, peaks, float(peaks.max()))


def turning_points(rows, series):
    """Return the turning points of Z1: index of the step, and time since the step began."""
    slopes = polyder(series)
    edges = np.linspace(0, rows[:, 1], PARTS + 1)
    speeds = np.array([polyval(t, slopes, tensor=False) for t in edges])
    part, step = np.nonzero(speeds[:-1] * speeds[1:] < 0)
    within = root(slopes[:, step], edges[part, step], edges[part + 1, step])
    order = np.argsort(rows[step, 0] + within, kind="stable")
    return step[order], within[order]


def counted(rows):
    """Return the number of steps of each kind: FLIGHT, MEETING and CONTACT."""
    before, after = rows[:, 2] != 0, rows[:, 3] != 0
    kinds = np.where(before, CONTACT, np.where(after, MEETING, FLIGHT))
    return tuple(int(np.count_nonzero(kinds == kind)) for kind in (FLIGHT, MEETING, CONTACT))


def work_of_steps(counts, orders=ORDERS, tangents=False):
    """Return the operations of all steps. `counts` is the number of steps of each kind."""
    return sum(count * step_work(kind, orders, tangents) for kind, count in enumerate(counts))


def step_work(kind, orders=ORDERS, tangents=False):
    """Return the number of operations of a step of this kind, within 1 % of the true number."""
    n = orders[kind == CONTACT]
    if kind == CONTACT:
        return 1.5 * n**2 + 40 * n + 405 + tangents * (4.5 * n**2 + 73 * n)
    meeting = 11 * n + 55 if kind == MEETING else 0
    return 1.5 * n**2 + 12 * n + 300 + meeting + tangents * (4.5 * n**2 + 25 * n + 50)


class Taylor(Integrator):
    """The Taylor series of the library, whose steps end at contacts."""

    name, title, place, tolerances = "taylor", "Taylor series", 0, "taylor"
    compared = ("accuracy", "missed_contacts")
    located = (True,)

    def label(self, locate):
        return self.name

    def run(self, p, start, begin, periods, tolerance, locate=True, most_evaluations=None):
        return taylor(p, start, begin, periods, tolerance)

    def flight(self, p, state, end, resolution, time):
        states = traces.states_at(p, state, 0.0, [time, end], resolution)
        there = abs(states[0, 2])
        return (np.array([there]), there) if np.isfinite(there) else None

    def touches(self, p, state, levels, resolution):
        parameters = np.repeat(p[None], len(levels), axis=0)
        parameters[:, CLEARANCE] = levels
        end = 2.0 * np.pi / p[FREQUENCY]
        logs = [traces.trace(row, state, 0.0, [end], resolution)[1] for row in parameters]
        return np.array([len(log) > 0 for log in logs])


INTEGRATORS = (Taylor(),)
