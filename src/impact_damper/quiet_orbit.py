"""The quiet orbit, stable or not, over a grid of parameters.

It has the period of the forcing, touches each wall once a period, and is its own mirror
image half a period on. The map over half a period with a change of sign, whose square is
the map over a period, therefore has it as a fixed point. The multipliers of that map, called
half-period multipliers here, tell what destabilises the orbit: 1 is a fold, -1 the loss of
symmetry, and a conjugate pair of modulus 1 a Neimark-Sacker bifurcation. Those of a period
are their squares, so a period doubling would need a pair at i and -i.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.datasets import flag
from impact_damper.kernel import advance, side_of, workspace
from impact_damper.orbits import POLISH_TOLERANCE
from impact_damper.shooting import TURN, find_orbit

CONTACTS = 2
SYMMETRIC = 1e-6
# Phase W T of the states: contacts lie from about -0.2 to pi/2, and half a period on.
PHASE = 0.75 * np.pi
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
    state : numpy.ndarray, shape (rows, columns, 4)
        Z1, Z1', Z2, Z2' at W T = 3 pi/4.
    multiplier : numpy.ndarray of complex, shape (rows, columns)
        Half-period multiplier of largest modulus, its imaginary part not negative.
    displacement, harmonic : numpy.ndarray, shape (rows, columns)
        Largest |Z1|, and amplitude of its first harmonic.
    end : numpy.ndarray, shape (rows, 2)
        Where the orbits of a row begin and end, in columns.
    end_event : numpy.ndarray, shape (rows, 2)
        Flag `quiet_end_event`.
    """

    state: np.ndarray
    multiplier: np.ndarray
    displacement: np.ndarray
    harmonic: np.ndarray
    end: np.ndarray
    end_event: np.ndarray


def half_multipliers(p, state) -> np.ndarray:
    """Half-period multipliers of the symmetric orbit through a state at W T = 3 pi/4.

    By descending modulus, of a pair that with positive imaginary part first.
    """
    tangents = np.eye(4)
    begin, end = PHASE / p[0], (PHASE + np.pi) / p[0]
    side = side_of(p, state)
    advance(p, state.copy(), tangents, side, begin, end, POLISH_TOLERANCE, workspace())
    values = np.linalg.eigvals(-tangents).astype(complex)
    return values[np.lexsort((-values.imag, -np.abs(values)))]


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
    parameters : array, shape (rows, columns, 7)
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
    if parameters.shape[2:] != (7,) or states.shape != (*parameters.shape[:2], 4):
        raise ValueError(
            f"parameters and states: must be of shapes (n, m, 7) and (n, m, 4), "
            f"{parameters.shape} and {states.shape} given"
        )
    rows, columns = states.shape[:2]
    grid = _Grid(parameters)
    for cell in zip(*np.nonzero(np.isfinite(states[..., 0])), strict=True):
        grid.begin(cell, states[cell])
    grid.spread()
    ends = [grid.row_ends(row) for row in range(rows)]
    found = QuietOrbits(
        grid.states,
        np.full((rows, columns), complex(np.nan, np.nan)),
        *np.full((2, rows, columns), np.nan),
        *(np.array(each) for each in zip(*ends, strict=True)),
    )
    for cell, record in grid.records.items():
        found.multiplier[cell] = half_multipliers(parameters[cell], grid.states[cell])[0]
        found.displacement[cell] = record["maximum_displacement"]
        found.harmonic[cell] = abs(record["harmonic_displacement"])
    return found


class _Walk(NamedTuple):
    """The last two orbits on the way to a neighbour, at shares of it; what stopped it, if so."""

    shares: tuple
    states: tuple
    record: np.void | None
    event: str


