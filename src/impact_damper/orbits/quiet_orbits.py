"""The quiet orbit, stable or not, on a grid of parameters.

The quiet orbit has the period of the forcing, touches each wall once a period, and is its own
mirror image half a period later. It is therefore a fixed point of the map over half a period with
a change of sign, the root of the map over a period. The multipliers of the root say how the orbit
becomes unstable: a multiplier 1 is a fold, -1 the loss of symmetry, and a conjugate pair of
modulus 1 a Neimark-Sacker bifurcation. The multipliers of a period are their squares, so a period
doubling would need a pair at i and -i.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.orbits.compliant_orbits import CONTACTS, SYMMETRIC
from impact_damper.orbits.grid_following import Grid
from impact_damper.orbits.orbit import STROBE
from impact_damper.orbits.shooting import shoot
from impact_damper.system import packed

# Phase W T of the states, far from contacts. Contacts lie between about -0.2 and pi/2, and half a
# period later.
PHASE = 0.75 * np.pi
# Newton's method: number of corrections, and largest distance from the guess.
ITERATIONS = 10
REACH = 0.05
# Shortest step between cells, as a share of their distance.
SHORTEST = 2.0**-12
# A row ends at a fold if the law of a fold predicts one within this number of shortest steps.
NEAR = 4


class QuietOrbits(NamedTuple):
    """Quiet orbits on a grid of rows and columns; NaN in cells without one.

    Attributes
    ----------
    multiplier : numpy.ndarray of complex, shape (rows, columns)
        Multiplier of the root of largest modulus, its imaginary part not negative.
    displacement, harmonic : numpy.ndarray, shape (rows, columns)
        Largest |Z1|, and amplitude of the first harmonic of Z1.
    end : numpy.ndarray, shape (rows, 2)
        Least and greatest column of each row's orbits, with decimals between two columns.
    end_event : numpy.ndarray, shape (rows, 2)
        Reasons why the orbits end there, flags of `quiet_end_event`.
    """

    multiplier: np.ndarray
    displacement: np.ndarray
    harmonic: np.ndarray
    end: np.ndarray
    end_event: np.ndarray


def straight_flight_end(oscillator, clearance, restitution) -> float:
    """Return the frequency W at which the quiet orbit folds, in the limit of straight flight.

    In this limit, of rigid walls and high frequency, the equations of `straight_flight_ratio` give
    W^2 d0/f = k sin(s) - cos(s) for the phase s of the impacts, with k = (pi/2) (1 + e)/(1 - e) and
    the forcing amplitude f = F + U W^2 + V/W^2, whatever the mass ratio. There is no solution
    beyond W^2 d0/f = sqrt(1 + k^2), where the forcing no longer supplies the energy that impacts
    dissipate: a quadratic in W^2.

    Parameters
    ----------
    oscillator : Oscillator
    clearance, restitution : float
        d0 and e.

    Returns
    -------
    float
        Infinite for e = 1, and for an unbalance that supplies the energy at any frequency.
    """
    if restitution == 1:
        return np.inf
    most = np.hypot(1, np.pi / 2 * (1 + restitution) / (1 - restitution))
    left = clearance - most * oscillator.unbalance
    if left <= 0:
        return np.inf
    half = oscillator.force * most / (2 * left)
    return float(np.sqrt(half + np.hypot(half, np.sqrt(oscillator.shaker * most / left))))


def is_symmetric_pair(records):
    """Return where `records.MOTION` are symmetric motions of period 1 with two contacts."""
    two = (records["contacts"] == CONTACTS) & (records["period"] == 1)
    return two & (records["asymmetry"] < SYMMETRIC)


def follow_quiet_orbits(parameters, states) -> QuietOrbits:
    """Return the quiet orbits of a grid, followed from known ones to all cells they reach.

    Parameters
    ----------
    parameters : array, shape (rows, columns, packed.COUNT)
        Packed parameters of the cells; along a row only the frequency changes.
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
    grid = quiet_orbits(parameters, states)
    rows, columns = grid.shape
    ends, events = zip(*(_row_ends(grid, row) for row in range(rows)), strict=True)
    multiplier = np.full((rows, columns), complex(np.nan, np.nan))
    displacement, harmonic = np.full((2, rows, columns), np.nan)
    for cell, orbit in grid.orbits.items():
        multiplier[cell] = dominant_root(orbit)
        displacement[cell] = orbit.record["maximum_displacement"]
        harmonic[cell] = abs(orbit.record["harmonic_displacement"])
    return QuietOrbits(multiplier, displacement, harmonic, np.array(ends), np.array(events))


