"""Studies: motions from random starts in each cell of a grid of dampers and frequencies.

A cell is one combination of mass ratio, clearance, frequency and restitution; cells are numbered in
the order of `AXES`, the last axis fastest. A chunk of a study is a range of these numbers. The seed
and the number of a cell determine its random starts, so results do not depend on the chunks. After
every few cells the runs are reduced to a few numbers per cell, so the memory of a chunk hardly
grows with its size. `gather_chunks` has one chunk in memory at a time.
"""

import math

import netCDF4
import numpy as np
import xarray as xr

from chatterjee1995.variables.studies import AXES, OUTCOMES
from impact_damper.data.datasets import (
    dataset,
    flag,
    is_settled,
    load,
    oscillator_of,
    seal,
    variable,
    write,
)
from impact_damper.data.whole_files import BrokenFileError, whole_netcdf
from impact_damper.model.arguments import read_increasing
from impact_damper.model.bounds import RUNS_RANGE, SEED_RANGE, check_count
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper, describe
from impact_damper.model.settling import Settling
from impact_damper.model.units import UNITLESS
from impact_damper.motions import ensemble
from impact_damper.motions.simulate import random_states
from impact_damper.motions.start_states import (
    NO_STARTS,
    describe_search,
    warn_if_narrow,
    wide_starts,
)
from impact_damper.orbits.quiet_orbits import is_symmetric_pair

# Results of a cell: number of random starts with each outcome and of those that lead to the quiet
# orbit; largest displacement of all motions, and smallest one on a quiet orbit.
CELL = np.dtype(
    [
        ("outcome_count", "i4", len(OUTCOMES)),
        ("quiet_count", "i4"),
        ("largest_displacement", "f8"),
        ("quiet_displacement", "f8"),
    ]
)


