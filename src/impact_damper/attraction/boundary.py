"""Boundaries of the free oscillator's basins: stable manifolds of its unstable orbits.

The map over a period has saddles, orbits with one multiplier inside the unit circle and one
outside. The states that tend to a saddle form a curve, its stable manifold, which separates basins.
The curve is grown backwards in time from a short segment along the saddle's stable direction.
Points are inserted wherever neighbours are further apart than a given spacing, midway between
points of the period after it. The errors of this interpolation shrink, since backwards in time all
nearby curves approach the stable manifold.
"""

import math

import numpy as np

from impact_damper.kernel.batch import advance
from impact_damper.orbits.shooting import find_orbit
from impact_damper.system.packed import DAMPING, FREQUENCY

# Distance from the saddle at which the segment begins, in units of Z1 and Z1'.
NEAR = 1e-5
# Forcing periods over which a curve is grown at most, and most points on each side of the saddle,
# within the window and in all.
MOST_PERIODS = 60
MOST_POINTS = 40_000
MOST_IN_ALL = 100_000
# Points on a segment at first, and halvings of an interval between neighbours at most.
FIRST_POINTS = 33
MOST_HALVINGS = 12
# Points of a curve outside the window: distance of neighbours over the reach of the curve.
OUTSIDE = 0.01
# States of two orbits that differ by less are the same.
SAME = 1e-6
CHUNK = 4096


def saddles(p, states, periods, phase):
    """Return the unstable orbits found by Newton's method from states.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters without a damper.
    states : array, shape (n, 2)
        Z1 and Z1' from which orbits are looked for.
    periods : iterable of int
        Periods in forcing periods that are looked for.
    phase : float
        Phase W T of the states, radian.

    Returns
    -------
    list of orbits.orbit.Orbit
        By rising period; each orbit once.
    """
    found, known = [], np.empty((0, 2))
    for n in sorted(set(periods)):
        for state in states:
            orbit = find_orbit(p, np.tile(state, 2), n, phase)
            if not orbit.converged or not abs(orbit.multipliers[0]) > 1:
                continue
            if len(known) and np.min(np.max(np.abs(known - orbit.state[:2]), axis=1)) < SAME:
                continue
            known = np.concatenate([known, images(orbit)])
            found.append(orbit)
    return found


def images(orbit):
    """Return the states Z1, Z1' of a free orbit a forcing period apart, shape (n, 2)."""
    turns = orbit.phase + 2 * math.pi * np.arange(orbit.periods)
    return np.array([orbit.at(turn)[:2] for turn in turns])


def run_backwards(p, states, phase, tolerance, reach):
    """Return the states a forcing period before states at a phase; NaN for states beyond the reach.

    Backwards in time the oscillator, with its velocity reversed, has negative damping.
    """
    reverse = p.copy()
    reverse[DAMPING] = -p[DAMPING]
    begin, period = -phase / p[FREQUENCY], 2 * math.pi / p[FREQUENCY]
    earlier = np.full_like(states, np.nan)
    inside = np.flatnonzero(np.all(np.abs(states) <= reach, axis=1))
    for first in range(0, len(inside), CHUNK):
        part = inside[first : first + CHUNK]
        y = np.tile(states[part] * (1, -1), 2)
        sides, contacts = np.zeros(len(part), np.int64), np.zeros(len(part), np.int64)
        starts = np.full(len(part), begin)
        rows = np.tile(reverse, (len(part), 1))
        advance(rows, y, sides, starts, starts + period, tolerance, contacts)
        earlier[part] = y[:, :2] * (1, -1)
    return earlier


def stable_manifold(orbit, tolerance, window, spacing, reach):
    """Return the stable manifold of a saddle within a window.

    Parameters
    ----------
    orbit : orbits.orbit.Orbit
        A saddle of the free oscillator.
    tolerance : float
        Local error allowed.
    window : array, shape (2,)
        Largest |Z1| and |Z1'| of interest.
    spacing : array, shape (2,)
        Largest distance of neighbouring points in Z1 and Z1' within the window.
    reach : array, shape (2,)
        |Z1| and |Z1'|, not less than the window, beyond which the curve is not followed: so large
        that motions backwards in time do not come back from there.

    Returns
    -------
    pieces : list of numpy.ndarray, shape (n, 2)
        Pieces of the curve: for each side of the saddle and each period backwards one or more.
    complete : bool
        Whether the curve was grown until it left the window; a curve that winds without end is cut
        after MOST_POINTS points on each side.
    """
    values, vectors = np.linalg.eig(orbit.monodromy[:2, :2])
    k = int(np.argmin(np.abs(values)))
    direction = vectors[:, k].real / np.linalg.norm(vectors[:, k].real)
    # with a negative multiplier two periods of the orbit lead back to the same side
    growth = 1 / abs(values[k].real) ** (1 if values[k].real > 0 else 2)
    sides = [
        _grow(orbit, side * direction, growth, tolerance, window, spacing, reach)
        for side in (-1, 1)
    ]
    return [piece for pieces, _ in sides for piece in pieces], all(whole for _, whole in sides)


def _grow(orbit, direction, growth, tolerance, window, spacing, reach):
    """Return the pieces of one side of a stable manifold, and whether it is complete."""

    def earlier(states):
        return run_backwards(orbit.p, states, orbit.phase, tolerance, reach)

    places = np.linspace(0, 1, FIRST_POINTS)
    later = orbit.state[:2] + NEAR * growth ** places[:, None] * direction
    pieces, total, within = [], 0, 0
    for _ in range(MOST_PERIODS):
        states = earlier(later)
        for _ in range(MOST_HALVINGS):
            wide = _wide(states, window, spacing, reach)
            if not wide.any() or len(states) > MOST_IN_ALL:
                break
            middle = 0.5 * (later[:-1] + later[1:])[wide]
            at = np.flatnonzero(wide) + 1
            later = np.insert(later, at, middle, axis=0)
            states = np.insert(states, at, earlier(middle), axis=0)
        inside = np.all(np.abs(states) <= window + spacing, axis=1)
        near = np.all(np.abs(states) <= reach, axis=1)
        if not near.any():
            return pieces, True
        total, within = total + np.sum(near), within + np.sum(inside)
        if total > MOST_IN_ALL or within > MOST_POINTS:
            break
        ends = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]]).astype(int)))
        for first, last in ends.reshape(-1, 2):
            pieces.append(states[max(first - 1, 0) : last + 1])
        kept = near.copy()
        kept[1:] |= near[:-1]
        kept[:-1] |= near[1:]
        later = states[kept]
    return pieces, False


def _wide(states, window, spacing, reach):
    """Return which neighbouring states are too far apart, one of them within reach at least.

    Neighbours of a state that was beyond reach (NaN) count only next to the window.
    """
    apart = np.abs(np.diff(states, axis=0))
    inside = np.all(np.abs(states) <= window + 2 * spacing, axis=1)
    near = np.all(np.abs(states) <= reach, axis=1)
    inside, near = inside[1:] | inside[:-1], near[1:] | near[:-1]
    lost = np.isnan(apart).any(axis=1)
    allowed = np.where(inside[:, None], spacing, OUTSIDE * reach)
    return np.where(lost, inside, near & np.any(apart > allowed, axis=1))
