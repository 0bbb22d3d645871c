"""Legs: parts of a run of migration control in which the damper stays on, or stays off.

Each leg begins with the Z1 and Z1' at which the leg before has ended.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.equation import has_escaped
from impact_damper.kernel.single import assign, side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import CLEARANCE, FREQUENCY
from impact_damper.motions.records import ESCAPED, MOTION, NEVER, UNRESOLVED, measure_orbits
from impact_damper.motions.strobe_map import one_period, speed_weight, strobe_time
from impact_damper.motions.watch import NEAR, NEAREST, RING, move_onto_orbit, nearby_period

# Number of forcing cycles in one call of a kernel. Ctrl-C waits until the call ends.
STROBES_AT_ONCE = 50_000
# Rules for `hold`. They say when to switch the damper off.
SETTLED, HOLD, PHASE, STATE = range(4)


def run(p, y, ahead, strobe, tolerance, limit, stop=NEVER):
    """Run a motion until it settles or escapes, for at most `limit` cycles after the first strobe.

    The motion begins in the state y (4,), `ahead` forcing cycles before its first strobe. The last
    state replaces y. Return the path and a record (`MOTION`), with measurements if the motion has
    settled. The path (m, 5) has a row for the beginning and one for each strobe. A row holds the
    time in forcing cycles and the state. The first strobe has the time `strobe`.
    """
    records, path = np.zeros(1, MOTION), np.empty((limit + 2, 5))
    out = records[0]
    out["outcome"], out["maximum_displacement"] = UNRESOLVED, np.nan
    path[0, 0], path[0, 1:] = strobe - ahead, y
    t = strobe_time(p)
    begin = t - ahead * 2.0 * math.pi / p[FREQUENCY]
    side, near, ring = side_of(p, y), NEAR, np.empty((RING, 4))
    side, _, _ = advance(p, y, np.empty((0, 4)), side, begin, t, tolerance, workspace())
    for first in range(0, limit + 1, STROBES_AT_ONCE):
        if stop[0]:
            raise InterruptedError("another thread has stopped the run")
        last = min(first + STROBES_AT_ONCE, limit + 1)
        side, near = run_strobes(
            p, y, side, near, ring, strobe, tolerance, first, last, limit, path, out
        )
        if out["outcome"] != UNRESOLVED:
            break
    if out["period"] > 0:
        measure_orbits(p[None], tolerance, records, NEVER)
    return path[: out["periods_run"] + 2], out


@kernel
def run_strobes(p, y, side, near, ring, strobe, tolerance, first, last, limit, path, out):
    """Judge a motion at strobes `first` to `last` - 1; stop when it has settled or escaped.

    The motion runs from each of these strobes to the next, but not beyond strobe number `limit`.
    `strobe` is the time of strobe number 0, in forcing cycles. `path` is as in `run`. `ring` holds
    the last strobe states. Newton's method is tried if the motion seems nearer to an orbit than
    `near`; each failure reduces `near`. Return the wall in contact at the end and the last `near`.
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


def leg(before, after, y, wait, place, strobe, tolerance, limit, stop=NEVER):
    """Run from a strobe, switch the damper (`wait_and_switch`), and return what `run` returns."""
    wait_and_switch(before, after, y, wait, place, tolerance)
    return run(after, y, 1.0 - wait % 1.0, strobe + math.floor(wait) + 1.0, tolerance, limit, stop)


def wait_and_switch(before, after, y, wait, place, tolerance):
    """Run from a strobe for `wait` forcing cycles, switch the damper; return the switching time.

    `before` and `after` are the packed parameters before and after the switching. Switching the
    damper on sets Z2 to `place` times the clearance, and Z2' to 0.
    """
    t = strobe_time(before)
    end = t + wait * 2.0 * math.pi / before[FREQUENCY]
    advance(before, y, np.empty((0, 4)), side_of(before, y), t, end, tolerance, workspace())
    if after[CLEARANCE] == math.inf:
        y[2], y[3] = y[0], y[1]
    else:
        y[2], y[3] = place * after[CLEARANCE], 0.0
    return end


def hold_by_state(off, on, y, wait, place, strobe, tolerance, longest, releases):
    """Switch the damper on, and switch it off when the state is in the release set `releases`.

    The run begins in the state y at a strobe, at the time `strobe` in forcing cycles. After `wait`
    cycles the damper is switched on: packed parameters `on` replace `off`, and Z2 is set to `place`
    times the clearance. The damper then stays on for at most `longest` cycles. The last state
    replaces y. Return the path with the damper on, in rows as in `run`.
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


@kernel
def depth_of(depth, half, phase, x, v):
    """Return the distance of the state Z1 = x, Z1' = v from the edge of a release set.

    `depth` and `half` are fields of a `ReleaseSet`, and `phase` is an index on the first axis of
    `depth`. The distance is negative outside the set, and -infinity outside its grid.
    """
    if not (abs(x) <= half[0] and abs(v) <= half[1]):
        return -math.inf
    cells = depth.shape[1]
    column = min(int((x / half[0] + 1.0) * 0.5 * cells), cells - 1)
    row = min(int((v / half[1] + 1.0) * 0.5 * cells), cells - 1)
    return depth[phase, row, column]


@kernel
def hold(on, y, side, begin, limit, rule, draw, depth, half, tolerance, path, work):
    """Run a motion with the damper on, from the time T = `begin` until a rule ends the run.

    A run also ends after `limit` cycles. `rule` is (kind, n, k). HOLD ends the run after n forcing
    cycles. PHASE ends it when W T modulo 2 pi is 2 pi k/PHASES for the first time after n cycles.
    STATE ends it when the state is in the `ReleaseSet` with the fields `depth` and `half`, or after
    n cycles. SETTLED ends it after the strobe states repeat, at the fraction `draw` of the next
    period. Each strobe gives a row of `path` (m, 5): forcing cycles since `begin`, and the state.
    Return the time T of the end, whether the rule ended the run, and the number of contacts begun.
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
