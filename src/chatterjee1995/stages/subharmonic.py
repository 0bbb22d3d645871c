"""The one-third subharmonic of the free oscillator, and its suppression by a damper."""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.data.variables import register
from impact_damper.kernel.single import side_of
from impact_damper.model import packed
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import NONLINEAR, describe
from impact_damper.motions import strobe_map, traces
from impact_damper.motions.following import record_at
from impact_damper.motions.simulate import COMPONENTS
from impact_damper.motions.start_states import describe_search, search_starts
from impact_damper.motions.sweep import SAME, sweep

register(
    """
free_subharmonic | frequency | displacement | max |Z1| | largest displacement of the subharmonic
  without the damper
damped_subharmonic | frequency | displacement | max |Z1| | largest displacement of any subharmonic
  with the damper
subharmonic_ratio | frequency | | | damped_subharmonic divided by free_subharmonic, 0 if the
  damper removes it
switched_share | frequency | | | share of starts on the free subharmonic that lead to a subharmonic
  when the damper is switched on
    """
)

SEARCHED = 81  # number of frequencies at which the free subharmonic is searched for
BEYOND = 0.1  # margin of W at each end, as a fraction of the range of the free subharmonic


def subharmonic_suppression(
    oscillator,
    damper,
    frequencies,
    *,
    starts=96,
    radius=None,
    seed=1995,
    settling,
    workers=1,
    progress=None,
):
    """Return a dataset of subharmonics with the damper, and of the free subharmonic.

    The free subharmonic is searched for from the first to the last of `frequencies`. If it exists,
    new frequencies replace `frequencies`. Their number is the same, and they cover the range of the
    free subharmonic, with a margin at both ends. At each frequency within the range itself, half of
    the runs begin in the free subharmonic: the damper is switched on during this motion.
    """
    if not any(getattr(oscillator, name) for name in NONLINEAR):
        raise ValueError(
            "cubic = 0: must not be 0 (without the damper a linear spring has no subharmonic)"
        )
    drawn = {"starts": starts, "radius": radius, "seed": seed}
    ends = frequencies[0], frequencies[-1]
    free = free_subharmonic(oscillator, *ends, **drawn, settling=settling, workers=workers)
    if free.found:
        margin = BEYOND * (free.ends[1] - free.ends[0])
        frequencies = np.linspace(free.ends[0] - margin, free.ends[1] + margin, len(frequencies))
    parameters = np.array([pack(oscillator, damper, value) for value in frequencies])
    systems = [(damper, value) for value in frequencies]
    search = search_starts(oscillator, systems, starts, radius, seed, settling)
    size = _switch_half(oscillator, parameters, free, search.random, seed)
    run = {"workers": workers, "progress": progress}
    data = sweep(parameters, FREQUENCY, "frequency", search, settling, **run)
    data |= _subharmonic_table(data, size)
    switched = data["run_motion"][1][:, : starts // 2]
    share = np.mean(np.take_along_axis(is_subharmonic(data), switched, axis=1), axis=1)
    data["switched_share"] = np.where(np.isfinite(size), share, np.nan)
    made = describe(oscillator, damper, settling) | describe_search(**drawn)
    coordinates = {"frequency": frequencies, "component": list(COMPONENTS)}
    return dataset(data, coordinates, made, "One-third subharmonic without and with the damper")


def _switch_half(oscillator, parameters, free, states, seed):
    size = np.full(len(parameters), np.nan)
    half = states.shape[1] // 2
    for i, p in enumerate(parameters):
        record = free.at(p[FREQUENCY])
        if record is not None:
            size[i] = record["maximum_displacement"]
            generator = np.random.default_rng([seed, i, half])
            states[i, :half] = switched_on(
                oscillator, p, record["state"], states[i, :half], generator
            )
    return size


def switched_on(oscillator, p, state, loose, generator):
    """Switch the damper on at m random times of a free motion, which begins in `state`.

    For each of these times return the state when W T next is a multiple of 2 pi. At the switching
    the loose mass has Z2 and Z2' from columns 2 and 3 of a row of `loose` (m, 4). The other columns
    are not used. In every second case Z2' is set to 0 instead.
    """
    period = 2 * np.pi / p[FREQUENCY]
    begin = strobe_map.strobe_time(p)
    times = begin + np.sort(generator.random(len(loose))) * 3 * period
    free, tolerance = pack(oscillator, None, p[FREQUENCY]), strobe_map.POLISH_TOLERANCE
    states = traces.states_at(free, state, begin, times, tolerance)
    states[:, 2:] = loose[:, 2:]
    states[::2, 3] = 0.0
    # In `log` each contact takes a row. A step has at most one contact, so there are rows enough.
    sample, log = np.empty((1, 4)), np.empty((traces.STEPS_AT_ONCE, 5))
    for time, y in zip(times, states, strict=True):
        end = np.array([np.ceil(time / period) * period])
        traces.trace_steps(p, y, time, side_of(p, y), 0, 0, end, tolerance, sample, log)
    return states


def _subharmonic_table(data, free):
    size = np.where(is_subharmonic(data), data["maximum_displacement"][1], -np.inf)
    damped = np.max(size, axis=1)
    return {
        "free_subharmonic": free,
        "damped_subharmonic": np.where(damped > 0, damped, np.nan),
        "subharmonic_ratio": np.maximum(damped, 0) / free,
    }


def is_subharmonic(data):
    """Return an array: whether each motion has settled with a period that is a multiple of 3."""
    return (data["outcome"][1] == flag("outcome", "settled")) & (data["period"][1] % 3 == 0)


def branch_ends(data, branch, grid, rows):
    """Return the frequencies of both ends of a branch.

    The sweep `data` has found the branch at the frequencies `grid[rows]`. If it has not located an
    end of the branch, the lowest or the highest of these frequencies takes the place of this end.
    """
    ends = grid[[min(rows), max(rows)]]
    for side, (row, step, turn) in enumerate(((min(rows), -1, "down"), (max(rows), 1, "up"))):
        if not 0 <= row + step < len(grid):
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
            ends[side] = value[np.argmax(np.where(fits, away, -1.0))]
    return ends


class FreeSubharmonic(NamedTuple):
    """The free subharmonic: packed `parameters`, states at W T = pi/2, lowest and highest W."""

    parameters: np.ndarray
    states: np.ndarray
    ends: np.ndarray

    @property
    def found(self):
        """True if there is a subharmonic."""
        return len(self.states) > 0

    def at(self, frequency):
        """Return the `MOTION` record at a frequency, or None if the branch does not reach it."""
        if not self.ends[0] <= frequency <= self.ends[1]:
            return None
        k = np.argmin(np.abs(self.parameters[:, FREQUENCY] - frequency))
        return record_at(self.parameters[k], self.states[k], 3, FREQUENCY, frequency)


def free_subharmonic(
    oscillator, first, last, *, starts=96, radius=None, seed=1995, settling, workers=1
) -> FreeSubharmonic:
    """Find free subharmonics from W = `first` to `last`. Return the branch found most often."""
    frequencies = np.linspace(first, last, SEARCHED)
    parameters = np.array([pack(oscillator, None, value) for value in frequencies])
    systems = [(None, value) for value in frequencies]
    search = search_starts(oscillator, systems, starts, radius, seed, settling)
    data = sweep(parameters, FREQUENCY, "frequency", search, settling, workers=workers)
    chosen = is_subharmonic(data) & (data["period"][1] == 3) & (data["asymmetry"][1] < SAME)
    branches, counts = np.unique(data["branch"][1][chosen], return_counts=True)
    if len(branches) == 0:
        return FreeSubharmonic(np.empty((0, packed.COUNT)), np.empty((0, 4)), np.full(2, np.nan))
    branch = branches[np.argmax(counts)]
    row, column = np.nonzero(chosen & (data["branch"][1] == branch))
    ends = branch_ends(data, branch, frequencies, row)
    return FreeSubharmonic(parameters[row], data["state"][1][row, column], ends)
