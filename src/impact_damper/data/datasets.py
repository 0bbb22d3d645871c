"""Functions that build labelled datasets of registered variables, save them and load them."""

import hashlib
import json
from pathlib import Path

import numpy as np
import xarray as xr

# The import of these modules registers variables.
from impact_damper.data import design_variables, motion_variables  # noqa: F401
from impact_damper.data.variables import VARIABLES
from impact_damper.data.whole_files import BrokenFileError, check_length, whole
from impact_damper.model.arguments import PHASES, STATE, STATE_UNITS
from impact_damper.model.bounds import shown
from impact_damper.model.families import facts_of
from impact_damper.model.machine import describe_si
from impact_damper.model.parameters import Damper, Oscillator, pick
from impact_damper.model.units import QUANTITIES

SOURCE = "impact-damper"
PURE = ("number", "angle", "mixed")  # kinds that stay dimensionless in datasets of machines


def variable(name, data, dims=None) -> xr.Variable:
    """Return `data` as the registered variable `name`, with `dims` or the registered dimensions."""
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


def shown_variable(name, values):
    """Return the variable `name` with `values`, which are in the unit for machines, such as mm."""
    found = variable(name, values)
    found.attrs["units"] = QUANTITIES[VARIABLES[name].kind].label
    return found


def dataset(data, coordinates, parameters, title, model=None) -> xr.Dataset:
    """Return a dataset of registered variables, with `parameters` and `title` as attributes.

    `data` and `coordinates` map registered names to dimensionless arrays or pairs (dims, array). If
    `model` (a `Model`) holds a machine, the dataset is converted to mm, Hz and so on.
    """

    def labelled(items):
        pairs = {name: x if isinstance(x, tuple) else (None, x) for name, x in items.items()}
        return {name: variable(name, values, dims) for name, (dims, values) in pairs.items()}

    found = xr.Dataset(
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
    found = found.set_coords([name for name in PHASES if name in found])
    if model is None or model.machine is None:
        return found
    return in_si(found, model.machine, model.machine_damper)


def in_si(data, machine, damper=None) -> xr.Dataset:
    """Return a dimensionless dataset converted to the units of a machine.

    Displacements are then in mm, but states in m and m/s. The attribute `machine` of the dataset
    holds machine and damper in SI units. The attribute `parameters` stays dimensionless.
    """
    scales = machine.scales
    found = _converted(data, lambda values, unit: values * unit, scales)
    for name in found.variables:
        _name_unit(found[name], _kind(name, data))
    units = {name: getattr(scales, name) for name in ("length", "time", "mass")}
    facts = {"machine": describe_si(machine, damper), "scales": units}
    texts = {name: json.dumps(value, sort_keys=True) for name, value in facts.items()}
    return found.assign_attrs(texts)


def from_si(data, scales) -> xr.Dataset:
    """Return a dataset converted to dimensionless numbers, by the scales of its machine."""
    return _converted(data, lambda values, unit: values / unit, scales) if scales.si else data


def _converted(data, convert, scales):
    found = {}
    for name, each in data.variables.items():
        kind = _kind(name, data)
        if kind == "state":
            unit = np.array([scales.unit(part) for part in STATE])
        elif kind in PURE:
            continue
        else:
            unit = scales.unit(kind) * QUANTITIES[kind].factor
        found[name] = each.copy(data=convert(each.values, unit))
    coordinates = {name: found.pop(name) for name in list(found) if name in data.coords}
    return data.assign(found).assign_coords(coordinates)


def _kind(name, data):
    kind = VARIABLES[name].kind
    if kind == "followed":
        parameter = parameters_of(data).get("parameter")
        # A sweep does not store the name of its parameter. The parameter is a coordinate.
        swept = "clearance" if "clearance" in data.coords else "frequency"
        kind = facts_of(parameter)[1] if parameter else swept
    return "gap" if kind == "clearance" else kind


def _name_unit(variable, kind):
    if kind == "state":
        variable.attrs["units"] = STATE_UNITS
    elif kind == "mixed":
        variable.attrs["long_name"] += ", in the scales of the machine"
    elif kind not in PURE:
        variable.attrs["units"] = QUANTITIES[kind].label
        variable.attrs.pop("symbol", None)
    if kind == "gap":
        variable.attrs["long_name"] += ", as the full play"


def flag(name, meaning) -> int:
    """Return the number that stands for a named value: `flag("outcome", "settled")` is 1."""
    return VARIABLES[name].flags[meaning]


def named(data, name) -> str:
    """Return the single value of the flag variable `name` as a word, such as "settled"."""
    return decode(data[name]).item()


def decode(values) -> xr.DataArray:
    """Return the names of the numbers in a flag variable, such as "settled" for 1.

    Parameters
    ----------
    values : xarray.DataArray
        A variable with the attributes `flag_values` and `flag_meanings`, such as `outcome`.

    Returns
    -------
    xarray.DataArray
        Text, with the dimensions and coordinates of `values`.

    Raises
    ------
    TypeError
        If `values` is not a labelled array of flags.
    ValueError
        If a number is not among the flags.

    Examples
    --------
    >>> import impact_damper as idm
    >>> steady = idm.steady_motion(idm.Oscillator(0.215), None, 2.0)
    >>> idm.decode(steady.outcome).item()
    'settled'
    """
    attributes = getattr(values, "attrs", {})
    if not {"flag_values", "flag_meanings"} <= attributes.keys():
        raise TypeError(
            f"values = {shown(values)}: must be a variable of a dataset with named values, such as "
            "outcome"
        )
    words = attributes["flag_meanings"].split()
    known = dict(zip(np.ravel(attributes["flag_values"]).tolist(), words, strict=True))
    unknown = sorted(set(np.unique(values.values).tolist()) - set(known))
    if unknown:
        raise ValueError(f"values = {shown(unknown)}: must be among {shown(known)}")
    found = np.array([known[each] for each in np.ravel(values.values).tolist()], object)
    decoded = values.copy(data=found.reshape(values.shape))
    decoded.attrs = {name: attributes[name] for name in ("long_name",) if name in attributes}
    return decoded


def is_settled(motions):
    """Return a boolean array that is True for motions with the outcome "settled"."""
    return np.asarray(motions["outcome"]) == flag("outcome", "settled")


def touches_no_wall(motions):
    """Return a boolean array that is True for motions in which the loose mass touches no wall."""
    names = ("non_colliding", "drifting")
    return np.isin(motions["outcome"], [flag("outcome", name) for name in names])


def parameters_of(data) -> dict:
    """Return the parameters from which a dataset was computed."""
    return json.loads(data.attrs["parameters"])


def oscillator_of(data) -> Oscillator:
    """Return the oscillator that a dataset was computed for."""
    return Oscillator(**pick(Oscillator, parameters_of(data)))


def damper_of(data, **others) -> Damper:
    """Return the damper of a dataset. `others` are fields that the dataset's parameters lack."""
    return Damper(**pick(Damper, parameters_of(data)), **others)


def has_damper(data) -> bool:
    """Return whether a dataset is of an oscillator with a damper."""
    return "mass_ratio" in parameters_of(data)


def save(data, path) -> None:
    """Write a dataset to a NetCDF file, with a checksum. The file appears when it is complete."""
    whole_numbers = [name for name in data.data_vars if data[name].dtype.kind in "iub"]
    encoding = {name: {"_FillValue": None} for name in (*data.coords, *whole_numbers)}
    sealed = data.assign_attrs(seal(data.variables, path))
    with whole(path) as part:
        try:
            sealed.to_netcdf(part, engine="netcdf4", encoding=encoding)
        except RuntimeError as error:  # raised by the NetCDF library
            raise OSError(str(error)) from error
        check_length(part)


def load(path) -> xr.Dataset:
    """Read a dataset. Raise BrokenFileError if a file is damaged, or not as `save` wrote it."""
    check_length(path)
    try:
        data = xr.load_dataset(path, engine="netcdf4")
    except (OSError, RuntimeError, ValueError) as error:
        raise BrokenFileError(f"{path} cannot be read ({error})") from error
    if data.attrs.get("source") != SOURCE:
        raise BrokenFileError(f"{path} was not made by this project")
    sealed = seal(data.variables, path)
    if data.attrs.get("id") != sealed["id"]:
        held = data.attrs.get("id", "a dataset not written by `save`; read it with xarray")
        raise BrokenFileError(f"{path} holds {held}")
    if data.attrs.get("sha256") != sealed["sha256"]:
        raise BrokenFileError(f"{path} holds other numbers than were written")
    data.attrs = {name: value for name, value in data.attrs.items() if name not in sealed}
    return data


def seal(variables, path) -> dict:
    """Return the attributes by which `load` detects that a file was replaced or damaged."""
    path, digest = Path(path).absolute(), hashlib.sha256()
    for name, variable in sorted(variables.items()):
        digest.update(f"{name} {variable.dims} {variable.shape}".encode())
        values = np.asarray(variable)
        if values.dtype.kind == "f":  # NetCDF does not preserve the sign of NaN
            values = np.where(np.isnan(values), np.nan, values)
        if values.dtype.kind in "biuf":
            digest.update(values.tobytes())
        else:  # strings and empty arrays may have another type after reading from a file
            digest.update("\0".join(map(str, values.ravel())).encode())
    return {"id": f"{path.parent.name}/{path.stem}", "sha256": digest.hexdigest()}
