"""The one-third subharmonic of the free oscillator (without damper), which has period 3.

The motion is symmetric: half a period later it is its own mirror image.

Z2 is the displacement of the primary mass relative to the loose mass, W the forcing frequency, and
T the time.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.model import packed
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.settling import check_settling
from impact_damper.motions import strobe_map, traces
from impact_damper.motions.following import record_at
from impact_damper.motions.start_states import search_starts
from impact_damper.motions.sweep import SAME, sweep

# Number of frequencies at which the subharmonic is searched for.
SEARCHED = 81


class FreeSubharmonic(NamedTuple):
    """The free one-third subharmonic.

    Attributes
    ----------
    parameters, states : numpy.ndarray, shapes (n, packed.COUNT) and (n, 4)
        Packed parameters at the frequencies at which the motion was found, and states of the motion
        at these frequencies at the phase W T = pi/2. Both are empty if no motion was found.
    ends : numpy.ndarray, shape (2,)
        Lowest and highest frequency of the motion, NaN if no motion was found.
    events : numpy.ndarray, shape (2,)
        Events at the two ends, flags of `free_subharmonic_event`.
    """

    parameters: np.ndarray
    states: np.ndarray
    ends: np.ndarray
    events: np.ndarray

    @property
    def found(self):
        """True if there is a subharmonic."""
        return len(self.states) > 0

    def at(self, frequency):
        """Return the `records.MOTION` at a frequency, or None beyond the ends of the branch."""
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
        If there are several branches, the branch that was found at the largest number of
        frequencies.
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
    """Return states of motions in which the damper is switched on during the free subharmonic.

    The damper is switched on at random times.

    Parameters
    ----------
    oscillator : Oscillator
    p : array, shape (packed.COUNT,)
        Packed parameters with the damper.
    state : array, shape (4,)
        State of the free subharmonic at W T = pi/2.
    loose : array, shape (m, 4)
        The last two columns are Z2 and Z2' at the switching. In every second row Z2' is replaced by
        0, so that the loose mass moves with the primary mass.
    generator : numpy.random.Generator

    Returns
    -------
    numpy.ndarray, shape (m, 4)
        States at the beginning of the forcing cycle after the switching.
    """
    period = 2 * np.pi / p[FREQUENCY]
    begin = strobe_map.strobe_time(p)
    times = begin + np.sort(generator.random(len(loose))) * 3 * period
    states, log = np.empty((len(loose), 4)), np.empty((0, 5))
    free = pack(oscillator, None, p[FREQUENCY])
    traces.trace(free, state.copy(), begin, times, strobe_map.POLISH_TOLERANCE, states, log)
    states[:, 2:] = loose[:, 2:]
    states[::2, 3] = 0.0
    for time, y in zip(times, states, strict=True):
        until = np.array([np.ceil(time / period) * period])
        traces.trace(p, y, time, until, strobe_map.POLISH_TOLERANCE, np.empty((1, 4)), log)
    return states


def is_subharmonic(data):
    """Return the mask of the settled motions whose period is a multiple of 3."""
    return (data["outcome"][1] == flag("outcome", "settled")) & (data["period"][1] % 3 == 0)


def branch_ends(data, branch, grid, rows):
    """Return both ends of a branch in the swept parameter, and flags of their events.

    Parameters
    ----------
    data : dict
        Result of `sweep.sweep`.
    branch : int
    grid : array
        Values of the swept parameter.
    rows : array of int
        Rows of the grid at which the branch was found.

    Returns
    -------
    ends, events : numpy.ndarray, shape (2,)
        If an end was not located, the value is the last point of the grid on the branch. The event
        is then sweep_ends if this point is the end of the grid, otherwise not_found.
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