class _Grid:
    """The orbits found so far: states at `PHASE`, and records by cell."""

    def __init__(self, parameters):
        self.parameters = parameters
        self.states = np.full((*parameters.shape[:2], 4), np.nan)
        self.records = {}

    def begin(self, cell, state):
        """Take a cell's orbit from its state at W T = pi/2; one that is not quiet is left out."""
        p = self.parameters[cell]
        orbit = find_orbit(p, state)
        if orbit.converged:
            state, record, event = _land(p, _state(orbit))
            if event == "":
                self.states[cell], self.records[cell] = state, record

    def spread(self):
        """Follow orbits into the cells beside them, those nearest to known ones first."""
        front = list(self.records)
        while front:
            reached = []
            for cell in front:
                for direction in NEIGHBOURS:
                    target = self.beside(cell, direction)
                    if target is None or target in self.records:
                        continue
                    walk = self.follow(cell, direction)
                    if walk.event == "":
                        self.states[target], self.records[target] = walk.states[1], walk.record
                        reached.append(target)
            front = reached

    def beside(self, cell, direction):
        """The neighbour of a cell, or None beyond the grid."""
        row, column = cell[0] + direction[0], cell[1] + direction[1]
        rows, columns = self.states.shape[:2]
        return (row, column) if 0 <= row < rows and 0 <= column < columns else None

    def follow(self, cell, direction):
        """Follow the orbit of a cell to a neighbour; the one behind foretells its change."""
        behind = self.beside(cell, (-direction[0], -direction[1]))
        way = self.parameters[cell], self.parameters[self.beside(cell, direction)]
        share, state, record = 0.0, self.states[cell], None
        slope = state - self.states[behind] if behind in self.records else np.zeros(4)
        before, step, event = (share, state), 1.0, ""
        while share < 1 and step >= SHORTEST:
            step = min(step, 1 - share)
            trial, record, event = _land(_between(*way, share + step), state + step * slope)
            if event == "":
                before = share, state
                slope = (trial - state) / step
                share, state = share + step, trial
                step *= 2
            else:
                step /= 2
        return _Walk((before[0], share), (before[1], state), record, event)

    def row_ends(self, row):
        """Columns, in parts of one, at which the orbits of a row end, and what ends them."""
        columns = np.flatnonzero(np.isfinite(self.states[row, :, 0]))
        if len(columns) == 0:
            return [np.nan] * 2, [flag("quiet_end_event", "no_orbit")] * 2
        places, events = [], []
        for column, turn in ((columns[0], -1), (columns[-1], 1)):
            share, event = 0.0, "map_ends"
            if self.beside((row, column), (0, turn)) is not None:
                walk = self.follow((row, column), (0, turn))
                share, event = _fold(walk, *self.parameters[row, [column, column + turn]])
            places.append(column + turn * share)
            events.append(flag("quiet_end_event", event))
        return places, events


def _between(first, last, share):
    """Parameters a share of the way from one cell to another, exact at both."""
    return (1 - share) * first + share * last


def _state(orbit):
    """State of an orbit at `PHASE`."""
    return orbit.at(PHASE if orbit.phase <= PHASE else PHASE + TURN)


def _land(p, guess):
    """State and record of the quiet orbit near a guess at `PHASE`, and what hinders it, or ""."""
    orbit = find_orbit(p, guess, 1, PHASE)
    if not orbit.converged:
        return guess, None, "not_converged"
    state = _state(orbit)
    if not np.max(np.abs(state - guess)) < REACH:
        return guess, None, "not_converged"
    if orbit.record["contacts"] != CONTACTS:
        return guess, None, "contacts_change"
    if not orbit.record["asymmetry"] < SYMMETRIC:
        return guess, None, "not_symmetric"
    return state, orbit.record, ""


def _fold(walk, first, last):
    """The share at which a walk ended, and the event: a fold if its law foretells one just there.

    Towards a fold the square of the distance of a multiplier from 1 falls linearly to zero.
    """
    gaps = [
        np.min(np.abs(half_multipliers(_between(first, last, share), state) - 1)) ** 2
        for share, state in zip(walk.shares, walk.states, strict=True)
    ]
    before, share = walk.shares
    if gaps[1] < gaps[0]:
        ahead = (share - before) * gaps[1] / (gaps[0] - gaps[1])
        if ahead < NEAR * SHORTEST:
            return share + ahead, "fold"
    return share, walk.event
