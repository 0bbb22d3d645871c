"""Find periodic orbits of a machine with an absorber by Newton's method, with their multipliers."""

from typing import NamedTuple

import numpy as np

from impact_damper.design.absorber_problems import COARSE, FINE, active_size, steps_for
from impact_damper.design.smooth_runs import SIZE, run

# Newton's method runs with coarse and then with fine integration steps. A correction is compared
# with the largest components of the state along the orbit. The method ends after a correction below
# LAST times these components. It fails after a correction above FARTHEST times these components, or
# after CORRECTIONS corrections.
LAST = {COARSE: 1e-3, FINE: 1e-6}
CORRECTIONS = {COARSE: 10, FINE: 4}
FARTHEST = 10.0
# Largest relative distance of a converged state from the state a period later.
CLOSED = 1e-9
# Two orbits are the same if their states differ by less than SAME times their largest components.
SAME = 1e-5


class Orbits(NamedTuple):
    """Periodic orbits.

    Attributes
    ----------
    problem : numpy.ndarray of int, shape (n,)
        Index of the problem (a row of parameters, see `problems`) of each orbit.
    period : numpy.ndarray of int, shape (n,)
        Period in forcing cycles.
    state : numpy.ndarray, shape (n, SIZE)
        State at T = 0.
    converged : numpy.ndarray of bool, shape (n,)
        Whether the orbit closes after its period.
    multipliers : numpy.ndarray of complex, shape (n, SIZE)
        Floquet multipliers over the period. Without an absorber two of them are 0. NaN if Newton's
        method has not converged.
    largest : numpy.ndarray, shape (n, SIZE)
        Largest modulus of each component of the state along the orbit. For displacements the value
        is exact, for velocities it is the largest of samples. NaN if Newton's method has not
        converged.
    """

    problem: np.ndarray
    period: np.ndarray
    state: np.ndarray
    converged: np.ndarray
    multipliers: np.ndarray
    largest: np.ndarray

    @property
    def stable(self):
        """Mask of the converged orbits whose multipliers are all below 1 in modulus."""
        with np.errstate(invalid="ignore"):
            return self.converged & (np.abs(self.multipliers).max(axis=1) < 1)

    def take(self, chosen) -> "Orbits":
        """Return the orbits that `chosen`, an array of indices or a mask, selects."""
        return Orbits(*(each[chosen] for each in self))

    def joined(self, more) -> "Orbits":
        """Return these orbits followed by `more` orbits."""
        return Orbits(*(np.concatenate(pair) for pair in zip(self, more, strict=True)))

    def distinct(self) -> "Orbits":
        """Return the orbits without those that repeat an earlier orbit of the same problem."""
        order = np.argsort(self.problem, kind="stable")
        problem, state, largest = self.problem[order], self.state[order], self.largest[order]
        again = np.zeros(len(order), bool)
        for lag in range(1, np.bincount(problem).max(initial=1)):
            apart = np.abs(state[lag:] - state[:-lag]) > SAME * largest[lag:]
            again[lag:] |= (problem[lag:] == problem[:-lag]) & ~apart.any(axis=1)
        return self.take(np.sort(order[~again]))


def find_orbits(problems, index, guesses, period=1) -> Orbits:
    """Return the orbits that Newton's method finds from guesses of their states.

    Parameters
    ----------
    problems : numpy.ndarray, shape (m, COUNT)
    index : numpy.ndarray of int, shape (n,)
        Problem of each guess.
    guesses : numpy.ndarray, shape (n, SIZE)
        States at T = 0.
    period : int
        Period of the orbits in forcing cycles.
    """
    problems, state, active = problems[index], guesses.copy(), np.arange(len(guesses))
    with np.errstate(all="ignore"):
        for longest in (COARSE, FINE):
            steps = steps_for(problems, guesses, longest)
            active = _corrected(problems, state, active, steps, period, longest)
        miss, slopes, largest = _period_map(problems[active], state[active], steps[active], period)
        closed = (np.abs(miss) / largest).max(axis=1) < CLOSED
    active = active[closed]
    multipliers = np.full(state.shape, np.nan, complex)
    size = active_size(problems)
    multipliers[active, :size] = np.linalg.eigvals(slopes[closed, :size, :size])
    multipliers[active, size:] = 0.0
    sizes = np.full(state.shape, np.nan)
    sizes[active] = largest[closed]
    converged = np.zeros(len(state), bool)
    converged[active] = True
    return Orbits(index, np.full(len(state), period), state, converged, multipliers, sizes)


def _corrected(problems, state, active, steps, period, longest):
    """Apply Newton's method to states in place; return the indices of the converged states."""
    ended, size = [], active_size(problems)
    for _ in range(CORRECTIONS[longest]):
        miss, slopes, largest = _period_map(problems[active], state[active], steps[active], period)
        change = _solutions(slopes[:, :size, :size] - np.eye(size), miss[:, :size])
        relative = (np.abs(change) / largest[:, :size]).max(axis=1)
        near = relative < FARTHEST
        state[active[near], :size] -= change[near]
        if size < SIZE:
            state[active, size:] = state[active, :size]
        ended.append(active[relative < LAST[longest]])
        active = active[near & (relative >= LAST[longest])]
        if not len(active):
            break
    return np.sort(np.concatenate(ended))


def _period_map(problems, state, steps, period):
    """Return the change of states over a period, a derivative, and the largest components.

    The state after the period is differentiated with respect to the first state.
    """
    after, largest = state.copy(), np.empty_like(state)
    slopes = np.empty((len(state), SIZE, SIZE))
    run(problems, after, steps, period, slopes, largest)
    return after - state, slopes.transpose(0, 2, 1), largest


def _solutions(system, right):
    """Return solutions of many small linear systems, NaN where one is singular or not finite."""
    bad = ~(np.isfinite(system).all(axis=(1, 2)) & np.isfinite(right).all(axis=1))
    bad |= ~(np.abs(np.linalg.det(np.where(bad[:, None, None], 0.0, system))) > 0)
    system = np.where(bad[:, None, None], np.eye(system.shape[1]), system)
    return np.where(bad[:, None], np.nan, np.linalg.solve(system, right[..., None])[..., 0])
