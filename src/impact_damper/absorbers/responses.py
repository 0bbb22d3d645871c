"""Absorbers that one could build in place of an impact damper, and how far the machine moves.

`absorber_responses` compares, for one machine and one added mass, the bare machine, the exact tuned
absorber and the nonlinear tuned absorber, each with its stiffness as designed and detuned, over
forcing frequencies and forcing amplitudes.
"""

import json

import numpy as np

from impact_damper.absorbers.absorber import check_mass
from impact_damper.absorbers.linear_response import response
from impact_damper.absorbers.motions import stable_motions
from impact_damper.absorbers.problems import problems_of
from impact_damper.absorbers.tuning import exact_absorber, nonlinear_absorber
from impact_damper.data.datasets import dataset, flag
from impact_damper.machine.results import in_si
from impact_damper.system.bounds import shown
from impact_damper.system.checks import check_numbers

COMPETITORS = ("bare", "tuned", "nonlinear")
# Factors of the excitation, from a quarter to four times the machine's.
SHARES = tuple(2.0 ** (step / 2) for step in range(-4, 5))
DETUNINGS = (-0.1, 0.0, 0.1)
VALUES = ("stiffness", "damping", "cubic_stiffness")


def absorber_responses(
    machine, mass, frequencies, force_shares=SHARES, *, detunings=DETUNINGS, band=None
):
    """Return the displacements of a machine without and with tuned absorbers.

    Parameters
    ----------
    machine : Machine
    mass : float, str or pint.Quantity
        Mass of each absorber, kg.
    frequencies : sequence of float
        Increasing forcing frequencies, Hz.
    force_shares : sequence of float
        Increasing factors of the machine's excitation.
    detunings : sequence of float
        Increasing shares by which the absorbers' springs are stiffer than designed.
    band : sequence of 2 floats, optional
        Lowest and highest frequency, Hz, over which the absorbers are tuned; all frequencies if
        not given (`tuning.exact_absorber`).

    Returns
    -------
    xarray.Dataset
        In SI units, over `competitor`, `detuning`, `frequency` and `force_share`: the largest
        displacements (mm) of the largest and of the smallest stable motion, how many stable
        periodic motions there are, and how the search for them ended; over `competitor` and
        `detuning` the stiffness, damping and cubic stiffness of the absorbers. The bare machine
        has the same values at all detunings. The attribute `remarks` says in words, keyed by
        competitor, why one is not possible.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it, in SI units.
    """
    mass = check_mass(machine, mass)
    if machine.force == 0:
        raise ValueError("force = 0 N: must be greater than 0 N (without excitation all rests)")
    frequencies = _increasing(
        "frequencies",
        [machine.check_frequency(f"frequencies[{i}]", each) for i, each in enumerate(frequencies)],
    )
    shares = _increasing("force_shares", check_numbers("force_shares", force_shares, above=0))
    detunings = _increasing("detunings", check_numbers("detunings", detunings, above=-1, most=10))
    absorbers, remarks = competitors(machine, mass, band)
    shape = (len(COMPETITORS), len(detunings), len(frequencies), len(shares))
    found = _not_possible(shape)
    for i, name in enumerate(COMPETITORS):
        if name in remarks:
            continue
        for j, detuning in enumerate(detunings):
            if absorbers[name] is None and j:
                values = {key: found[key][i, 0] for key in found}
            else:
                absorber = absorbers[name] and absorbers[name].detuned(detuning)
                values = _absorber_values(machine, absorber)
                values |= _responses(machine, absorber, frequencies, shares)
            for key, value in values.items():
                found[key][i, j] = value
    scales = machine.scales
    coordinates = {
        "competitor": list(COMPETITORS),
        "detuning": detunings,
        "frequency": [scales.from_si(each, "frequency") for each in frequencies],
        "force_share": shares,
    }
    parameters = {"absorber_mass_ratio": mass / machine.mass, "band": band and list(band)}
    data = dataset(found, coordinates, parameters, "A machine without and with tuned absorbers")
    return in_si(data, machine).assign_attrs(remarks=json.dumps(remarks))


def competitors(machine, mass, band=None):
    """Return the absorbers keyed by competitor, and remarks on those that are not possible.

    The absorber of the bare machine is None.
    """
    absorbers, remarks = {"bare": None}, {}
    for name, design in (("tuned", exact_absorber), ("nonlinear", nonlinear_absorber)):
        if machine.linear_stiffness == 0:
            remarks[name] = (
                "not possible: the machine has no linear stiffness, so that its natural frequency "
                "depends on the amplitude alone and there is none to tune to"
            )
        elif name == "nonlinear" and machine.cubic_stiffness == 0:
            remarks[name] = "not apart: on a machine with a linear spring it is the tuned absorber"
        else:
            absorbers[name] = design(machine, mass, band)
    return absorbers, remarks


def _responses(machine, absorber, frequencies, shares):
    """Return values over frequencies and shares, keyed by variable, in the machine's scales."""
    shape = len(frequencies), len(shares)
    linear = machine.cubic_stiffness == 0 and (absorber is None or absorber.cubic_stiffness == 0)
    if linear:
        sizes = machine.scales.from_si(response(machine, absorber, frequencies), "displacement")
        most = least = np.outer(sizes, shares)
        count = np.ones(shape)
    else:
        motions = stable_motions(problems_of(machine, absorber, frequencies, shares))
        total = shape[0] * shape[1]
        most, least = np.full(total, -np.inf), np.full(total, np.inf)
        np.maximum.at(most, motions.index, motions.orbits.displacement)
        np.minimum.at(least, motions.index, motions.orbits.displacement)
        count = np.bincount(motions.index, minlength=total).reshape(shape)
        most, least = (
            np.where(np.isfinite(each), each, np.nan).reshape(shape) for each in (most, least)
        )
    status = np.where(
        count, flag("competitor_status", "found"), flag("competitor_status", "not_found")
    )
    return {
        "competitor_displacement": most,
        "competitor_least_displacement": least,
        "competitor_motions": count,
        "competitor_status": status,
    }


def _absorber_values(machine, absorber):
    """Return stiffness, damping and cubic stiffness in the scales of the machine."""
    if absorber is None:
        return {}
    return {
        f"absorber_{name}": machine.scales.from_si(getattr(absorber, name), name) for name in VALUES
    }


def _not_possible(shape):
    """Return arrays for all competitors, filled as if none were possible."""
    found = {
        "competitor_displacement": np.full(shape, np.nan),
        "competitor_least_displacement": np.full(shape, np.nan),
        "competitor_motions": np.zeros(shape, int),
        "competitor_status": np.full(shape, flag("competitor_status", "not_possible")),
    }
    return found | {f"absorber_{name}": np.full(shape[:2], np.nan) for name in VALUES}


def _increasing(name, values):
    values = np.asarray(values, float)
    if len(values) == 0 or np.any(np.diff(values) <= 0):
        raise ValueError(f"{name} = {shown(values.tolist())}: must be increasing, and at least one")
    return values
