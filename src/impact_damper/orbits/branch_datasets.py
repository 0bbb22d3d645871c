"""Variables of orbits and of branches for datasets."""

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.motions.records import phase_of
from impact_damper.motions.simulate import COMPONENTS
from impact_damper.orbits.switching import met_by

# A contact counts as near grazing if the relative speed at its beginning is below SLOW. Floquet
# multipliers then describe very small disturbances only: the effect of a disturbance d also has a
# term with the power 3/2 of d, whose coefficient grows near grazing.
SLOW = 0.01


def _status(orbit):
    """Return the flag `orbit_status`: how reliable an orbit and its multipliers are."""
    if not orbit.converged:
        return flag("orbit_status", "not_converged")
    slow = orbit.touching > 0 and orbit.least_speed < SLOW
    return flag("orbit_status", "near_grazing" if slow else "regular")


def orbit_variables(pairs):
    """Return the variables with the dimension `point`, a dict.

    `pairs` is a list of pairs of a value of the parameter and an `Orbit`.
    """
    values, orbits = zip(*pairs, strict=True) if pairs else ((), ())
    records = [orbit.record for orbit in orbits]
    first, second = (
        np.array([record[name] for record in records], complex)
        for name in ("harmonic_displacement", "harmonic_relative")
    )
    multipliers = np.array([orbit.multipliers for orbit in orbits]).reshape(-1, 4)
    stable = [flag("stability", "stable" if orbit.stable else "unstable") for orbit in orbits]
    return {
        "followed_value": np.array(values, float),
        "orbit_displacement": np.array([record["maximum_displacement"] for record in records]),
        "orbit_stability": np.array(stable, int),
        "orbit_status": np.array([_status(orbit) for orbit in orbits], int),
        "orbit_contacts": np.array([record["contacts"] for record in records]),
        "orbit_asymmetry": np.array([record["asymmetry"] for record in records]),
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
    """Return a dataset of branches, in the units of the model; dimensionless without it."""
    points = [(back(point.value), point.orbit) for branch in branches for point in branch.points]
    sizes = [len(branch.points) for branch in branches]
    events = [
        (number, place, event)
        for number, branch in enumerate(branches)
        for place, event in branch.events
    ]
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
