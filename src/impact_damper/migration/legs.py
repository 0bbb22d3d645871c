"""Legs of a run of migration control, with the damper switched on or off between them.

A run is looked at once a forcing period, at the strobe of `orbits`. A leg begins where the
damper is switched, somewhere between two strobes; Z1 and Z1' go through it unchanged. It
ends at the strobe where the motion is near a stable orbit or its time is up. The state is
left where it is, not taken onto that orbit, so that a run is one continuous motion.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import advance, assign, side_of, workspace
from impact_damper.motions.records import NEVER, SETTLED, UNRESOLVED, measure, trace
from impact_damper.motions.settling import NEAR, NEAREST, RING, move_onto_orbit, nearby_period
from impact_damper.motions.strobe_map import one_period, speed_weight, strobe_time
from impact_damper.system.packed import CLEARANCE, FREQUENCY

# A run counts as captured by an orbit after the last strobe at which (Z1, Z1') is farther from
# it than this.
CAPTURE = 0.1
# Forcing periods in one call of a kernel, a fraction of a second: Ctrl-C waits for its end.
STROBES_AT_ONCE = 50_000


def run(p, y, ahead, strobe, tolerance, limit, path, out):
    """Run for `limit` strobes, or until near a stable orbit.

    `path` gets a row (forcing periods, state) at the start, `ahead` periods before the strobe
    numbered `strobe`, and at each strobe: at most limit + 2. To the record `out` go outcome,
    period, periods_run and, of a settled motion, its orbit.
    """
    out["outcome"], out["period"], out["maximum_displacement"] = UNRESOLVED, 0, np.nan
    path[0, 0], path[0, 1:] = strobe - ahead, y
    t = strobe_time(p)
    begin = t - ahead * 2.0 * math.pi / p[FREQUENCY]
    side, near, ring = side_of(p, y), NEAR, np.empty((RING, 4))
    side, _, _ = advance(p, y, np.empty((0, 4)), side, begin, t, tolerance, workspace())
    for first in range(0, limit + 1, STROBES_AT_ONCE):
        last = min(first + STROBES_AT_ONCE, limit + 1)
        side, near = run_strobes(
            p, y, side, near, ring, strobe, tolerance, first, last, limit, path, out
        )
        if out["outcome"] == SETTLED:
            break


@kernel
def run_strobes(p, y, side, near, ring, strobe, tolerance, first, last, limit, path, out):
    """Go on with `run` from one strobe to before another.

    Returns the wall in contact, and how near an orbit the motion must come.
    """
    work = workspace()
    none = np.empty((0, 4))
    for k in range(first, last):
        path[k + 1, 0] = strobe + k
        assign(path[k + 1, 1:], y)
        assign(ring[k % RING], y)
        out.periods_run = k
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


def leg(before, after, y, wait, place, strobe, tolerance, limit, path, out):
    """Go on for `wait` forcing periods after a strobe, switch, `run`, and measure what settles.

    Parameters
    ----------
    before, after : array, shape (packed.COUNT,)
        Packed parameters before and after the switching, one of them without the damper.
    y : array, shape (4,)
        State at the strobe; replaced by that at the last one.
    wait : float
        Forcing periods from the strobe to the switching.
    place : float
        Where in the gap, from -1 to 1, the loose mass is when the damper is switched on, at
        rest relative to the primary; switched off, it is of no account.
    strobe : float
        Number of the first strobe.
    tolerance, limit, path
        As in `run`.
    out : array of records.MOTION, shape (1,)
        Gets what `run` finds and, of a settled motion, what `measure` does.

    Returns
    -------
    float
        Number of the last strobe.
    """
    none = np.empty((0, 4))
    t = strobe_time(before)
    end = t + wait * 2.0 * math.pi / before[FREQUENCY]
    advance(before, y, none, side_of(before, y), t, end, tolerance, workspace())
    if after[CLEARANCE] == math.inf:
        y[2], y[3] = y[0], y[1]
    else:
        y[2], y[3] = place * after[CLEARANCE], 0.0
    strobe += math.floor(wait) + 1.0
    record = out[0]
    run(after, y, 1.0 - wait % 1.0, strobe, tolerance, limit, path, record)
    if record["period"] > 0:
        measure(after[None], tolerance, 0, out, NEVER)
    return strobe + record["periods_run"]


def life(p, path, record, tolerance):
    """Forcing periods until a run came within CAPTURE of the orbit it settled on, for good."""
    orbit = np.empty((record["period"], 4))
    begin = strobe_time(p)
    strobes = begin + np.arange(len(orbit)) * 2.0 * math.pi / p[FREQUENCY]
    trace(p, record["state"].copy(), begin, strobes, tolerance, orbit, np.empty((0, 5)))
    last = record["periods_run"]
    there = orbit[np.arange(-last, 1) % len(orbit), :2]
    far = np.any(np.abs(path[1 : last + 2, 1:3] - there) > CAPTURE, axis=1)
    return int(np.max(np.flatnonzero(far), initial=-1)) + 1
