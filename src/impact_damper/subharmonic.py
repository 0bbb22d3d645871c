"""The one-third subharmonic of the free oscillator, and what a damper makes of it.

Without the damper it is a symmetric motion of period 3. With the damper every motion is
counted as one whose period is a multiple of 3.
"""

from typing import NamedTuple

import numpy as np

from impact_damper import orbits, recording
from impact_damper.datasets import dataset, flag
from impact_damper.motions import COMPONENTS, MOST_SEED, check_settling, random_states
from impact_damper.parameters import (
    check_count,
    check_damper,
    check_frequencies,
    check_starts,
    describe,
    pack,
)
from impact_damper.sweep import FREQUENCY, RESOLUTION, SAME, sweep

SEARCHED = 81
BEYOND = 0.1
REDUCED = 0.95
SWITCHED_MOTIONS = (
    "quiet",
    "other_period_1",
    "subharmonic",
    "other_period",
    "chaotic",
    "non_colliding",
    "unsettled",
)


def subharmonic_suppression(
    oscillator,
    damper,
    frequencies,
    *,
    starts=96,
    radius=2.0,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Motions with the damper wherever the free oscillator has its one-third subharmonic.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequencies : sequence of float
        Increasing frequencies W, dimensionless. The free subharmonic is sought from the first
        to the last; the damped motions are sought at as many frequencies, spread over its range
        and a tenth of the width beyond each end. Without a free subharmonic at these themselves.
    starts : int
        Starts a frequency. Where the free subharmonic exists one half is random as in
        `response.frequency_response`, and the other has the damper switched on to the
        subharmonic at a random time, the loose mass placed as in a random start, every second
        time at rest relative to the primary. Elsewhere all are random.
    radius, seed, settling, workers, progress
        As in `response.frequency_response`.

    Returns
    -------
    xarray.Dataset
        Over (frequency, motion) all motions found, as in a frequency response. Over `frequency`
        the largest displacement of the subharmonic without and with the damper (NaN where there
        is none), their ratio, contacts and period of the damped one, and a flag for what became
        of it, by all damped motions and by those that starts lead to. Over (frequency,
        switched_motion) where switching on leads. Over `edge` the ends of the free
        subharmonic, over (subharmonic, edge) those of each damped branch.

    Raises
    ------
    TypeError
        If there is no damper.
    ValueError
        If frequencies are not increasing, or a parameter is out of range.
    """
    settling = check_settling(settling)
    check_damper(damper)
    frequencies = check_frequencies(frequencies, "two")
    check_starts(starts, max(SEARCHED, len(frequencies)), least=2)
    check_count("seed", seed, least=0, most=MOST_SEED)
    free = free_subharmonic(
        oscillator,
        frequencies[0],
        frequencies[-1],
        starts=starts,
        radius=radius,
        seed=seed,
        settling=settling,
        workers=workers,
    )
    if free.found:
        margin = BEYOND * (free.ends[1] - free.ends[0])
        frequencies = np.linspace(free.ends[0] - margin, free.ends[1] + margin, len(frequencies))
    parameters = np.array([pack(oscillator, damper, value) for value in frequencies])
    states, size = _starts(oscillator, damper, parameters, free, starts, radius, seed)
    data = sweep(
        parameters, FREQUENCY, "frequency", states, settling, workers=workers, progress=progress
    )
    data |= _subharmonic_table(data, size) | _branch_table(data, frequencies)
    data |= {
        "switched_share": _shares(data, np.isfinite(size), starts // 2),
        "free_subharmonic_frequency": free.ends,
        "free_subharmonic_event": free.events,
    }
    made = describe(oscillator, damper, settling) | {
        "starts": starts,
        "radius": radius,
        "seed": seed,
    }
    coordinates = {
        "frequency": frequencies,
        "component": list(COMPONENTS),
        "edge": ["lower", "upper"],
        "switched_motion": list(SWITCHED_MOTIONS),
    }
    return dataset(data, coordinates, made, "One-third subharmonic without and with the damper")


class FreeSubharmonic(NamedTuple):
    """The free one-third subharmonic.

    Attributes
    ----------
    parameters, states : numpy.ndarray, shapes (n, 7) and (n, 4)
        It at the frequencies where it was found, at W T = pi/2; empty if it was not.
    ends : numpy.ndarray, shape (2,)
        Frequencies between which it exists, NaN if it was not found.
    events : numpy.ndarray, shape (2,)
        What ends it there, flags of `free_subharmonic_event`.
    """

    parameters: np.ndarray
    states: np.ndarray
    ends: np.ndarray
    events: np.ndarray

    @property
    def found(self):
        return len(self.states) > 0

    def at(self, frequency):
        """Record of the motion at a frequency, or None where it does not exist."""
        if not self.ends[0] <= frequency <= self.ends[1]:
            return None
        k = np.argmin(np.abs(self.parameters[:, FREQUENCY] - frequency))
        p, y = self.parameters[k].copy(), self.states[k].copy()
        orbits.follow(p, y, 3, FREQUENCY, frequency, RESOLUTION, orbits.POLISH_TOLERANCE)
        if p[FREQUENCY] != frequency:
            return None
        record = recording.measured(p, y, 3, orbits.POLISH_TOLERANCE)
        record["state"] = y
        return record


def free_subharmonic(
    oscillator, first, last, *, starts=96, radius=2.0, seed=1995, settling=None, workers=1
) -> FreeSubharmonic:
    """The symmetric motion of period 3 without a damper, sought from one frequency to another."""
    frequencies = np.linspace(first, last, SEARCHED)
    parameters = np.array([pack(oscillator, None, value) for value in frequencies])
    states = np.array(
        [random_states(starts, radius, None, [seed, i]) for i in range(len(frequencies))]
    )
    data = sweep(
        parameters, FREQUENCY, "frequency", states, check_settling(settling), workers=workers
    )
    chosen = _is_subharmonic(data) & (data["period"][1] == 3) & (data["asymmetry"][1] < SAME)
    branches, counts = np.unique(data["branch"][1][chosen], return_counts=True)
    if len(branches) == 0:
        events = np.full(2, flag("free_subharmonic_event", "not_found"))
        return FreeSubharmonic(np.empty((0, 7)), np.empty((0, 4)), np.full(2, np.nan), events)
    branch = branches[np.argmax(counts)]
    row, column = np.nonzero(chosen & (data["branch"][1] == branch))
    ends, events = _ends(data, branch, frequencies, row)
    return FreeSubharmonic(parameters[row], data["state"][1][row, column], ends, events)


def switched_on(oscillator, p, state, loose, generator):
    """States at T = 0 after the damper was switched on to the subharmonic at a random time.

    Parameters
    ----------
    oscillator : Oscillator
    p : array, shape (7,)
        Packed parameters with the damper.
    state : array, shape (4,)
        The free subharmonic at W T = pi/2.
    loose : array, shape (m, 4)
        Z2 and Z2' of the loose mass in the last two columns; every second Z2' is replaced by 0.
    generator : numpy.random.Generator

    Returns
    -------
    numpy.ndarray, shape (m, 4)
    """
    period = 2 * np.pi / p[FREQUENCY]
    begin = orbits.strobe_time(p)
    times = begin + np.sort(generator.random(len(loose))) * 3 * period
    states, log = np.empty((len(loose), 4)), np.empty((0, 5))
    free = pack(oscillator, None, p[FREQUENCY])
    recording.trace(free, state.copy(), begin, times, orbits.POLISH_TOLERANCE, states, log)
    states[:, 2:] = loose[:, 2:]
    states[::2, 3] = 0.0
    for time, y in zip(times, states, strict=True):
        until = np.array([np.ceil(time / period) * period])
        recording.trace(p, y, time, until, orbits.POLISH_TOLERANCE, np.empty((1, 4)), log)
    return states


def _starts(oscillator, damper, parameters, free, starts, radius, seed):
    """Starts (n, starts, 4), and max |Z1| (n,) of the free subharmonic or NaN."""
    states = np.array(
        [random_states(starts, radius, damper, [seed, i]) for i in range(len(parameters))]
    )
    size = np.full(len(parameters), np.nan)
    half = starts // 2
    for i, p in enumerate(parameters):
        record = free.at(p[FREQUENCY])
        if record is not None:
            size[i] = record["maximum_displacement"]
            generator = np.random.default_rng([seed, i, half])
            states[i, :half] = switched_on(
                oscillator, p, record["state"], states[i, :half], generator
            )
    return states, size


def _is_subharmonic(data):
    """True for the settled motions whose period is a multiple of 3."""
    return (data["outcome"][1] == flag("outcome", "settled")) & (data["period"][1] % 3 == 0)


def _ends(data, branch, grid, rows):
    """Both ends of a branch found at some rows of a sweep's grid, and their events.

    Where no end was located it is the last point of the grid, flagged.
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


def _subharmonic_table(data, free):
    """Largest displacement, free and damped, over frequency, and what the damper changed."""
    size = np.where(_is_subharmonic(data), data["maximum_displacement"][1], -np.inf)
    place = np.argmax(size, axis=1)
    row = np.arange(len(size))
    damped = size[row, place]
    exists = damped > 0
    reached = np.max(np.where(data["share"][1] > 0, size, -np.inf), axis=1)
    table = {"free_subharmonic": free, "subharmonic_ratio": np.where(exists, damped, 0) / free}
    for name, values in (("damped_subharmonic", damped), ("reached_subharmonic", reached)):
        table[name] = np.where(values > 0, values, np.nan)
    for name, values in (("suppression", damped), ("reached_suppression", reached)):
        table[name] = _suppression(values, free)
    table["damped_subharmonic_period"] = np.where(exists, data["period"][1][row, place], 0)
    table["damped_subharmonic_contacts"] = np.where(exists, data["contacts"][1][row, place], np.nan)
    return table


def _suppression(damped, free):
    """Flag for what the damper makes of a subharmonic, by its largest displacement."""
    meanings = np.select(
        [np.isnan(free), damped < 0, damped < REDUCED * free],
        ["no_subharmonic_without_damper", "removed", "reduced"],
        "unchanged",
    )
    return np.array([flag("suppression", meaning) for meaning in meanings])


def _branch_table(data, frequencies):
    """Ends and largest displacement of each damped branch of subharmonics."""
    found = _is_subharmonic(data)
    branch, period = data["branch"][1], data["period"][1]
    rows = []
    for number, n in np.unique(np.stack([branch[found], period[found]], axis=1), axis=0):
        cells = found & (branch == number) & (period == n)
        ends, events = _ends(data, number, frequencies, np.flatnonzero(cells.any(axis=1)))
        rows.append((number, n, np.max(data["maximum_displacement"][1][cells]), ends, events))
    names = ("subharmonic_branch", "subharmonic_period", "subharmonic_displacement")
    columns = zip(*rows, strict=True) if rows else [()] * 5
    *scalars, ends, events = (np.array(column) for column in columns)
    return dict(zip(names, scalars, strict=True)) | {
        "subharmonic_frequency": ends.reshape(-1, 2),
        "subharmonic_event": events.reshape(-1, 2),
    }


def _shares(data, present, count):
    """Share of the first `count` starts by what they lead to, where they were switched on."""
    settled = data["outcome"][1] == flag("outcome", "settled")
    period = data["period"][1]
    symmetric = (np.abs(data["contacts"][1] - 2) < SAME) & (data["asymmetry"][1] < SAME)
    kinds = np.select(
        [
            settled & (period == 1) & symmetric,
            settled & (period == 1),
            _is_subharmonic(data),
            settled,
            data["outcome"][1] == flag("outcome", "chaotic"),
            data["outcome"][1] == flag("outcome", "non_colliding"),
        ],
        range(len(SWITCHED_MOTIONS) - 1),
        len(SWITCHED_MOTIONS) - 1,
    )
    reached = np.take_along_axis(kinds, data["run_motion"][1][:, :count], axis=1)
    shares = np.stack([np.mean(reached == k, axis=1) for k in range(len(SWITCHED_MOTIONS))], axis=1)
    return np.where(present[:, None], shares, np.nan)
