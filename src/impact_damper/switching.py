"""Kernels of migration control: legs of a run with the damper on and off, and where releases lead.

A run is looked at once a forcing period, at the strobe of `orbits`. A leg begins where the
damper is switched, somewhere between two strobes; Z1 and Z1' go through it unchanged. It
ends at the strobe where the motion is near a stable orbit or its time is up. The state is
left where it is, not taken onto that orbit, so that a run is one continuous motion.
"""

import math

import numpy as np

from impact_damper.accelerate import kernel
from impact_damper.kernel import advance, side_of, workspace
from impact_damper.motion import (
    NEAR,
    NEAREST,
    RING,
    SETTLED,
    UNRESOLVED,
    land,
    nearby_period,
)
from impact_damper.orbits import one_period, strobe_time
from impact_damper.recording import measure

LOST, NON_RESONANCE, RESONANCE, SUBHARMONIC, OTHER = 0, 1, 2, 3, 4
ALIKE = 1e-6
# A run counts as captured by an orbit after the last strobe at which (Z1, Z1') is farther from
# it than this.
CAPTURE = 0.1

SWITCHING = np.dtype(
    [
        ("on_time", "f8"),
        ("off_time", "f8"),
        ("end_time", "f8"),
        ("released_period", "i2"),
        ("released_displacement", "f8"),
        ("destination", "i1"),
        ("destination_displacement", "f8"),
    ]
)
RELEASE = np.dtype(
    [
        ("phase", "f8"),
        ("displacement", "f8"),
        ("velocity", "f8"),
        ("destination", "i1"),
    ]
)


@kernel
def switch(before, after, y, wait, place, tolerance, work):
    """Go on for `wait` forcing periods from a strobe, then change the parameters.

    Switched on, the loose mass is at `place` in the gap (-1 to 1), at rest relative to the
    primary; switched off, it is of no account. Returns the forcing periods to the next strobe.
    """
    none = np.empty((0, 4))
    t = strobe_time(before)
    end = t + wait * 2.0 * math.pi / before[0]
    advance(before, y, none, side_of(before, y), t, end, tolerance, work)
    if after[3] == math.inf:
        y[2], y[3] = y[0], y[1]
    else:
        y[2], y[3] = place * after[3], 0.0
    return 1.0 - wait % 1.0


@kernel
def run(p, y, ahead, strobe, tolerance, limit, path, out):
    """Run for `limit` strobes, or until near a stable orbit, which is measured.

    `path` gets a row (forcing periods, state) at the start, `ahead` periods before the strobe
    numbered `strobe`, and at each strobe: at most limit + 2. To the record `out` go outcome,
    period, periods_run and, of a settled motion, its orbit and what `measure` finds.
    """
    weight = 1.0 / math.sqrt(1.0 + p[4] * (1.0 + p[5]))
    work = workspace()
    none = np.empty((0, 4))
    ring = np.empty((RING, 4))
    near = NEAR
    t = strobe_time(p)
    out.outcome, out.period, out.maximum_displacement = UNRESOLVED, 0, np.nan
    path[0, 0], path[0, 1:] = strobe - ahead, y
    side, _, _ = advance(
        p, y, none, side_of(p, y), t - ahead * 2.0 * math.pi / p[0], t, tolerance, work
    )
    for k in range(limit + 1):
        path[k + 1, 0], path[k + 1, 1:] = strobe + k, y
        ring[k % RING] = y
        out.periods_run = k
        n = nearby_period(ring, k, weight if side != 0 else 1.0, 20.0 * tolerance, near)
        if n > 0:
            orbit = y.copy()
            if land(p, orbit, n, near, out):
                out.state[:] = orbit
                measure(p, orbit, out.period, tolerance, out)
                break
            near = max(0.1 * near, NEAREST)
        if k < limit:
            side, _, _ = one_period(p, y, none, side, tolerance, work)


@kernel
def leg(before, after, y, wait, place, strobe, tolerance, limit, path, out):
    """`switch` after `wait` periods from a strobe, then `run`. Returns the number of the strobe."""
    ahead = switch(before, after, y, wait, place, tolerance, workspace())
    strobe += math.floor(wait) + 1.0
    run(after, y, ahead, strobe, tolerance, limit, path, out)
    return strobe + out.periods_run


@kernel
def destination(known, out):
    """Which free motion a settled record is; `known` holds max |Z1| of goal and resonance."""
    if out.outcome != SETTLED:
        return LOST
    if out.period == 3:
        return SUBHARMONIC
    if out.period == 1 and abs(out.maximum_displacement - known[0]) < ALIKE:
        return NON_RESONANCE
    if out.period == 1 and abs(out.maximum_displacement - known[1]) < ALIKE:
        return RESONANCE
    return OTHER


