"""The quiet orbit, stable or not, over a grid of parameters.

It has the period of the forcing, touches each wall once a period, and is its own mirror
image half a period on: a fixed point of the map over half a period with a change of sign, the
root of the map over a period. The multipliers of the root tell what destabilises it: 1 is a
fold, -1 the loss of symmetry, and a conjugate pair of modulus 1 a Neimark-Sacker bifurcation.
Those of a period are their squares, so a period doubling would need a pair at i and -i.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.orbits.shooting import STROBE, Orbit, shoot
from impact_damper.system import packed

CONTACTS = 2
SYMMETRIC = 1e-6
# Phase W T of the states: contacts lie from about -0.2 to pi/2, and half a period on.
PHASE = 0.75 * np.pi
ITERATIONS = 10
# A step of following that takes an orbit further from its guess fails; steps that fail are
# halved down to this share of a cell.
REACH = 0.05
SHORTEST = 2.0**-12
# It is a fold that ends a row if its law foretells one within so many shortest steps.
NEAR = 4
NEIGHBOURS = ((0, -1), (0, 1), (-1, 0), (1, 0))


class QuietOrbits(NamedTuple):
    """Quiet orbits over a grid of rows and columns; NaN where there is none.

    Attributes
    ----------
    multiplier : numpy.ndarray of complex, shape (rows, columns)
        Multiplier of the root of largest modulus, its imaginary part not negative.
    displacement, harmonic : numpy.ndarray, shape (rows, columns)
        Largest |Z1|, and amplitude of its first harmonic.
    end : numpy.ndarray, shape (rows, 2)
        Where the orbits of a row begin and end, in columns.
    end_event : numpy.ndarray, shape (rows, 2)
        Flag `quiet_end_event`.
    """

    multiplier: np.ndarray
    displacement: np.ndarray
    harmonic: np.ndarray
    end: np.ndarray
    end_event: np.ndarray


def straight_flight_end(clearance, restitution) -> float:
    """Forcing frequency at which the quiet orbit folds, for rigid walls at high frequency.

    There the loose mass flies straight, and the equations of `straight_flight_ratio` give
    W^2 d0 = k sin(s) - cos(s) with k = (pi/2) (1 + e)/(1 - e), whatever rm. That has no
    solution s, the phase of the impacts, beyond W^2 d0 = sqrt(1 + k^2): with e < 1 the
    forcing cannot make good any more what impacts take. Infinite for e = 1.

    Parameters
    ----------
    clearance, restitution : float
        d0 and e.
    """
    if restitution == 1:
        return np.inf
    work = np.pi / 2 * (1 + restitution) / (1 - restitution)
    return float(np.sqrt(np.hypot(1, work) / clearance))


def is_symmetric_pair(records):
    """True where a motion of period 1 has two contacts a period and is its own mirror image."""
    two = (records["contacts"] == CONTACTS) & (records["period"] == 1)
    return two & (records["asymmetry"] < SYMMETRIC)


def quiet_orbits(parameters, states) -> QuietOrbits:
    """Quiet orbits in the cells of a grid, followed from those that are known.

    They are followed from each cell to its neighbours until no further cell is reached, by
    Newton's method from a linear guess, in steps that are halved where it fails.

    Parameters
    ----------
    parameters : array, shape (rows, columns, packed.COUNT)
        Packed parameters of the cells; along a row the frequency changes alone.
    states : array, shape (rows, columns, 4)
        States of known orbits at W T = pi/2, NaN where none is known.

    Returns
    -------
    QuietOrbits

    Raises
    ------
    ValueError
        If the arrays are not of these shapes.
    """
    if parameters.shape[2:] != (packed.COUNT,) or states.shape != (*parameters.shape[:2], 4):
        raise ValueError(
            f"parameters and states: must be of shapes (n, m, {packed.COUNT}) and (n, m, 4), "
            f"{parameters.shape} and {states.shape} given"
        )
    rows, columns = states.shape[:2]
    grid = _Grid(parameters)
    for cell in zip(*np.nonzero(np.isfinite(states[..., 0])), strict=True):
        grid.begin(cell, states[cell])
    grid.spread()
    ends, events = zip(*map(grid.row_ends, range(rows)), strict=True)
    multiplier = np.full((rows, columns), complex(np.nan, np.nan))
    displacement, harmonic = np.full((2, rows, columns), np.nan)
    for cell, orbit in grid.orbits.items():
        multiplier[cell] = _dominant(orbit)
        displacement[cell] = orbit.record["maximum_displacement"]
        harmonic[cell] = abs(orbit.record["harmonic_displacement"])
    return QuietOrbits(multiplier, displacement, harmonic, np.array(ends), np.array(events))


def land(p, guess):
    """Newton's method onto the quiet orbit near a guess of its state at W T = 3 pi/4.

    Returns
    -------
    Orbit
        The last one tried.
    str
        What hinders it: "" if nothing, not_converged or contacts_change.
    """
    state = guess
    for _ in range(ITERATIONS):
        orbit, end = shoot(p, state, 1, PHASE, symmetric=True)
        if orbit.converged:
            return orbit, "" if orbit.record["contacts"] == CONTACTS else "contacts_change"
        try:
            state = state + np.linalg.solve(np.eye(4) - orbit.root, end - state)
        except np.linalg.LinAlgError:
            break
        if not np.max(np.abs(state - guess)) < REACH:
            break
    return orbit, "not_converged"


def _dominant(orbit):
    values = np.linalg.eigvals(orbit.root)
    value = values[np.argmax(np.abs(values))]
    return complex(value.real, abs(value.imag))


class _Walk(NamedTuple):
    """The last two orbits on the way to a neighbour, at shares of it; what stopped it, if so."""

    shares: tuple
    orbits: tuple
    event: str

    def fold(self):
        """Share at which it ended, and the event: a fold if its law foretells one just there.

        Towards a fold, det(1 - root) falls as the root of the distance from it.
        """
        before, share = self.shares
        gaps = [np.linalg.det(np.eye(4) - each.root) ** 2 for each in self.orbits]
        if gaps[1] < gaps[0]:
            ahead = (share - before) * gaps[1] / (gaps[0] - gaps[1])
            if ahead < NEAR * SHORTEST:
                return share + ahead, "fold"
        return share, self.event


class _Grid:
    """The orbits found so far, by cell."""

    def __init__(self, parameters):
        self.parameters = parameters
        self.orbits: dict[tuple, Orbit] = {}

    def begin(self, cell, state):
        """Take a cell's orbit from its state at W T = pi/2, if it is the quiet one."""
        p = self.parameters[cell]
        motion, _ = shoot(p, state, 1, STROBE)
        orbit, event = land(p, motion.at(PHASE))
        if event == "":
            self.orbits[cell] = orbit

    def spread(self):
        """Follow orbits into the cells beside them, those nearest to known ones first."""
        front = list(self.orbits)
        while front:
            reached = []
            for cell in front:
                for direction in NEIGHBOURS:
                    target = self.beside(cell, direction)
                    if target is None or target in self.orbits:
                        continue
                    walk = self.follow(cell, direction)
                    if walk.event == "":
                        self.orbits[target] = walk.orbits[1]
                        reached.append(target)
            front = reached

    def beside(self, cell, direction):
        """The neighbour of a cell, or None beyond the grid."""
        row, column = cell[0] + direction[0], cell[1] + direction[1]
        rows, columns = self.parameters.shape[:2]
        return (row, column) if 0 <= row < rows and 0 <= column < columns else None

    def follow(self, cell, direction):
        """Follow the orbit of a cell to a neighbour; the one behind foretells its change."""
        first, last = self.parameters[cell], self.parameters[self.beside(cell, direction)]
        behind = self.orbits.get(self.beside(cell, (-direction[0], -direction[1])))
        share, orbit = 0.0, self.orbits[cell]
        slope = np.zeros(4) if behind is None else orbit.state - behind.state
        before, step, event = (share, orbit), 1.0, ""
        while share < 1 and step >= SHORTEST:
            step = min(step, 1 - share)
            p = (1 - share - step) * first + (share + step) * last
            trial, event = land(p, orbit.state + step * slope)
            if event == "":
                before = share, orbit
                slope = (trial.state - orbit.state) / step
                share, orbit = share + step, trial
                step *= 2
            else:
                step /= 2
        return _Walk((before[0], share), (before[1], orbit), event)

    def row_ends(self, row):
        """Columns, in parts of one, at which the orbits of a row end, and what ends them."""
        columns = [column for first, column in self.orbits if first == row]
        if not columns:
            return [np.nan] * 2, [flag("quiet_end_event", "no_orbit")] * 2
        places, events = [], []
        for column, turn in ((min(columns), -1), (max(columns), 1)):
            share, event = 0.0, "map_ends"
            if self.beside((row, column), (0, turn)) is not None:
                share, event = self.follow((row, column), (0, turn)).fold()
            places.append(column + turn * share)
            events.append(flag("quiet_end_event", event))
        return places, events