def study_chunk(
    oscillator,
    axes,
    cells,
    *,
    contact_stiffness=2000.0,
    starts=8,
    radius=None,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Return the motions to which random starts lead, in a range of cells of a grid.

    Parameters
    ----------
    oscillator : Oscillator
    axes : dict
        Increasing values of mass_ratio (rm), clearance (d0), frequency (W) and restitution (e).
    cells : tuple of int
        Numbers of the first cell of the chunk, and of the first cell after the chunk.
    contact_stiffness : float
        r1, the same in all cells.
    starts, radius, seed, settling, workers, progress
        As in `frequency_response`, for each cell.

    Returns
    -------
    xarray.Dataset
        For each `cell`: largest displacement of all motions to which the starts lead; displacement
        on the quiet orbit, a periodic motion of one cycle with two symmetric contacts; numbers of
        random starts that lead to the quiet orbit and to each outcome.
    """
    settling = settling or Settling()
    check_count("starts", starts, **RUNS_RANGE)
    axes = _checked(axes)
    shape = [len(values) for values in axes.values()]
    first = check_count("cells[0]", cells[0], least=0, most=math.prod(shape) - 1)
    last = check_count("cells[1]", cells[1], least=first + 1, most=math.prod(shape))

    def system(place):
        values = {name: axis[i] for (name, axis), i in zip(axes.items(), place, strict=True)}
        frequency = values.pop("frequency")
        damper = Damper(contact_stiffness=contact_stiffness, **values)
        return pack(oscillator, damper, frequency), damper

    def starts_of(damper, frequency, cell):
        if radius is None:
            return wide_starts(oscillator, damper, frequency, starts, [seed, cell], settling)[:2]
        return random_states(starts, radius, damper, [seed, cell]), NO_STARTS

    check_count("seed", seed, **SEED_RANGE)
    # The axes are sorted, so a value out of range is at an end of its axis. It is found here, not
    # after hours of work.
    for end in (0, -1):
        _, damper = system([end] * len(AXES))
        if radius is not None:
            random_states(0, radius, damper, seed)
    if radius is not None:
        warn_if_narrow(oscillator, axes["frequency"], radius)
    found, stop = np.empty(last - first, CELL), np.zeros(1, bool)

    def work(part):
        rows, states = [], []
        for cell in range(first + part.start, first + part.stop):
            p, damper = system(np.unravel_index(cell, shape))
            states.append(np.concatenate(starts_of(damper, p[FREQUENCY], cell)))
            rows.append(np.tile(p, (len(states[-1]), 1)))
        runs = ensemble.settle(np.concatenate(rows), np.concatenate(states), settling, stop=stop)
        ends = np.cumsum([len(row) for row in rows])
        for k, of_cell in enumerate(np.split(runs, ends[:-1]), part.start):
            found[k] = _condensed(of_cell, starts)

    # Number of cells that are run together. They have about `ensemble.CHUNK` random starts.
    together = max(1, ensemble.CHUNK // starts)
    ensemble.run_chunks(work, last - first, workers, progress, stop, size=together)
    data = {
        name: (("cell", "counted_outcome")[: found[name].ndim], found[name]) for name in CELL.names
    }
    made = describe(oscillator, settling) | describe_search(starts, radius, seed)
    made["contact_stiffness"] = contact_stiffness
    coordinates = axes | {"cell": np.arange(first, last), "counted_outcome": list(OUTCOMES)}
    return dataset(data, coordinates, made, "Motions from random starts over a grid")


def _condensed(runs, starts):
    """Return the runs in a cell as a row of `CELL`; only the first `starts` are counted."""
    sizes = runs["maximum_displacement"]
    quiet = is_settled(runs) & is_symmetric_pair(runs)
    return (
        [np.sum(runs["outcome"][:starts] == flag("outcome", name)) for name in OUTCOMES],
        np.sum(quiet[:starts]),
        np.max(sizes),
        np.min(sizes[quiet]) if quiet.any() else np.nan,
    )


def _checked(axes):
    """Return the axes as increasing arrays in the order of `AXES`."""
    if not isinstance(axes, dict) or set(axes) != set(AXES):
        raise TypeError(f"axes = {axes!r}: must be a dictionary of {', '.join(AXES)}")
    return {
        name: read_increasing(UNITLESS, f"axes[{name!r}]", np.atleast_1d(axes[name]))
        for name in AXES
    }


def gather_chunks(paths, path) -> None:
    """Write the chunks of a study, in their order, into one file.

    The file has the variables of a chunk, with the axes of the grid as dimensions in place of
    `cell`. It also has, for each mass ratio, frequency and restitution, the clearance of the grid
    at which the largest displacement is smallest, and the clearance of the paper's rule (18).

    Parameters
    ----------
    paths : sequence of str or pathlib.Path
        Files of all chunks, each with a dataset of `study_chunk`.
    path : str or pathlib.Path
        File to write; it appears only once it is complete.

    Raises
    ------
    BrokenFileError
        If the file of a chunk is incomplete, does not begin where the chunk before it ended, or
        belongs to another study.
    """
    chunk = load(paths[0])
    axes = {name: chunk[name].values for name in AXES}
    shape = tuple(len(values) for values in axes.values())
    others = {"counted_outcome": chunk["counted_outcome"].values}
    head = dataset({}, axes | others, {}, "").assign_attrs(chunk.attrs)
    with whole_netcdf(path) as part:
        write(head, part)
        with netCDF4.Dataset(part, "a") as file:
            for name in chunk.data_vars:
                _define(file, name, (*AXES, *chunk[name].dims[1:]), chunk[name].dtype)
            done = 0
            for each in paths:
                chunk = load(each)
                _check_next(chunk, each, done, head)
                done += _place(file, chunk, done, shape)
            if done != math.prod(shape):
                found = f"ends at cell {done} of {math.prod(shape)}"
                raise BrokenFileError(f"{paths[-1]} {found}")
            _write_clearances(file, axes, oscillator_of(head))
        with xr.open_dataset(part, engine="netcdf4", cache=False) as data:
            sealed = seal(data.variables, path)
        with netCDF4.Dataset(part, "a") as file:
            file.setncatts(sealed)


def _place(file, chunk, first, shape):
    """Write a chunk to its cells, from cell number `first` on, and return the number of cells."""
    count = chunk.sizes["cell"]
    for cells, block in blocks(first, first + count, shape):
        lengths = [index.stop - index.start for index in block]
        for name in chunk.data_vars:
            values = chunk[name].values[cells.start - first : cells.stop - first]
            file[name][block] = values.reshape(*lengths, *values.shape[1:])
    return count


def _define(file, name, dims, dtype):
    """Create an empty registered variable in an open file."""
    labelled = variable(name, np.empty((0,) * len(dims), dtype), dims)
    missing = np.nan if labelled.dtype.kind == "f" else False
    file.createVariable(name, labelled.dtype, dims, fill_value=missing).setncatts(labelled.attrs)


def _check_next(chunk, path, first, head):
    """Raise BrokenFileError unless a chunk begins at cell `first` and belongs to the study."""
    same = chunk.attrs == head.attrs and all(
        np.array_equal(chunk[name], head[name]) for name in (*AXES, "counted_outcome")
    )
    if not same or chunk["cell"].values[0] != first:
        raise BrokenFileError(f"{path} must begin at cell {first} of the same study")


def blocks(first, last, shape):
    """Divide a range of cells into rectangular blocks of the grid, at most 2 n - 1 for n axes.

    Yield for each block the slice of the numbers of its cells, and its place in the grid, a tuple
    of slices.
    """
    while first < last:
        axis, stride = len(shape) - 1, 1
        # Find the largest block that begins at cell `first` and does not extend beyond the range.
        while axis > 0 and first % (wider := stride * shape[axis]) == 0 and first + wider <= last:
            axis, stride = axis - 1, wider
        place = np.unravel_index(first, shape)
        count = min((last - first) // stride, shape[axis] - int(place[axis]))
        block = [slice(int(i), int(i) + 1) for i in place[:axis]]
        block += [slice(int(place[axis]), int(place[axis]) + count)]
        block += [slice(0, length) for length in shape[axis + 1 :]]
        yield slice(first, first + count * stride), tuple(block)
        first += count * stride


def _write_clearances(file, axes, oscillator):
    """Write both clearances that `gather_chunks` adds."""
    dims = tuple(name for name in AXES if name != "clearance")
    _define(file, "best_clearance", dims, float)
    _define(file, "rule_clearance", ("mass_ratio", "frequency"), float)
    forcing = oscillator.forcing_amplitude(axes["frequency"])
    for i, mass_ratio in enumerate(axes["mass_ratio"]):
        sizes = np.ma.getdata(file["largest_displacement"][i])
        file["best_clearance"][i] = axes["clearance"][np.argmin(sizes, axis=0)]
        file["rule_clearance"][i] = forcing / (mass_ratio * axes["frequency"] ** 2)
