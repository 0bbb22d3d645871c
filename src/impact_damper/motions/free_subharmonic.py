"""The one-third subharmonic of the free oscillator: a symmetric motion of period 3."""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.motions import records, strobe_map
from impact_damper.motions.catalogue import SAME
from impact_damper.motions.following import record_at
from impact_damper.motions.start_states import search_starts
from impact_damper.motions.sweep import sweep
from impact_damper.system import packed
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.system.settling import check_settling

# Number of frequencies at which the subharmonic is looked for.
SEARCHED = 81


class FreeSubharmonic(NamedTuple):
    """The free one-third subharmonic.

    Attributes
    ----------
    parameters, states : numpy.ndarray, shapes (n, packed.COUNT) and (n, 4)
        Packed parameters at the frequencies where the motion was found, and its states at these
        frequencies at the phase W T = pi/2 of the forcing; empty if it was not found.
    ends : numpy.ndarray, shape (2,)
        Frequencies between which the motion exists, NaN if it was not found.
    events : numpy.ndarray, shape (2,)
        Events at these ends, flags of `free_subharmonic_event`.
    """

    parameters: np.ndarray
    states: np.ndarray
    ends: np.ndarray
    events: np.ndarray

    @property
    def found(self):
        """Whether there is a subharmonic."""
        return len(self.states) > 0

    def at(self, frequency):
        """Return a `records.MOTION` at a frequency, or None where the motion does not exist."""
        if not self.ends[0] <= frequency <= self.ends[1]:
            return None
        k = np.argmin(np.abs(self.parameters[:, FREQUENCY] - frequency))
        return record_at(self.parameters[k], self.states[k], 3, FREQUENCY, frequency)


def free_subharmonic(
    oscillator, first, last, *, starts=96, radius=None, seed=1995, settling=None, workers=1
) -> FreeSubharmonic:
    """Find the symmetric motion of period 3 of the free oscillator between two frequencies.

    Parameters
    ----------
    oscillator : Oscillator
    first, last : float
        Frequencies W.
    starts, radius, seed, settling, workers
        As in `stages.response.frequency_response`.

    Returns
    -------
    FreeSubharmonic
        If there are several branches, the one found at most frequencies.
    """
    frequencies = np.linspace(first, last, SEARCHED)
    parameters = np.array([pack(oscillator, None, value) for value in frequencies])
    settling = check_settling(settling)
    systems = [(None, value) for value in frequencies]
    search = search_starts(oscillator, systems, starts, radius, seed, settling)
    data = sweep(
        parameters,
        FREQUENCY,
        "frequency",
        search,
        settling,
        workers=workers,
    )
    chosen = is_subharmonic(data) & (data["period"][1] == 3) & (data["asymmetry"][1] < SAME)
    branches, counts = np.unique(data["branch"][1][chosen], return_counts=True)
    if len(branches) == 0:
        events = np.full(2, flag("free_subharmonic_event", "not_found"))
        none = np.empty((0, packed.COUNT)), np.empty((0, 4))
        return FreeSubharmonic(*none, np.full(2, np.nan), events)
    branch = branches[np.argmax(counts)]
    row, column = np.nonzero(chosen & (data["branch"][1] == branch))
    ends, events = branch_ends(data, branch, frequencies, row)
    return FreeSubharmonic(parameters[row], data["state"][1][row, column], ends, events)


def switched_on(oscillator, p, state, loose, generator):
    """Return states after the damper was switched on at random times during the subharmonic.

    Parameters
    ----------
    oscillator : Oscillator
    p : array, shape (packed.COUNT,)
        Packed parameters with the damper.
    state : array, shape (4,)
        State of the free subharmonic at W T = pi/2.
    loose : array, shape (m, 4)
        Z2 and Z2' at the switching, in the last two columns; every second Z2' is replaced by 0.
    generator : numpy.random.Generator

    Returns
    -------
    numpy.ndarray, shape (m, 4)
        States at the beginning of the next forcing period.
    """
    period = 2 * np.pi / p[FREQUENCY]
    begin = strobe_map.strobe_time(p)
    times = begin + np.sort(generator.random(len(loose))) * 3 * period
    states, log = np.empty((len(loose), 4)), np.empty((0, 5))
    free = pack(oscillator, None, p[FREQUENCY])
    records.trace(free, state.copy(), begin, times, strobe_map.POLISH_TOLERANCE, states, log)
    states[:, 2:] = loose[:, 2:]
    states[::2, 3] = 0.0
    for time, y in zip(times, states, strict=True):
        until = np.array([np.ceil(time / period) * period])
        records.trace(p, y, time, until, strobe_map.POLISH_TOLERANCE, np.empty((1, 4)), log)
    return states


def is_subharmonic(data):
    """Return where motions have settled with a period that is a multiple of 3."""
    return (data["outcome"][1] == flag("outcome", "settled")) & (data["period"][1] % 3 == 0)


def branch_ends(data, branch, grid, rows):
    """Return both ends of a branch in the swept parameter, and flags of their events.

    Parameters
    ----------
    data : dict
        As from `sweep`.
    branch : int
    grid : array
        Values of the swept parameter.
    rows : array of int
        Rows of the grid at which the branch was found.

    Returns
    -------
    ends, events : numpy.ndarray, shape (2,)
        An end that was not located is the last point of the grid with the branch; its event is
        sweep_ends if this is the end of the grid, else not_found.
    """
    ends = grid[[min(rows), max(rows)]]
    events = np.full(2, flag("free_subharmonic_event", "not_found"))
    for side, (row, step, turn) in enumerate(((min(rows), -1, "down"), (max(rows), 1, "up"))):
        if not 0 <= row + step < len(grid):
            events[side] = flag("free_subharmonic_event", "sweep_ends")
            continue
        value = data["end_value"]
        away = step * (value - grid[row])
        fits = (
            (data["end_branch"] == branch)
            & (away >= 0)
            & (data["end_direction"] == flag("end_direction", turn))
            & (away <= abs(grid[row + step] - grid[row]))
        )
        if fits.any():
            last = np.argmax(np.where(fits, away, -1.0))
            ends[side], events[side] = value[last], data["end_event"][last]
    return ends, events
