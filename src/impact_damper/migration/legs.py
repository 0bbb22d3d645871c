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
from impact_damper.motions.records import UNRESOLVED, measure, trace
from impact_damper.motions.settling import NEAR, NEAREST, RING, land, nearby_period
from impact_damper.motions.strobe_map import one_period, speed_weight, strobe_time
from impact_damper.system.packed import CLEARANCE, FREQUENCY

# A run counts as captured by an orbit after the last strobe at which (Z1, Z1') is farther from
# it than this.
CAPTURE = 0.1


@kernel
def run(p, y, ahead, strobe, tolerance, limit, path, out):
    """Run for `limit` strobes, or until near a stable orbit.

    `path` gets a row (forcing periods, state) at the start, `ahead` periods before the strobe
    numbered `strobe`, and at each strobe: at most limit + 2. To the record `out` go outcome,
    period, periods_run and, of a settled motion, its orbit.
    """
    work = workspace()
    none = np.empty((0, 4))
    ring = np.empty((RING, 4))
    near = NEAR
    t = strobe_time(p)
    out.outcome, out.period, out.maximum_displacement = UNRESOLVED, 0, np.nan
    path[0, 0] = strobe - ahead
    assign(path[0, 1:], y)
    side, _, _ = advance(
        p, y, none, side_of(p, y), t - ahead * 2.0 * math.pi / p[FREQUENCY], t, tolerance, work
    )
    for k in range(limit + 1):
        path[k + 1, 0] = strobe + k
        assign(path[k + 1, 1:], y)
        assign(ring[k % RING], y)
        out.periods_run = k
        n = nearby_period(ring, k, speed_weight(p, side), 20.0 * tolerance, near)
        if n > 0:
            orbit = y.copy()
            if land(p, orbit, n, near, out):
                assign(out.state, orbit)
                break
            near = max(0.1 * near, NEAREST)
        if k < limit:
            side, _, _ = one_period(p, y, none, side, tolerance, work)


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
    out : array of recording.MOTION, shape (1,)
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
        measure(after[None], tolerance, 0, out)
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
