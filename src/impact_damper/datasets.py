"""Labelled datasets: built from the registry, written whole or not at all."""

import json
import os
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import xarray as xr

from impact_damper.variables import VARIABLES


def variable(name, data, dims=None) -> xr.Variable:
    """The registered variable `name` with its attributes; `dims` in place of the registered ones.

    Raises
    ------
    KeyError
        If the registry does not hold the name.
    """
    entry = VARIABLES[name]
    attributes = {"long_name": entry.long_name, "units": entry.units}
    if entry.symbol:
        attributes["symbol"] = entry.symbol
    data = np.asarray(data)
    if entry.flags:
        data = data.astype(np.int8)
        attributes["flag_values"] = np.array(list(entry.flags.values()), np.int8)
        attributes["flag_meanings"] = " ".join(entry.flags)
    return xr.Variable(entry.dims if dims is None else dims, data, attributes)


def dataset(data, coordinates, parameters, title) -> xr.Dataset:
    """Dataset of registered variables.

    Parameters
    ----------
    data, coordinates : dict
        Arrays by registered name; an entry may be a pair (dims, array).
    parameters : dict
        What made the data; kept as a JSON attribute.
    title : str
        One line that says what the dataset is.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    KeyError
        If the registry does not hold a name.
    """

    def labelled(items):
        return {
            name: variable(name, value[1], value[0])
            if isinstance(value, tuple)
            else variable(name, value)
            for name, value in items.items()
        }

    return xr.Dataset(
        labelled(data),
        labelled(coordinates),
        {
            "Conventions": "CF-1.11",
            "title": title,
            "source": "impact-damper",
            "references": "Chatterjee, Mallik and Ghosh, J. Sound Vib. 187(3), 403-420, 1995",
            "parameters": json.dumps(parameters, sort_keys=True),
        },
    )


def flag(name, meaning) -> int:
    """Value of a flag by its meaning, as `flag("status", "settled")`."""
    return VARIABLES[name].flags[meaning]


def is_settled(motions):
    """True where a record or a dataset of motions says that they settled."""
    return np.asarray(motions["outcome"]) == flag("outcome", "settled")


def parameters_of(data) -> dict:
    """The parameters that made a dataset."""
    return json.loads(data.attrs["parameters"])


def save(data, path) -> None:
    """Write a dataset to NetCDF; the file appears only when it is whole."""
    with whole(path) as part:
        write(data, part)


@contextmanager
def whole(path):
    """Name under which to write a file, which takes the name `path` when all went well."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.part-{os.getpid()}")
    try:
        yield part
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def write(data, path) -> None:
    """Write a dataset to a NetCDF file of this very name."""
    encoding = {name: {"_FillValue": None} for name in data.coords}
    encoding |= {
        name: {"_FillValue": None} for name in data.data_vars if data[name].dtype.kind in "iub"
    }
    data.to_netcdf(path, engine="netcdf4", encoding=encoding)


def load(path) -> xr.Dataset:
    """Read a dataset into memory and close the file, so that it can be overwritten."""
    return xr.load_dataset(path, engine="netcdf4")
