"""Runs by the event-driven Taylor series, with series of any orders, and their counted work.

The integrator takes steps by Taylor series and ends a step where a contact begins or ends. There
are three kinds of steps: in flight, in flight until a contact begins, and in contact. The counted
work of a run is its number of floating-point operations: the sum over the kinds of the number of
steps times the operations of a step (`operations.operations`). Two parts are left out because few
steps need them: the search for a contact that the step did not expect, and repeated iterations of a
search.

Z1 is the displacement of the primary mass.
"""

import math
from functools import cache

import numpy as np
from numpy.polynomial.polynomial import polyval

from chatterjee1995.methods.operations import operations
from chatterjee1995.methods.runs import Integrator, Run, root, stopped
from impact_damper.kernel.by_address import call_at, compiled
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.instances import CONTACT_ORDER, FLIGHT_ORDER, instance
from impact_damper.kernel.memory import aligned, pointer
from impact_damper.kernel.single import (
    COLUMNS,
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
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions import traces

# Kinds of steps: in flight, in flight until a contact, and in contact.
FLIGHT, MEETING, CONTACT = range(3)
# Orders of the series in flight and in contact with which this package integrates by default.
ORDERS = FLIGHT_ORDER, CONTACT_ORDER
# A step is stored as a row: the time at its beginning, its length, the wall in contact before it
# and after it (-1, 1, or 0 for none), and from column SERIES on the coefficients of the Taylor
# series of Z1. ROWS: largest number of steps in one call of `take_steps`.
ROWS, SERIES = 4096, 4
# Number of parts of a step. In each part Z1' is assumed to vanish at most once.
PARTS = 8


@kernel
def take_steps(steps, p, y, side, t, end, tolerance, flight_order, contact_order, rows):
    """Fill `rows` with steps from t to `end`, or until no row is left.

    `steps` is the array that `steps_of` returns, and `side` the wall in contact at t. y, the state
    at t, is replaced by the state after the steps. Coefficients that do not fit into the rows are
    omitted. Return the number of steps, and the time and the wall in contact after them.
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


@cache
def steps_of(orders):
    """Return the first argument of `take_steps` for series of these orders.

    It is an array with the addresses of three compiled functions and the size of their workspace.
    The functions take a step in flight, take a step in contact, and compute the series that are the
    same in all steps (`kernel.series`).
    """
    module = instance(1, *orders)
    called = module.flight_step, module.contact_step, module.constant_series
    return np.array([*(compiled(each).address for each in called), module.SIZE])


def name_of(orders):
    """Return the label of the Taylor series with given orders, such as "taylor_20_24"."""
    return "taylor_{}_{}".format(*orders)


def all_steps(p, start, t, periods, tolerance, orders=ORDERS):
    """Return the steps of a run from a state at t, as rows (see ROWS), and the state at its end.

    The state is NaN if the steps become so short that the time does not change.
    """
    y, side = start.copy(), side_of(p, start)
    end, parts = t + periods * 2 * math.pi / p[FREQUENCY], []
    while t < end:
        rows, before = np.empty((ROWS, SERIES + max(orders) + 1)), t
        count, t, side = take_steps(steps_of(orders), p, y, side, t, end, tolerance, *orders, rows)
        parts.append(rows[:count])
        if t == before:
            y[:], t = np.nan, end
    return np.concatenate(parts), y


def taylor(p, start, t, periods, tolerance, orders=ORDERS):
    """Return the `Run` from the state `start` at the time t.

    `orders` are the orders of the series in flight and in contact.
    """
    rows, end = all_steps(p, start, t, periods, tolerance, orders)
    work = steps_work(counted(rows), orders=orders)
    if not np.isfinite(end).all():
        return stopped("failed", work)
    begin, length, before, after = rows[:, :SERIES].T
    contacts = (begin + length)[(before == 0) & (after != 0)]
    if before[0] != 0:
        contacts = np.concatenate([begin[:1], contacts])
    at, peaks = turning_points_of_series(rows)
    at = np.concatenate([begin[:1], at, begin[-1:] + length[-1:]])
    peaks = np.concatenate([[abs(start[0])], peaks, [abs(end[0])]])
    return Run("ended", work, end, contacts, at, peaks, float(peaks.max()))


def turning_points_of_series(rows):
    """Return the times at which Z1' is zero within the steps `rows`, and |Z1| at these times."""
    c = rows[:, SERIES:].T
    slopes = c[1:] * np.arange(1, len(c))[:, None]
    edges = np.linspace(0, rows[:, 1], PARTS + 1)
    speeds = np.array([polyval(t, slopes, tensor=False) for t in edges])
    part, step = np.nonzero(speeds[:-1] * speeds[1:] < 0)
    within = root(slopes[:, step], edges[part, step], edges[part + 1, step])
    times = rows[step, 0] + within
    order = np.argsort(times, kind="stable")
    return times[order], np.abs(polyval(within, c[:, step], tensor=False))[order]


def counted(rows):
    """Return the number of steps of each kind: FLIGHT, MEETING and CONTACT."""
    before, after = rows[:, 2] != 0, rows[:, 3] != 0
    kinds = np.where(before, CONTACT, np.where(after, MEETING, FLIGHT))
    return tuple(int(np.count_nonzero(kinds == kind)) for kind in (FLIGHT, MEETING, CONTACT))


def steps_work(counts, tangents=0, orders=ORDERS):
    """Return the number of operations of steps, given the number of steps of each kind.

    `tangents` and `orders` are the arguments of `step_work`.
    """
    return sum(count * step_work(kind, tangents, orders) for kind, count in enumerate(counts))


@cache
def step_work(kind, tangents=0, orders=ORDERS):
    """Return the number of operations of one step of a kind.

    The step also integrates `tangents` solutions of the variational equations.
    """
    module = instance(1, *orders)
    unexpected = module.search_contact, module.guess_contact, module.meet_expected
    if kind == CONTACT:
        state, each = operations(module.contact_step, 0), module.contact_tangents
    else:
        without = unexpected if kind == FLIGHT else unexpected[:1]
        state, each = operations(module.flight_step, 0, without), module.flight_tangents
    return state + tangents * operations(each) // COLUMNS


class Taylor(Integrator):
    """The event-driven Taylor series of this package."""

    def run(self, p, start, begin, periods, tolerance, locate=True, most_evaluations=None):
        return taylor(p, start, begin, periods, tolerance)

    def strobes(self, p, start, begin, periods, resolution, locate=True):
        times = begin + 2 * math.pi / p[FREQUENCY] * np.arange(1, periods + 1)
        states = np.empty((periods, 4))
        traces.trace(p, start.copy(), begin, times, resolution, states, np.empty((0, 5)))
        return states
