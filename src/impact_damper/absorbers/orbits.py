"""Periodic orbits by Newton's method on the map over their period, with multipliers."""

from typing import NamedTuple

import numpy as np

from impact_damper.absorbers.problems import Problems, rate, secants
from impact_damper.absorbers.stepping import FINE, blocks, step, steps_for

# Newton's method: relative correction on convergence, most corrections, and largest first
# correction relative to the state.
CONVERGED = 1e-11
CORRECTIONS = 12
FARTHEST = 1e3


class Orbits(NamedTuple):
    """Periodic orbits, one for each problem.

    Attributes
    ----------
    state : numpy.ndarray, shape (size, n)
        State at W T = 0.
    converged : numpy.ndarray of bool, shape (n,)
        Whether Newton's method converged.
    multipliers : numpy.ndarray of complex, shape (n, size)
        Floquet multipliers over the period.
    displacement : numpy.ndarray, shape (n,)
        Largest |x|.
    relative : numpy.ndarray, shape (n,)
        Largest |u|; 0 without an absorber.
    """

    state: np.ndarray
    converged: np.ndarray
    multipliers: np.ndarray
    displacement: np.ndarray
    relative: np.ndarray

    @property
    def stable(self):
        """Mask of the orbits that were found and whose multipliers are all below 1 in modulus."""
        return self.converged & (np.abs(self.multipliers).max(axis=1) < 1)

    def take(self, chosen) -> "Orbits":
        """Return the orbits with some indices."""
        return Orbits(self.state[:, chosen], *(each[chosen] for each in self[1:]))


def find_orbits(problems, guesses, periods=1) -> Orbits:
    """Return the orbits to which Newton's method leads from guesses of their states.

    Parameters
    ----------
    problems : Problems
    guesses : numpy.ndarray, shape (size, n)
        States at W T = 0.
    periods : int
        Period of the orbits in forcing periods.
    """
    size, count = problems.size, len(problems.frequency)
    found = Orbits(
        guesses.copy(),
        np.zeros(count, bool),
        np.full((count, size), np.nan, complex),
        np.full(count, np.nan),
        np.zeros(count),
    )
    reach = np.abs(guesses[::2])
    swing = np.hypot(guesses[::2], guesses[1::2] / problems.frequency)
    steps = steps_for(problems, np.maximum(reach, swing), FINE)
    with np.errstate(all="ignore"):
        for number, chosen in blocks(steps):
            _newton(problems.take(chosen), chosen, number, periods, found)
    return found


def _newton(problems, places, number, periods, found):
    """Run Newton's method for one block, and enter the orbits in `found`."""
    active = np.arange(len(places))
    state = found.state[:, places].copy()
    scale = np.ones((problems.size, len(places)))
    for _ in range(CORRECTIONS):
        some = problems.take(active)
        after, slope, track = period_map(some, state[:, active], number, periods)
        miss = (after - state[:, active]).T
        system = np.moveaxis(slope, 2, 0) - np.eye(problems.size)
        change = _solve(system, miss)
        good = np.isfinite(change).all(axis=1)
        scale = np.abs(track).max(axis=0)
        small = np.abs(change.T / scale).max(axis=0)
        done = good & (small < CONVERGED)
        _enter(found, places, active, done, state, slope, track, number, some)
        keep = good & ~done & (small < FARTHEST)
        state[:, active] -= np.where(keep, change.T, 0.0)
        active = active[keep]
        if not len(active):
            return


def _solve(system, miss):
    """Return solutions of many small linear systems, NaN where one is singular."""
    bad = ~np.isfinite(system).all(axis=(1, 2)) | ~np.isfinite(miss).all(axis=1)
    bad |= np.abs(np.linalg.det(np.where(bad[:, None, None], 0, system))) < 1e-300
    system = np.where(bad[:, None, None], np.eye(system.shape[1]), system)
    return np.where(bad[:, None], np.nan, np.linalg.solve(system, miss[..., None])[..., 0])


def _enter(found, places, active, done, state, slope, track, number, problems):
    where = places[active[done]]
    found.state[:, where] = state[:, active[done]]
    found.converged[where] = True
    if len(where):
        found.multipliers[where] = np.linalg.eigvals(np.moveaxis(slope[:, :, done], 2, 0))
        chosen = problems.take(done)
        found.displacement[where] = largest(chosen, track[:, :, done], number, 0)
        if problems.link is not None:
            found.relative[where] = np.abs(track[:, 2, done]).max(axis=0)


def period_map(problems: Problems, state, number, periods):
    """Return the states after some forcing periods, their derivative, and the states on the way.

    Parameters
    ----------
    problems : Problems
    state : numpy.ndarray, shape (size, n)
        States at W T = 0.
    number : int
        Steps in a forcing period.
    periods : int

    Returns
    -------
    tuple of numpy.ndarray
        Shapes (size, n), (size, size, n) and (periods number + 1, size, n).
    """
    size = problems.size
    variation = np.repeat(np.eye(size)[:, :, None], state.shape[1], axis=2)
    track = [state]
    for place in range(periods * number):
        state, variation = step(problems, state, variation, place / number, 1 / number)
        track.append(state)
    return state, variation, np.array(track)


def largest(problems, track, number, component):
    """Return the largest modulus of a displacement along an orbit.

    Between two samples the displacement is the polynomial of degree 5 with their displacements,
    velocities and accelerations.

    Parameters
    ----------
    problems : Problems
    track : numpy.ndarray, shape (m, size, n)
        States from W T = 0 on.
    number : int
        Steps in a forcing period.
    component : int
        Index of the displacement in a state.
    """
    columns = np.arange(track.shape[2])
    place = np.abs(track[:, component]).argmax(axis=0)
    outward = track[place, component, columns] * track[place, component + 1, columns] > 0
    # the last state of an orbit is the first
    first = np.where(outward, place, place - 1) % (len(track) - 1)
    h = 2 * np.pi / (number * problems.frequency)
    ends = []
    for index in (first, first + 1):
        state = track[index, :, columns].T
        force = problems.force * np.cos(2 * np.pi * index / number)
        change = rate(problems, secants(problems, state), force, state)
        ends.append([state[component], h * state[component + 1], h**2 * change[component + 1]])
    return _peak(*ends)


def _peak(begin, end):
    """Return the largest modulus of the polynomial of degree 5 with given ends, on [0, 1]."""
    (x, v, a), (x1, v1, a1) = begin, end
    rise, speed, bend = x1 - x - v - a / 2, v1 - v - a, a1 - a
    c3 = 10 * rise - 4 * speed + bend / 2
    c4 = -15 * rise + 7 * speed - bend
    c5 = 6 * rise - 3 * speed + bend / 2
    t = np.clip(v / (v - v1), 0, 1)
    for _ in range(4):
        slope = v + t * (a + t * (3 * c3 + t * (4 * c4 + t * 5 * c5)))
        curve = a + t * (6 * c3 + t * (12 * c4 + t * 20 * c5))
        t = np.clip(t - slope / curve, 0, 1)
    inner = x + t * (v + t * (a / 2 + t * (c3 + t * (c4 + t * c5))))
    return np.fmax(np.fmax(np.abs(x), np.abs(x1)), np.abs(inner))
