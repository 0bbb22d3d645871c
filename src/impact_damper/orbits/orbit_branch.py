"""Periodic orbits as labelled datasets: one orbit, or its branch over one parameter.

A branch is the curve of the periodic orbits over a parameter. Orbits may be stable or not, of any
period, and touch the walls in any sequence.

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass and W T
the phase of the forcing.
"""

import warnings

import numpy as np

from impact_damper.data.datasets import dataset
from impact_damper.model.arguments import carried_phase, read_forced, read_state
from impact_damper.model.bounds import check_count, check_number
from impact_damper.model.families import LINEAR, family_of, read_followed
from impact_damper.model.names import names_arguments
from impact_damper.motions.simulate import COMPONENTS
from impact_damper.orbits.branch_datasets import branches_dataset, orbit_variables
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.orbit import STROBE
from impact_damper.orbits.shooting import find_orbit


@names_arguments
def periodic_orbit(system, damper, frequency, state, *, period=1, phase=None):
    """Find the periodic orbit near a state by Newton's method.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
    frequency : float
        Forcing frequency W, or Hz for a machine.
    state : sequence of 4 floats, or 2 without a damper; or xarray.DataArray
        Z1, Z1', Z2, Z2' near the orbit.
    period : int
        Period n of the orbit in forcing cycles.
    phase : float, optional
        Phase W T of the state, radian. The default is the phase stored with the state of a dataset,
        and pi/2 for other states.

    Returns
    -------
    xarray.Dataset
        The variables of `orbit_branch`, with the orbit as the only point. Its state is given at a
        phase at which no wall is touched. For each `contact`: the wall, and the times and the
        relative speeds Z2' at its beginning and end.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range.
    ArithmeticError
        If Newton's method does not converge.

    Warns
    -----
    UserWarning
        If the orbit repeats after a divisor of the period.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> start = (0.006, 0.187, 0.002, -2.408)
    >>> orbit = idm.periodic_orbit(oscillator, damper, 2.0, state=start)
    >>> idm.decode(orbit.orbit_stability).item(), round(orbit.orbit_displacement.item(), 6)
    ('stable', 0.057734)
    """
    model = read_forced(system, damper, frequency)
    state, orbit = _checked_orbit(model, state, period, phase)
    if orbit.repeats_sooner():
        warnings.warn(
            f"period = {period}: the orbit found already repeats after a divisor of {period}",
            stacklevel=2,
        )
    log = orbit.contacts
    data = orbit_variables([(model.frequency, orbit)]) | {
        "orbit_branch": np.zeros(1, int),
        "contact_wall": log[:, 0],
        "contact_begin": log[:, 1],
        "contact_end": log[:, 2],
        "approach_velocity": log[:, 3],
        "departure_velocity": log[:, 4],
    }
    made = model.describe() | {"period": int(period), "state": state.tolist()}
    return dataset(data, {"component": list(COMPONENTS)}, made, "Periodic orbit", model)


@names_arguments
def orbit_branch(system, damper, frequency, state, *, span, parameter="frequency", period=1):
    """Find the orbit near a state, and follow its branch over one parameter.

    Parameters
    ----------
    system, damper, frequency, state, period
        As in `periodic_orbit`.
    span : tuple of float
        Least and greatest value of the parameter.
    parameter : str
        frequency, damping, cubic, force, unbalance, mass_ratio, clearance, restitution or
        contact_stiffness; for a machine cubic_stiffness, mass and clearance_each_side in place of
        cubic, mass_ratio and clearance.

    Returns
    -------
    xarray.Dataset
        For each `point`, in order along the branch, an orbit: the parameter, the largest
        displacement, stability, Floquet multipliers, contacts, the state and its phase, the
        residual, and the relative error of the determinant, which Liouville's theorem gives.
        `orbit_status` says how reliable these numbers are. For each `event` its kind: fold,
        symmetry breaking, period doubling, Neimark-Sacker bifurcation, grazing (a contact appears
        or vanishes in flight) or merging (two contacts with a wall become one). For each (branch,
        edge), that is for each end: the reason why the branch ends.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range.
    ArithmeticError
        If Newton's method finds no orbit near the state, or an orbit that repeats after a divisor
        of the period.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> start = (0.006, 0.187, 0.002, -2.408)
    >>> branch = idm.orbit_branch(oscillator, damper, 2.0, start, span=(1.8, 2.2))
    >>> idm.decode(branch.event_kind).values.tolist()
    []
    """
    model = read_forced(system, damper, frequency, exact=parameter != "frequency")
    parameter, span = read_followed(model, parameter, span)
    family, value, ends = family_of(*model[:3], parameter, span)
    state, orbit = _checked_orbit(model, state, period, None)
    if orbit.repeats_sooner():
        raise ArithmeticError(
            f"period = {period}: the orbit near the state repeats after a divisor of {period}; "
            "give the divisor as the period, or a state closer to the orbit"
        )
    branch = follow_branch(family, orbit, value, ends)
    made = model.describe() | {
        "period": int(period),
        "parameter": parameter,
        "state": state.tolist(),
        "span": list(span),
    }
    back = float if parameter in LINEAR else np.exp
    return branches_dataset([branch], back, made, "Branch of periodic orbits", model)


def _checked_orbit(model, state, period, phase):
    """Check arguments; return the state and the orbit near it; raises as `periodic_orbit` does."""
    check_count("period", period, most=1000)
    if phase is None:
        carried = carried_phase(state)
        phase = STROBE if carried is None else carried
    check_number("phase", phase, least=-1e6, most=1e6)
    state = read_state(model, state)
    orbit = find_orbit(model.pack(), state, period, phase)
    if not orbit.converged:
        raise ArithmeticError(
            f"no orbit of period {period} found: Newton's method left a residual of "
            f"{orbit.residual:.2g}; a state closer to it, or another period, is needed"
        )
    return state, orbit
