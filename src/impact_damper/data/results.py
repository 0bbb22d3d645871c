"""Convert datasets to SI units, and back.

The registry of variables names the physical quantity of each variable. Numbers that combine several
quantities, such as the distance between two states, stay in the scales of the machine.
"""

import json

import numpy as np

from impact_damper.data.datasets import parameters_of, variable
from impact_damper.data.optimum_words import optimum_in_words
from impact_damper.data.variables import VARIABLES
from impact_damper.model.machine import describe_si
from impact_damper.model.units import QUANTITIES

# Quantities of the components of a state.
PURE = ("number", "angle")
STATE = ("displacement", "velocity", "displacement", "velocity")
STATE_UNITS = "m, m/s, m, m/s"
# Parameters that may vary along a branch of orbits. Keyed by the name for a machine; the values are
# the name in the dimensionless equations, and the quantity.
FOLLOWED = {
    "frequency": ("frequency", "frequency"),
    "damping": ("damping", "damping"),
    "cubic_stiffness": ("cubic", "cubic_stiffness"),
    "force": ("force", "force"),
    "unbalance": ("unbalance", "unbalance"),
    "mass": ("mass_ratio", "mass"),
    "clearance_each_side": ("clearance", "clearance"),
    "restitution": ("restitution", "number"),
    "contact_stiffness": ("contact_stiffness", "stiffness"),
}


def shown_variable(name, values, dims=None):
    """Return a registered variable with values in the unit used by datasets of machines.

    Parameters
    ----------
    name : str
    values : array_like
        In mm for displacements, otherwise in the SI unit of the variable's quantity.
    dims : sequence of str, optional
        In place of the registered dimensions.
    """
    found = variable(name, values, dims)
    found.attrs["units"] = QUANTITIES[VARIABLES[name].kind].label
    return found


def in_si(data, machine, damper=None):
    """Return a dataset of the dimensionless equations in the units of a machine.

    Parameters
    ----------
    data : xarray.Dataset
        Of registered variables, computed in `machine.scales`.
    machine : Machine
    damper : MachineDamper, optional

    Returns
    -------
    xarray.Dataset
        Each variable has the unit in its attribute `units`: mm, m/s, Hz, s, N and others. States
        are in m and m/s, so that functions accept them. Clearances are on each side, as their long
        names say. The attribute `machine` holds machine and damper in SI units, with `gap` as the
        full play; `scales` holds the scales, and `parameters` the dimensionless parameters.
    """
    made = {"machine": describe_si(machine, damper), "scales": machine.scales._asdict()}
    converted = _each(data, lambda values, unit: values * unit, machine.scales)
    for name in converted.variables:
        _name_unit(converted[name], _quantity(name, data))
    texts = {name: json.dumps(value, sort_keys=True) for name, value in made.items()}
    if "optimum" in data.attrs:
        texts["optimum"] = optimum_in_words(converted)
    return converted.assign_attrs(texts)


def from_si(data, machine):
    """Return a dataset that `in_si` made, converted back to the scales of its machine."""
    return _each(data, lambda values, unit: values / unit, machine.scales)


def _each(data, convert, scales):
    """Return a dataset with each variable converted by the unit of its quantity."""
    found = {}
    for name, each in data.variables.items():
        quantity = _quantity(name, data)
        if quantity == "state":
            unit = np.array([scales.unit(each) for each in STATE])
        elif quantity in QUANTITIES and quantity not in PURE:
            unit = scales.unit(quantity) * QUANTITIES[quantity].factor
        else:
            continue
        found[name] = each.copy(data=convert(each.values, unit))
    coordinates = {name: found.pop(name) for name in list(found) if name in data.coords}
    return data.assign(found).assign_coords(coordinates)


def _quantity(name, data):
    """Return the quantity of a variable; for a followed value, the quantity of the parameter."""
    quantity = VARIABLES[name].kind
    if quantity != "followed":
        return quantity
    # the coordinate of a sweep is its parameter
    swept = "clearance" if "clearance" in data.coords else "frequency"
    parameter = parameters_of(data).get("parameter", swept)
    return next(kind for inner, kind in FOLLOWED.values() if inner == parameter)


def _name_unit(variable, quantity):
    """Set the attributes of a converted variable in place."""
    if quantity == "state":
        variable.attrs["units"] = STATE_UNITS
    elif quantity == "mixed":
        variable.attrs["long_name"] += ", in the scales of the machine"
    elif quantity not in PURE:
        variable.attrs["units"] = QUANTITIES[quantity].label
        variable.attrs.pop("symbol", None)
    if quantity == "clearance":
        variable.attrs["long_name"] += ", on each side"