def quiet_orbits(parameters, states, *, shortest=SHORTEST) -> Grid:
    """Return the grid with the quiet orbits in the cells to which they are followed.

    Parameters and errors as of `follow_quiet_orbits`; `shortest` is the shortest step between
    cells, as a share of their distance.
    """
    if parameters.shape[2:] != (packed.COUNT,) or states.shape != (*parameters.shape[:2], 4):
        raise ValueError(
            f"parameters and states: must be of shapes (n, m, {packed.COUNT}) and (n, m, 4), "
            f"{parameters.shape} and {states.shape} given"
        )
    grid = Grid(parameters, find_quiet_orbit, shortest=shortest, axes=(1, 0), extrapolating=True)
    for cell in zip(*np.nonzero(np.isfinite(states[..., 0])), strict=True):
        at_strobe, _ = shoot(parameters[cell], states[cell], 1, STROBE)
        orbit, _ = find_quiet_orbit(parameters[cell], at_strobe.at(PHASE))
        if orbit is not None:
            grid.put(cell, orbit)
    grid.spread()
    return grid


def find_quiet_orbit(p, guess):
    """Find the quiet orbit near a guess of its state at W T = 3 pi/4 by Newton's method.

    Parameters
    ----------
    p : array, shape (COUNT,)
        Packed parameters.
    guess : array, shape (4,)

    Returns
    -------
    orbit : Orbit or None
    status : str
        "found", "not_converged" or "contacts_change".
    """
    state = guess
    for _ in range(ITERATIONS):
        orbit, end = shoot(p, state, 1, PHASE, symmetric=True)
        if orbit.converged:
            if orbit.record["contacts"] != CONTACTS:
                return None, "contacts_change"
            return orbit, "found"
        try:
            state = state + np.linalg.solve(np.eye(4) - orbit.root, end - state)
        except np.linalg.LinAlgError:
            break
        if not np.max(np.abs(state - guess)) < REACH:
            break
    return None, "not_converged"


def dominant_root(orbit):
    """Return the multiplier of the root of largest modulus, its imaginary part not negative."""
    values = np.linalg.eigvals(orbit.root)
    value = values[np.argmax(np.abs(values))]
    return complex(value.real, abs(value.imag))


def _row_ends(grid, row):
    """Return where the orbits of a row end, as columns with decimals, and flags of the reasons."""
    columns = [column for first, column in grid.orbits if first == row]
    if not columns:
        return [np.nan] * 2, [flag("quiet_end_event", "no_orbit")] * 2
    places, events = [], []
    for column, turn in ((min(columns), -1), (max(columns), 1)):
        share, event = 0.0, "map_ends"
        if grid.beside((row, column), (0, turn)) is not None:
            share, event = _end(grid.follow((row, column), (0, turn)))
        places.append(column + turn * share)
        events.append(flag("quiet_end_event", event))
    return places, events


def _end(followed):
    """Return the share of the way at which following ended, and the event at that place.

    Towards a fold, det(1 - root) falls with the square root of the distance from the fold. The
    event is a fold if this law, through the last two orbits, predicts one close to the last.
    """
    if followed.arrived:  # only because the cell behind was not known yet in `spread`
        return 0.0, "not_converged"
    before, share = followed.values
    gaps = [np.linalg.det(np.eye(4) - each.root) ** 2 for each in followed.orbits]
    if gaps[1] < gaps[0]:
        ahead = (share - before) * gaps[1] / (gaps[0] - gaps[1])
        if ahead < NEAR * SHORTEST:
            return share + ahead, "fold"
    return share, followed.status
