"""Periodic orbits as labelled datasets: one orbit, or branches of orbits over a parameter."""

import numpy as np
import xarray as xr
from tqdm import tqdm

from impact_damper.data.datasets import dataset, flag, from_si
from impact_damper.model import bounds
from impact_damper.model.arguments import (
    carried_phase,
    read_forced,
    read_span,
    read_state,
    read_system,
)
from impact_damper.model.families import LINEAR, family_of, read_followed
from impact_damper.motions.records import MOTION, phase_of
from impact_damper.motions.simulate import COMPONENTS, CONTACT
from impact_damper.motions.strobe_map import STROBE
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit
from impact_damper.orbits.switching import follow_others, met_by

# A branch of period n > 1 ends after more than BEYOND / n unstable orbits in a row.
BEYOND = 300


@bounds.names_arguments
def periodic_orbit(system, damper, frequency, state, *, period=1, phase=None):
    """Find the periodic orbit near a state by Newton's method.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
    frequency : float
        Forcing frequency W, or Hz for a machine.
    state : sequence of 4 floats, or 2 without a damper; or xarray.DataArray
        Z1, Z1', Z2, Z2' near the orbit, for a machine in m and m/s.
    period : int
        Period n of the orbit in forcing cycles.
    phase : float, optional
        Phase W T of the state, radian. By default the phase stored with the state, if the state
        comes from a dataset, otherwise pi/2.

    Returns
    -------
    xarray.Dataset
        For the orbit: the variables that `orbit_branches` returns for a `point`. In the state
        returned the loose mass touches no wall. For each `contact`: the wall, and the time and the
        relative velocity Z2' at the beginning and at the end.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range.
    ArithmeticError
        If Newton's method does not converge.

    Warns
    -----
    UserWarning
        If the orbit has a shorter period, a divisor of `period`.

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
        words = f"the orbit found already repeats after a divisor of {period}"
        bounds.warn(f"period = {period}: {words}")
    data = orbit_variables([(model.frequency, orbit)]) | {"orbit_branch": np.zeros(1, int)}
    data |= dict(zip(CONTACT, orbit.contacts.T, strict=True))
    made = model.describe() | {"period": int(period), "state": state.tolist()}
    return dataset(data, {"component": list(COMPONENTS)}, made, "Periodic orbit", model)


@bounds.names_arguments
def orbit_branches(
    system,
    damper,
    frequency=None,
    state=None,
    *,
    span,
    parameter="frequency",
    period=1,
    motions=None,
    progress=None,
):
    """Follow branches of periodic orbits, stable or not, over a parameter.

    With a frequency and a state, the function follows the branch of the orbit near the state, and
    no other. With `motions`, it follows over the frequency every branch through a settled motion,
    and further branches in these cases:

    - A branch of period 1 or 3 loses its symmetry. The new branch is followed.
    - A branch of period 1 or 3 doubles its period. The new branch is followed if the old one has
      stable orbits there.
    - A branch of another period loses its symmetry or doubles its period. The new branch is
      followed if it has a period up to 9, and both branches have stable orbits there.
    - A branch with a period up to 4 ends on a branch of symmetric orbits, or on a branch of half
      the period. The branch on which it ends is followed.

    With `motions`, a branch of period n > 1 ends after more than 300/n unstable orbits in a row.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
    frequency, state
        As in `periodic_orbit`; not given with `motions`.
    span : tuple of float
        Least and greatest value of the parameter.
    parameter : str
        frequency, damping, cubic, force, unbalance, mass_ratio, clearance, restitution or
        contact_stiffness; for a machine cubic_stiffness, mass and gap in place of
        cubic, mass_ratio and clearance.
    period : int
        Period of the orbit near the state, in forcing cycles.
    motions : list of xarray.Dataset, optional
        Results of `frequency_response` for this system and damper.
    progress : str, optional
        Title of a progress bar, with `motions`.

    Returns
    -------
    xarray.Dataset
        For each `point`, in order along the branches, an orbit: the parameter, the largest
        displacement, stability, Floquet multipliers, contacts, the state and its phase, the error
        with which the orbit closes (residual), and the relative error of the determinant of the
        monodromy matrix. `orbit_status` says how reliable the orbit is. For each `event`: its kind,
        which is fold, symmetry breaking (a loss of symmetry), period doubling, Neimark-Sacker
        point, grazing (a contact appears or vanishes in flight) or merging (two contacts with one
        wall become one, or the reverse). For each branch: why it ends at its first point (`edge`
        lower) and at its last (upper). With `motions`: `seeds`, the number of settled motions (with
        a damper only motions with contacts), and `seeds_lost`, the number of seeds near which no
        orbit of the seed's period was found. A branch and its mirror image count as one branch.

    Raises
    ------
    TypeError, ValueError
        If an argument is of another type or out of range.
    ArithmeticError
        If Newton's method finds no orbit, or only an orbit whose period is a divisor of `period`.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> state = (0.006, 0.187, 0.002, -2.408)
    >>> branch = idm.orbit_branches(oscillator, damper, 2.0, state, span=(1.8, 2.2))
    >>> idm.decode(branch.event_kind).values.tolist()
    []
    >>> response = idm.frequency_response(oscillator, damper, [1.95, 2.0], starts=8)
    >>> found = idm.orbit_branches(oscillator, damper, motions=[response], span=(1.9, 2.1))
    >>> found.sizes["branch"]
    1
    """
    if motions is not None:
        return _all_branches(system, damper, span, motions, progress)
    model = read_forced(system, damper, frequency)
    parameter, span = read_followed(model, parameter, span)
    family, value, ends = family_of(*model[:3], parameter, span)
    state, orbit = _checked_orbit(model, state, period, None)
    if orbit.repeats_sooner():
        raise ArithmeticError(
            f"period = {period}: the orbit near the state repeats after a divisor of {period}; "
            "give the divisor as the period, or a state closer to the orbit"
        )
    branch = follow_branch(family, orbit, value, ends)
    made = model.describe() | {"period": int(period), "state": state.tolist()}
    made |= {"parameter": parameter, "span": list(span)}
    back = float if parameter in LINEAR else np.exp
    return branches_dataset([branch], back, made, "Branch of periodic orbits", model)


def _all_branches(system, damper, span, motions, progress):
    model = read_system(system, damper)
    damper = model.damper
    span = read_span(model.scales, "span", span, "frequency", **bounds.FREQUENCY_RANGE)
    if not isinstance(motions, list) or not all(isinstance(each, xr.Dataset) for each in motions):
        raise TypeError(f"motions = {bounds.shown(motions)}: must be a list of datasets of motions")
    motions = [from_si(each, model.scales) for each in motions]
    family, _, _ = family_of(model.oscillator, damper, span[0], "frequency", span)

    def follow(orbit, value):
        beyond = np.inf if orbit.periods == 1 else BEYOND / orbit.periods
        return follow_branch(family, orbit, value, span, beyond)

    branches, lost = [], 0
    seeds = sorted(_seeds(motions, damper), key=lambda seed: seed[:3])
    with tqdm(seeds, desc=progress, disable=progress is None, mininterval=1.0) as bar:
        for period, frequency, _, state in bar:
            orbit = find_orbit(family(frequency), state, period)
            if not orbit.converged or orbit.repeats_sooner():
                lost += 1
            elif not any(branch.holds(orbit, frequency) for branch in branches):
                branches.append(follow(orbit, frequency))
                bar.set_postfix(branches=len(branches))
    follow_others(branches, follow)
    parameters = model.describe() | {"parameter": "frequency"}
    title, counts = "Branches of periodic orbits", {"seeds": len(seeds), "seeds_lost": lost}
    return branches_dataset(branches, float, parameters, title, model, counts)


def _checked_orbit(model, state, period, phase):
    bounds.check_count("period", period, most=1000)
    if phase is None:
        carried = carried_phase(state)
        phase = STROBE if carried is None else carried
    bounds.check_number("phase", phase, least=-1e6, most=1e6)
    state = read_state(model, state)
    orbit = find_orbit(model.pack(), state, period, phase)
    if not orbit.converged:
        raise ArithmeticError(
            f"no orbit of period {period} found: Newton's method left a residual of "
            f"{orbit.residual:.2g}; a state closer to an orbit, or another period, may help"
        )
    return state, orbit


def _seeds(motions, damper):
    for data in motions:
        chosen = data["outcome"].values == flag("outcome", "settled")
        if damper is not None:
            chosen &= data["contacts"].values > 0
        for row, column in zip(*np.nonzero(chosen), strict=True):
            motion = data.isel(frequency=row, motion=column)
            frequency, size = float(motion["frequency"]), float(motion["maximum_displacement"])
            yield int(motion["period"]), frequency, size, motion["state"].values


# An orbit is near a grazing if a contact begins with |Z2'| below SLOW. The multipliers of such an
# orbit hold only for very small disturbances.
SLOW = 0.01


def _status(orbit):
    if not orbit.converged:
        return flag("orbit_status", "not_converged")
    slow = orbit.touching > 0 and orbit.least_speed < SLOW
    return flag("orbit_status", "near_grazing" if slow else "regular")


def orbit_variables(pairs):
    """Return the dataset variables that describe orbits, from pairs (parameter, `Orbit`)."""
    values, orbits = zip(*pairs, strict=True) if pairs else ((), ())
    records = np.array([orbit.record for orbit in orbits], MOTION)
    first, second = records["harmonic_displacement"], records["harmonic_relative"]
    multipliers = np.array([orbit.multipliers for orbit in orbits]).reshape(-1, 4)
    stable = [flag("stability", "stable" if orbit.stable else "unstable") for orbit in orbits]
    return {
        "followed_value": np.array(values, float),
        "orbit_displacement": records["maximum_displacement"],
        "orbit_stability": np.array(stable, int),
        "orbit_status": np.array([_status(orbit) for orbit in orbits], int),
        "orbit_contacts": records["contacts"],
        "orbit_asymmetry": records["asymmetry"],
        "orbit_amplitude": np.abs(first),
        "orbit_phase_relative": phase_of(first, second),
        "orbit_phase_loose": phase_of(first, first - second),
        "orbit_phase": np.array([orbit.phase for orbit in orbits]),
        "orbit_state": np.array([orbit.state for orbit in orbits]).reshape(-1, 4),
        "orbit_residual": np.array([orbit.residual for orbit in orbits]),
        "orbit_multiplier_real": multipliers.real,
        "orbit_multiplier_imaginary": multipliers.imag,
        "liouville_error": np.array([orbit.liouville_error for orbit in orbits]),
        "least_speed": np.array([orbit.least_speed for orbit in orbits]),
        "orbit_restitution": np.array([orbit.restitution for orbit in orbits]),
    }


def branches_dataset(branches, back, parameters, title, model=None, more=None):
    """Return a dataset of branches, with the points and events of each, and with variables `more`.

    back(`Point.value`) is stored as the value of the parameter: `back` is np.exp if `Point.value`
    is a logarithm, otherwise float. `parameters`, `title` and `model` are passed to `dataset`.
    """
    points = [(back(point.value), point.orbit) for branch in branches for point in branch.points]
    sizes = [len(branch.points) for branch in branches]
    events = [(number, *pair) for number, branch in enumerate(branches) for pair in branch.events]
    orbits = [event.point.orbit for _, _, event in events]
    met = [[met_by(branches, number, edge) for edge in (0, 1)] for number in range(len(branches))]
    data = orbit_variables(points) | {
        "orbit_branch": np.repeat(np.arange(len(branches)), sizes),
        "branch_period": np.array([branch.points[0].orbit.periods for branch in branches], int),
        "branch_events_lost": np.array([branch.lost for branch in branches], int),
        "branch_end": np.array(
            [[flag("branch_end", end) for end in branch.ends] for branch in branches]
        ).reshape(-1, 2),
        "branch_met": np.array(met, int).reshape(-1, 2),
        "event_branch": np.array([number for number, _, _ in events], int),
        "event_place": np.array([place for _, place, _ in events], int),
        "event_kind": np.array([flag("event_kind", event.kind) for _, _, event in events], int),
        "event_value": np.array([back(event.point.value) for _, _, event in events]),
        "event_displacement": np.array([o.record["maximum_displacement"] for o in orbits]),
        "event_speed": np.array([orbit.least_speed for orbit in orbits]),
        "walls_before": np.array([event.before for _, _, event in events], object),
        "walls_after": np.array([event.after for _, _, event in events], object),
    }
    coordinates = {"component": list(COMPONENTS), "edge": ["lower", "upper"]}
    return dataset(data | (more or {}), coordinates, parameters, title, model)
