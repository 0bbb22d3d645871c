"""Boundaries of the free oscillator's basins, which are stable manifolds of its unstable orbits.

A manifold is computed backwards in time, in which nearby curves approach it: errors decrease. It is
followed within the half widths `reach` of Z1 and Z1', and kept within the half widths `window`.
"""

import math

import numpy as np

from impact_damper.data.sweeps import runs_of_true
from impact_damper.kernel.batch import advance
from impact_damper.model.packed import DAMPING, FREQUENCY
from impact_damper.orbits.shooting import find_orbit

# Distance from the saddle at which a manifold begins, in units of Z1 and Z1'.
NEAR = 1e-5
# Largest numbers on each side of a saddle: periods, points within the window, points within the
# reach, and halvings of an interval between neighbouring points.
MOST_PERIODS, MOST_POINTS, MOST_IN_ALL, MOST_HALVINGS = 60, 40_000, 100_000, 12
FIRST_POINTS = 33
# Largest distance of neighbouring points outside the window, divided by the reach.
OUTSIDE = 0.01
# Largest difference between the states of equal orbits.
SAME = 1e-6
# Number of states in one call of the kernel. Ctrl-C waits for the end of the call.
CHUNK = 4096


def saddles(p, states, periods, phase):
    """Return the saddles (unstable orbits) that Newton's method finds from given states."""
    orbits, known = [], np.empty((0, 2))
    for n in sorted(set(periods)):
        for state in states:
            orbit = find_orbit(p, np.tile(state, 2), n, phase)
            if not orbit.converged or not abs(orbit.multipliers[0]) > 1:
                continue
            if len(known) and np.min(np.max(np.abs(known - orbit.state[:2]), axis=1)) < SAME:
                continue
            known = np.concatenate([known, images(orbit)])
            orbits.append(orbit)
    return orbits


def images(orbit):
    """Return the states Z1, Z1' of a free orbit of period n, one for each cycle, shape (n, 2)."""
    turns = orbit.phase + 2 * math.pi * np.arange(orbit.periods)
    return np.array([orbit.at(turn)[:2] for turn in turns])


def run_backwards(p, states, phase, tolerance, reach):
    """Return the states one forcing cycle before given states, or NaN for states beyond the reach.

    Backwards in time, with the velocity reversed, the equation is the same with negative damping.
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
    """Return a saddle's stable manifold in a window, in pieces, and whether it is complete."""
    values, vectors = np.linalg.eig(orbit.monodromy[:2, :2])
    k = int(np.argmin(np.abs(values)))
    direction = vectors[:, k].real / np.linalg.norm(vectors[:, k].real)
    # With a negative multiplier, a point comes back to the same side only after two periods.
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
        for first, last in runs_of_true(inside):
            pieces.append(states[max(first - 1, 0) : last + 1])
        kept = near.copy()
        kept[1:] |= near[:-1]
        kept[:-1] |= near[1:]
        later = states[kept]
    return pieces, False


def _wide(states, window, spacing, reach):
    """Return the mask of the pairs of neighbouring states that are too far apart.

    A pair with one unknown state (NaN) is too far apart if the other lies in or near the window.
    """
    apart = np.abs(np.diff(states, axis=0))
    inside = np.all(np.abs(states) <= window + 2 * spacing, axis=1)
    near = np.all(np.abs(states) <= reach, axis=1)
    inside, near = inside[1:] | inside[:-1], near[1:] | near[:-1]
    lost = np.isnan(apart).any(axis=1)
    allowed = np.where(inside[:, None], spacing, OUTSIDE * reach)
    return np.where(lost, inside, near & np.any(apart > allowed, axis=1))
