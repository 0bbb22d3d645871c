"""Displacements of a machine alone and with a tuned absorber in place of an impact damper."""

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.design.absorbers import (
    check_mass,
    den_hartog_absorber,
    exact_absorber,
    response,
)
from impact_damper.design.labelled import labelled
from impact_damper.model.bounds import shown
from impact_damper.model.checks import check_numbers
from impact_damper.model.machine import Machine

COMPETITORS = ("bare", "tuned")
# Force shares: factors of the machine's excitation, from a quarter to four.
SHARES = tuple(2.0 ** (step / 2) for step in range(-4, 5))
DETUNINGS = (-0.1, 0.0, 0.1)


def absorber_responses(
    machine, mass, frequencies, force_shares=SHARES, *, detunings=DETUNINGS, band=None
):
    """Return the displacements of a machine alone and with a tuned absorber.

    Parameters
    ----------
    machine : Machine
    mass : float, str or pint.Quantity
        Mass of the absorber, kg.
    frequencies : sequence of float
        Increasing forcing frequencies, Hz.
    force_shares : sequence of float
        Increasing factors of the machine's excitation.
    detunings : sequence of float
        Increasing relative changes of the absorber's stiffness; 0.1 is 10 per cent stiffer than
        designed.
    band : sequence of 2 floats, optional
        Lowest and highest frequency, Hz, over which the absorber is tuned; by default all
        frequencies or, for a machine with `base_acceleration`, those from the first to the last of
        `frequencies`.

    Returns
    -------
    xarray.Dataset
        Displacements over competitor, detuning, frequency and force share, stiffness and damping
        of the absorber, and `competitor_status`. The values "exact" hold for a linear machine; with
        a cubic spring they are the balance of one harmonic.
    """
    mass = check_mass(machine, mass)
    frequencies, shares = check_grid(machine, frequencies, force_shares)
    detunings = _increasing("detunings", check_numbers("detunings", detunings, above=-1, most=10))
    if band is None and machine.base_acceleration is not None:
        band = frequencies[[0, -1]]
    sizes = np.full((len(COMPETITORS), len(detunings), len(frequencies), len(shares)), np.nan)
    sizes[0] = response(machine, None, frequencies, shares)
    springs = np.full((2, *sizes.shape[:2]), np.nan)
    kind = "one_harmonic" if machine.cubic_stiffness else "exact"
    status, closed = [kind, "not_possible"], {}
    if machine.linear_stiffness:
        status[1] = kind
        absorber = exact_absorber(machine, mass, band)
        for column, detuning in enumerate(detunings):
            built = absorber.detuned(detuning)
            sizes[1, column] = response(machine, built, frequencies, shares)
            springs[:, 1, column] = built.stiffness, built.damping
        made = den_hartog_absorber(machine, mass)
        closed = {"den_hartog_stiffness": made.stiffness, "den_hartog_damping": made.damping}
    values = closed | {
        "competitor_displacement": 1e3 * sizes,
        "competitor_status": [flag("competitor_status", each) for each in status],
        "absorber_stiffness": springs[0],
        "absorber_damping": springs[1],
    }
    return labelled(
        values,
        competitor=list(COMPETITORS),
        detuning=detunings,
        frequency=frequencies,
        force_share=shares,
    )


def check_grid(machine, frequencies, force_shares):
    """Return frequencies and force shares as arrays."""
    if not isinstance(machine, Machine):
        raise TypeError(f"machine = {shown(machine)}: must be a Machine")
    if machine.force == 0:
        raise ValueError("force = 0 N: must be greater than 0 N (without excitation nothing moves)")
    listed = frequencies if isinstance(frequencies, list | tuple) else np.atleast_1d(frequencies)
    checked = [machine.check_frequency(f"frequencies[{i}]", each) for i, each in enumerate(listed)]
    shares = check_numbers("force_shares", force_shares, above=0, most=1e6)
    return _increasing("frequencies", checked), _increasing("force_shares", shares)


def _increasing(name, values):
    values = np.asarray(values, float)
    if len(values) == 0 or np.any(np.diff(values) <= 0):
        raise ValueError(
            f"{name} = {shown(values.tolist())}: must be increasing, and at least one value"
        )
    return values
