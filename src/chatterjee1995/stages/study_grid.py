"""Write the chunks of a study into one file, with one chunk in memory at a time.

A study computes motions in each cell of a grid of dampers and frequencies; a chunk holds a range of
cells (`stages.studies`).
"""

import math

import netCDF4
import numpy as np
import xarray as xr

from chatterjee1995.variables.studies import AXES
from impact_damper.data.datasets import dataset, load, oscillator_of, seal, variable, write
from impact_damper.data.whole_files import BrokenFileError, whole_netcdf


def gather_chunks(paths, path) -> None:
    """Write the chunks of a study, in their order, into one file.

    The file has the variables of a chunk, with the axes of the grid as dimensions in place of
    `cell`. It also has two clearances. The first, for each mass ratio, frequency and restitution,
    is the clearance of the grid at which the largest displacement is smallest. The second, for each
    mass ratio and frequency, is the clearance of the paper's rule (18).

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
    """Write a chunk to its cells, from cell number `first` on, and return the number of cells.

    `file` is an open file, and `shape` the shape of the grid.
    """
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
    """Divide a range of cells into rectangular blocks of the grid.

    The cells are numbered with the last axis fastest. For n axes there are at most 2 n - 1 blocks,
    whatever the length of the range.

    Parameters
    ----------
    first, last : int
        Numbers of the first cell, and of the first cell after the range.
    shape : tuple of int

    Yields
    ------
    slice, tuple of slice
        Numbers of the cells in the block, and its place in the grid.
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
