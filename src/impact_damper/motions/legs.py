"""Legs of a run of migration control: the motions between two switchings of the damper.

A leg begins when the damper is switched, at any phase of the forcing, with Z1 and Z1' continuous.
It ends at the first strobe at which the motion is near a stable orbit, when a rule releases the
damper, or after a given time. The state is not moved onto the orbit, so that a run is one
continuous motion.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.equation import has_escaped
from impact_damper.kernel.single import assign, side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import CLEARANCE, FREQUENCY
from impact_damper.motions.records import ESCAPED, NEVER, UNRESOLVED, measure
from impact_damper.motions.strobe_map import one_period, speed_weight, strobe_time
from impact_damper.motions.traces import trace
from impact_damper.motions.watch import NEAR, NEAREST, RING, move_onto_orbit, nearby_period

# An orbit captures a run after the last strobe at which the run differs from the orbit by more than
# CAPTURE in Z1 or Z1'.
CAPTURE = 0.1
# Forcing cycles in one call of a compiled function. Ctrl-C waits for the end of a call.
STROBES_AT_ONCE = 50_000
# Rules of release, the first number of `rule` in `hold`.
SETTLED, HOLD, PHASE, STATE = range(4)


class Stopped(Exception):
    """Raised in a thread whose run another thread has ended."""


def run(p, y, ahead, strobe, tolerance, limit, path, out, stop):
    """Run a motion from any phase of the forcing until it is near a stable orbit.

    Parameters
    ----------
    y : array, shape (4,)
        State at the beginning, replaced by the last state.
    ahead : float
        Forcing cycles from the beginning to the first strobe.
    strobe : float
        Number of the first strobe of this leg, counted from the first strobe of the first leg.
    limit : int
        Number of the last strobe, counted from 0.
    path : array, shape (limit + 2, 5)
        Receives a row for the beginning and for each strobe: time in forcing cycles, then the
        state.
    out : records.MOTION
        Receives outcome, period and periods_run, and the state on the orbit if the motion settled.
    stop : array of bool, shape (1,)
        If another thread sets this flag, `Stopped` is raised.
    """
    out["outcome"], out["period"], out["maximum_displacement"] = UNRESOLVED, 0, np.nan
    path[0, 0], path[0, 1:] = strobe - ahead, y
    t = strobe_time(p)
    begin = t - ahead * 2.0 * math.pi / p[FREQUENCY]
    side, near, ring = side_of(p, y), NEAR, np.empty((RING, 4))
    side, _, _ = advance(p, y, np.empty((0, 4)), side, begin, t, tolerance, workspace())
    for first in range(0, limit + 1, STROBES_AT_ONCE):
        if stop[0]:
            raise Stopped
        last = min(first + STROBES_AT_ONCE, limit + 1)
        side, near = run_strobes(
            p, y, side, near, ring, strobe, tolerance, first, last, limit, path, out
        )
        if out["outcome"] != UNRESOLVED:
            break


@kernel
def run_strobes(p, y, side, near, ring, strobe, tolerance, first, last, limit, path, out):
    """Do the part of `run` from strobe `first` to the strobe before `last`.

    Return the wall in contact (-1, 1, or 0 for none), and the distance from an orbit below which
    Newton's method is tried next.
    """
    work = workspace()
    none = np.empty((0, 4))
    for k in range(first, last):
        path[k + 1, 0] = strobe + k
        assign(path[k + 1, 1:], y)
        assign(ring[k % RING], y)
        out.periods_run = k
        if has_escaped(p, y[0], y[1]):
            out.outcome = ESCAPED
            break
        n = nearby_period(ring, k, speed_weight(p, side), 20.0 * tolerance, near)
        if n > 0:
            orbit = y.copy()
            if move_onto_orbit(p, orbit, n, near, out):
                assign(out.state, orbit)
                break
            near = max(0.1 * near, NEAREST)
        if k < limit:
            side, _, _ = one_period(p, y, none, side, tolerance, work)
    return side, near


def leg(before, after, y, wait, place, strobe, tolerance, limit, path, out, stop=NEVER):
    """Wait, switch the damper, `run`, measure a settled motion; return the last strobe.

    Parameters
    ----------
    before, after : array, shape (packed.COUNT,)
        Packed parameters before and after the switching, one of them without the damper.
    y : array, shape (4,)
        State at the strobe, replaced by the state at the last strobe.
    wait : float
        Forcing cycles from the strobe to the switching.
    place : float
        Z2 of the loose mass over the clearance when the damper is switched on; the loose mass is
        then at rest relative to the primary mass. Not used when the damper is switched off.
    strobe : float
        Number of this strobe, at which the waiting begins.
    out : array of records.MOTION, shape (1,)
    """
    wait_and_switch(before, after, y, wait, place, tolerance)
    strobe += math.floor(wait) + 1.0
    run_and_measure(after, y, 1.0 - wait % 1.0, strobe, tolerance, limit, path, out, stop)
    return strobe + out[0]["periods_run"]


def wait_and_switch(before, after, y, wait, place, tolerance):
    """Run from a strobe for `wait` forcing cycles, and switch the damper; return the time."""
    t = strobe_time(before)
    end = t + wait * 2.0 * math.pi / before[FREQUENCY]
    advance(before, y, np.empty((0, 4)), side_of(before, y), t, end, tolerance, workspace())
    if after[CLEARANCE] == math.inf:
        y[2], y[3] = y[0], y[1]
    else:
        y[2], y[3] = place * after[CLEARANCE], 0.0
    return end


def run_and_measure(p, y, ahead, strobe, tolerance, limit, path, out, stop):
    """Do `run` and, for a settled motion, `measure`; `out` is an array of one record."""
    run(p, y, ahead, strobe, tolerance, limit, path, out[0], stop)
    if out[0]["period"] > 0:
        measure(p[None], tolerance, 0, out, NEVER)


def hold_by_state(off, on, y, wait, place, strobe, tolerance, longest, releases):
    """Wait, switch the damper on, and off as soon as the state lies in the set `releases`.

    Return rows as `run` writes them, for the switching on, each strobe, and the switching off, at
    the latest `longest` forcing cycles later. y is replaced by the free state after it.
    """
    begin = wait_and_switch(off, on, y, wait, place, tolerance)
    path = np.full((longest + 2, 5), np.nan)
    path[0] = 0.0, *y
    rule, set_ = (STATE, float(longest), 0), (releases.depth, releases.half)
    side = side_of(on, y)
    end, _, _ = hold(
        on, y, side, begin, longest + 1.0, rule, 0.0, *set_, tolerance, path[1:], workspace()
    )
    y[2], y[3] = y[0], y[1]
    rows = path[~np.isnan(path[:, 0])]
    rows = np.vstack([rows, [(end - begin) * on[FREQUENCY] / (2.0 * math.pi), *y]])
    rows[:, 0] += strobe + wait
    return rows


def life(p, path, record, tolerance):
    """Return the forcing cycles after which a run stays within CAPTURE of its final orbit.

    `path` is the path of the run, from `run`, and `record` the motion that it settled to.
    """
    orbit = np.empty((record["period"], 4))
    begin = strobe_time(p)
    strobes = begin + np.arange(len(orbit)) * 2.0 * math.pi / p[FREQUENCY]
    trace(p, record["state"].copy(), begin, strobes, tolerance, orbit, np.empty((0, 5)))
    last = record["periods_run"]
    there = orbit[np.arange(-last, 1) % len(orbit), :2]
    far = np.any(np.abs(path[1 : last + 2, 1:3] - there) > CAPTURE, axis=1)
    return int(np.max(np.flatnonzero(far), initial=-1)) + 1


@kernel
def depth_of(depth, half, phase, x, v):
    """Return the depth of the state (x, v) at the phase of an index, minus infinity off the grid.

    `depth` and `half` are the attributes of a `ReleaseSet`.
    """
    if not (abs(x) <= half[0] and abs(v) <= half[1]):
        return -math.inf
    cells = depth.shape[1]
    column = min(int((x / half[0] + 1.0) * 0.5 * cells), cells - 1)
    row = min(int((v / half[1] + 1.0) * 0.5 * cells), cells - 1)
    return depth[phase, row, column]


@kernel
def hold(on, y, side, begin, limit, rule, draw, depth, half, tolerance, path, work):
    """Run a motion with the damper on until a rule releases it.

    Parameters
    ----------
    y : array, shape (4,)
        State at the time `begin`, replaced by the state at the release.
    side : int
        Wall in contact (-1, 1, or 0 for none).
    limit : float
        Largest number of forcing cycles.
    rule : tuple of (int, float, int)
        Kind, number n of forcing cycles, and index of a phase. HOLD releases after n cycles, PHASE
        at the first such phase after n cycles, SETTLED at the fraction `draw` of a period after the
        states at the strobes repeat, STATE as soon as the state lies inside the release set, or
        after n cycles.
    depth, half : array
        The attributes of a `ReleaseSet`.
    path : array, shape (m, 5)
        Receives a row for each of the first m strobes: forcing cycles since `begin`, and the state.

    Returns
    -------
    t : float
        Time of the end.
    released : bool
        Whether the rule released the damper within `limit`.
    contacts : int
        Number of contacts begun.
    """
    kind, length, wanted = rule
    none, ring = np.empty((0, 4)), np.empty((RING, 4))
    phases, period = depth.shape[0], 2.0 * math.pi / on[FREQUENCY]
    step = period / phases
    k = int(math.floor(begin / step)) + 1
    t, release, strobes, total = begin, math.inf, 0, 0
    if kind == HOLD or kind == STATE:
        release = begin + length * period
    while True:
        end = min(k * step, release)
        side, contacts, _ = advance(on, y, none, side, t, end, tolerance, work)
        total += contacts
        t = end
        if t >= release:
            return t, True, total
        if t - begin >= limit * period:
            return t, False, total
        phase = k % phases
        k += 1
        if phase == phases // 4:
            if strobes < len(path):
                path[strobes, 0] = (t - begin) / period
                assign(path[strobes, 1:], y)
            if kind == SETTLED and release == math.inf:
                assign(ring[strobes % RING], y)
                n = nearby_period(ring, strobes, 1.0, 20.0 * tolerance, NEAR)
                if n > 0:
                    release = t + draw * n * period
            strobes += 1
        if kind == PHASE and phase == wanted and t - begin >= length * period:
            return t, True, total
        if kind == STATE and depth_of(depth, half, phase, y[0], y[1]) > 0.0:
            return t, True, total
