"""Labelled datasets: built from the registry, written whole or not at all."""

import hashlib
import json
from pathlib import Path

import numpy as np
import xarray as xr

from impact_damper.data.variables import VARIABLES
from impact_damper.data.whole_files import DELETE, BrokenFileError, check_length, whole_netcdf
from impact_damper.system.parameters import Damper, Oscillator, pick

SOURCE = "impact-damper"

# Numbers of an open file that are read at once.
PIECE = 2**14


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
            "source": SOURCE,
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


def oscillator_of(data) -> Oscillator:
    """Return the oscillator that a dataset was computed for."""
    return Oscillator(**pick(Oscillator, parameters_of(data)))


def damper_of(data, **others) -> Damper:
    """Return the damper that a dataset was computed for.

    `others` gives the fields that are not among the parameters of the dataset because they vary in
    it, as the clearance does in a sweep.
    """
    return Damper(**pick(Damper, parameters_of(data)), **others)


def save(data, path) -> None:
    """Write a dataset to NetCDF; the file appears only when it is whole.

    It carries its stage and name, and the digest of its arrays, which `load` looks at.
    """
    with whole_netcdf(path) as part:
        write(data.assign_attrs(seal(data.variables, path)), part)


def write(data, path) -> None:
    """Write a dataset to a NetCDF file of this very name."""
    encoding = {name: {"_FillValue": None} for name in data.coords}
    encoding |= {
        name: {"_FillValue": None} for name in data.data_vars if data[name].dtype.kind in "iub"
    }
    data.to_netcdf(path, engine="netcdf4", encoding=encoding)


def load(path) -> xr.Dataset:
    """Read a dataset into memory and close the file, so that it can be overwritten.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    BrokenFileError
        If the file is not what `save` has written under this path.
    """
    check_length(path)
    try:
        data = xr.load_dataset(path, engine="netcdf4")
    except (OSError, RuntimeError, ValueError) as error:
        raise BrokenFileError(f"{path} cannot be read ({error}): {DELETE}.") from error
    if data.attrs.get("source") != SOURCE:
        raise BrokenFileError(f"{path} was not made by this project: {DELETE}.")
    sealed = seal(data.variables, path)
    if data.attrs.get("id") != sealed["id"]:
        raise BrokenFileError(f"{path} holds {data.attrs.get('id')}: {DELETE}.")
    if data.attrs.get("sha256") != sealed["sha256"]:
        raise BrokenFileError(f"{path} holds other numbers than were written: {DELETE}.")
    # They are of the file: what is made of the data is to have its own.
    data.attrs = {name: value for name, value in data.attrs.items() if name not in sealed}
    return data


def seal(variables, path) -> dict:
    """Attributes by which `load` knows a file: its stage and name, and the digest of its arrays.

    Parameters
    ----------
    variables : dict of xarray.Variable
        By name; those of an open file are read piece by piece.
    path : str or pathlib.Path
        Name of the file.
    """
    return {"id": _identity(path), "sha256": _digest(variables)}


def _identity(path):
    """Stage and name of a file of results, wherever their folder lies."""
    path = Path(path).absolute()
    return f"{path.parent.name}/{path.stem}"


def _digest(variables):
    """Digest of all names and arrays."""
    digest = hashlib.sha256()
    for name, variable in sorted(variables.items()):
        digest.update(f"{name} {variable.dims} {variable.shape}".encode())
        # Texts, and what is empty, may come back from a file as another type.
        if variable.dtype.kind in "biuf":
            for piece in _pieces(variable):
                digest.update(piece.tobytes())
        else:
            digest.update("\0".join(map(str, np.asarray(variable).ravel())).encode())
    return digest.hexdigest()


def _pieces(variable):
    """Numbers of a variable, some rows at a time."""
    count = variable.shape[0] if variable.ndim else 1
    rows = max(1, PIECE * count // max(variable.size, 1))
    for first in range(0, count, rows):
        values = np.asarray(variable[first : first + rows] if variable.ndim else variable)
        # a file keeps no sign of NaN
        yield np.where(np.isnan(values), np.nan, values) if values.dtype.kind == "f" else values
