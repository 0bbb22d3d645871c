"""Runs by the event-driven Taylor series, with series of any orders, and their counted work.

The work is that of the steps in flight, of those that end in a contact, and of those in contact,
times the operations of one (`work.operations`), the generated series included. The search for a
contact that is met where it is not expected, and the loops of searches, do not count: hardly any
step enters them.
"""

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval

from impact_damper.kernel.by_address import by_address, call_at
from impact_damper.kernel.compiling import aligned, kernel, pointer
from impact_damper.kernel.instances import CONTACT_ORDER, FLIGHT_ORDER, instance, steps
from impact_damper.kernel.single import (
    COLUMNS,
    LENGTH,
    LONGEST,
    SIDE,
    STATE,
    TIME,
    X,
    assign,
    place,
    side_of,
)
from impact_damper.rivals.operations import operations
from impact_damper.system.packed import FREQUENCY

# Kinds of steps: in flight, in flight until a contact, and in contact.
FLIGHT, MEETING, CONTACT = range(3)
ORDERS = FLIGHT_ORDER, CONTACT_ORDER
# Rows that are kept at once, and what stands in them: time at the beginning, length, wall in
# contact before and after, and from SERIES on the coefficients of Z1.
ROWS, SERIES = 4096, 4
# Parts of a step, in each of which Z1' vanishes once at most, and halvings to find where.
PARTS, HALVINGS = 8, 54


class Run(NamedTuple):
    """A motion by some method.

    Attributes
    ----------
    status : str
        "ended", "failed" or "capped".
    operations : float
        Counted work.
    state : numpy.ndarray, shape (4,)
        At the end.
    contact_times : numpy.ndarray
        When contacts begin.
    peak_times, peaks : numpy.ndarray
        When |Z1| is largest, and the values there; those at the ends of the run count.
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
    """A run that did not come to its end."""
    none = np.empty(0)
    return Run(status, work, np.full(4, np.nan), none, none, none, np.nan)


@kernel
def take_steps(made, p, y, side, t, end, tolerance, flight_order, contact_order, rows):
    """Steps from t to end, or as many as there are rows. Returns how many, the time and the wall.

    `made` are the addresses of a step in flight, of one in contact and of what fills the kept
    series, and the size of a workspace; y is replaced. Rows may lack the coefficients.
    """
    work = aligned(made[3])
    a, count = pointer(work), 0
    place(p, y, side, tolerance, a)
    call_at(made[2], a)
    while t < end and count < len(rows):
        before = a[SIDE]
        a[TIME] = t
        a[LONGEST] = end - t
        call_at(made[0] if before == 0.0 else made[1], a)
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
    """What `take_steps` takes of the steps with series of these orders."""
    module = instance(1, *orders)
    flight, contact, _, _ = steps(module)
    called = flight, contact, by_address(module.kept_series)
    return np.array([*(each.compile() for each in called), module.SIZE])


def name_of(orders):
    """Name of the method with series of further orders in flight and in contact."""
    return "taylor_{}_{}".format(*orders)


def all_steps(p, start, t, periods, tolerance, orders=ORDERS):
    """Steps over forcing periods from a state at t, as rows (`ROWS`), and the state at the end.

    The state is NaN where steps become too short to get on.
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
    """The run from a state at t, with series of these orders in flight and in contact."""
    rows, end = all_steps(p, start, t, periods, tolerance, orders)
    work = steps_work(counted(rows), orders=orders)
    if not np.isfinite(end).all():
        return stopped("failed", work)
    begin, length, before, after = rows[:, :SERIES].T
    contacts = (begin + length)[(before == 0) & (after != 0)]
    if before[0] != 0:
        contacts = np.concatenate([begin[:1], contacts])
    at, peaks = turning_points(rows)
    at = np.concatenate([begin[:1], at, begin[-1:] + length[-1:]])
    peaks = np.concatenate([[abs(start[0])], peaks, [abs(end[0])]])
    return Run("ended", work, end, contacts, at, peaks, float(peaks.max()))


def turning_points(rows):
    """When Z1' vanishes within steps, and |Z1| there."""
    c = rows[:, SERIES:].T
    slopes = c[1:] * np.arange(1, len(c))[:, None]
    edges = np.linspace(0, rows[:, 1], PARTS + 1)
    speeds = np.array([polyval(t, slopes, tensor=False) for t in edges])
    part, step = np.nonzero(speeds[:-1] * speeds[1:] < 0)
    within = root(slopes[:, step], edges[part, step], edges[part + 1, step])
    times = rows[step, 0] + within
    order = np.argsort(times, kind="stable")
    return times[order], np.abs(polyval(within, c[:, step], tensor=False))[order]


def root(coefficients, low, high):
    """A root between low and high of each polynomial (columns), whose signs there differ."""
    sign = np.sign(polyval(low, coefficients, tensor=False))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = polyval(middle, coefficients, tensor=False) * sign > 0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return low


def counted(rows):
    """Numbers of steps of each kind."""
    before, after = rows[:, 2] != 0, rows[:, 3] != 0
    kinds = np.where(before, CONTACT, np.where(after, MEETING, FLIGHT))
    return tuple(int(np.count_nonzero(kinds == kind)) for kind in (FLIGHT, MEETING, CONTACT))


def steps_work(counts, tangents=0, orders=ORDERS):
    """Operations of so many steps of each kind."""
    return sum(count * step_work(kind, tangents, orders) for kind, count in enumerate(counts))


@cache
def step_work(kind, tangents=0, orders=ORDERS):
    """Operations of one step of the Taylor series with so many tangents."""
    made = instance(1, *orders)
    unexpected = made.search_contact, made.guess_contact, made.meet_expected
    if kind == CONTACT:
        state, each = operations(made.contact_step, 0), made.contact_tangents
    else:
        without = unexpected if kind == FLIGHT else unexpected[:1]
        state, each = operations(made.flight_step, 0, without), made.flight_tangents
    return state + tangents * operations(each) // COLUMNS