@kernel
def control(on, off, state, draws, known, tolerance, hold, limit, periods, path, log, out):
    """One run of the controller of figure 17, from a strobe of the free resonance motion.

    Parameters
    ----------
    on, off : array, shape (7,)
        Packed parameters with and without the damper.
    state : array, shape (4,)
    draws : array, shape (m, 3)
        For each switching a phase of switching on, a place of the loose mass and a phase of
        release, in [0, 1): phases as a share of the period of the motion before.
    known : array, shape (2,)
        max |Z1| of the non-resonance and the resonance motion.
    tolerance : float
    hold, limit, periods : int
        Longest run with the damper on, longest without, and when no switching begins any more.
    path : array, shape (n, 5)
        Gets a row (forcing periods, state) at each strobe and switching; long enough.
    log : array of SWITCHING, shape (m,)
        Filled, times in forcing periods from the first strobe.
    out : array of recording.MOTION, shape (1,)
        Room for a record.

    Returns
    -------
    switchings, rows : int
        Entries of `log` and rows of `path` made.
    """
    y = state.copy()
    motion = out[0]
    strobe, rows, repeat = 0.0, 0, 1
    for i in range(len(draws)):
        if strobe >= periods:
            return i, rows
        entry = log[i]
        wait = draws[i, 0] * repeat
        entry.on_time = strobe + wait
        place = 2.0 * draws[i, 1] - 1.0
        strobe = leg(off, on, y, wait, place, strobe, tolerance, hold, path[rows:], motion)
        rows += motion.periods_run + 2
        entry.released_period = motion.period
        entry.released_displacement = motion.maximum_displacement
        wait = draws[i, 2] * max(motion.period, 1)
        entry.off_time = strobe + wait
        strobe = leg(on, off, y, wait, 0.0, strobe, tolerance, limit, path[rows:], motion)
        rows += motion.periods_run + 2
        entry.end_time = strobe
        entry.destination = destination(known, motion)
        entry.destination_displacement = motion.maximum_displacement
        if entry.destination == NON_RESONANCE:
            return i + 1, rows
        repeat = max(motion.period, 1)
    return len(draws), rows


@kernel
def control_many(
    on, off, state, draws, known, tolerance, hold, limit, periods, path, logs, counts, out
):
    """`control` for draws (n, m, 3): logs (n, m) and counts of switchings (n,).

    Returns the rows of `path`, which is that of the last run.
    """
    rows = 0
    for i in range(len(draws)):
        counts[i], rows = control(
            on, off, state, draws[i], known, tolerance, hold, limit, periods, path, logs[i], out
        )
    return rows


@kernel
def release(on, off, state, wait, known, tolerance, limit, path, entry, out):
    """Switch the damper off `wait` forcing periods after a strobe, and see where that leads."""
    y = state.copy()
    leg(on, off, y, wait, 0.0, 0.0, tolerance, limit, path, out[0])
    entry.phase = wait
    entry.displacement, entry.velocity = path[0, 1], path[0, 2]
    entry.destination = destination(known, out[0])


@kernel
def release_many(on, off, state, waits, known, tolerance, limit, entries, out):
    """`release` of one orbit after each of the waits."""
    path = np.empty((limit + 2, 5))
    for i in range(len(waits)):
        release(on, off, state, waits[i], known, tolerance, limit, path, entries[i], out)


@kernel
def life(p, path, out, tolerance):
    """Forcing periods until a run came within CAPTURE of the orbit it settled on, for good."""
    work = workspace()
    none = np.empty((0, 4))
    orbit = np.empty((out.period, 4))
    y = out.state.copy()
    side = side_of(p, y)
    for j in range(out.period):
        orbit[j] = y
        side, _, _ = one_period(p, y, none, side, tolerance, work)
    last = out.periods_run
    for k in range(last, -1, -1):
        there = orbit[(k - last) % out.period]
        if max(abs(path[k + 1, 1] - there[0]), abs(path[k + 1, 2] - there[1])) > CAPTURE:
            return k + 1
    return 0


@kernel
def transients(
    on, off, state, draws, known, tolerance, lead, lifetime, limit, lives, motions, entries, out
):
    """Runs with the damper on from the free resonance motion, each released once on its way.

    Of the draws (n, 4) the first two are as in `control`; the others give the instant of a
    release, uniform from `lead` strobes on until the run is captured, if it lives so long, and
    its phase within the forcing period. Filled are `lives`, the lifetime for a run that has not
    settled by then, records `motions` and releases `entries`.
    """
    path = np.empty((lifetime + 2, 5))
    rest = np.empty((limit + 2, 5))
    for i in range(len(draws)):
        y = state.copy()
        leg(
            off,
            on,
            y,
            draws[i, 0],
            2.0 * draws[i, 1] - 1.0,
            0.0,
            tolerance,
            lifetime,
            path,
            motions[i],
        )
        lives[i] = lifetime
        if motions[i].outcome == SETTLED:
            lives[i] = life(on, path, motions[i], tolerance)
        if lives[i] > lead:
            k = lead + int(draws[i, 2] * (lives[i] - lead))
            release(
                on,
                off,
                path[k + 1, 1:],
                draws[i, 3],
                known,
                tolerance,
                limit,
                rest,
                entries[i],
                out,
            )
