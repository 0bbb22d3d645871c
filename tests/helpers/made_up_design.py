"""An invented dataset of `design_damper` in round numbers, for tables, figures and pages."""

import json
from functools import cache

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.design.task import labelled

FREQUENCY = np.linspace(26.0, 34.0, 5)
MACHINE = {
    "mass": 12.0,
    "linear_stiffness": 2e5,
    "cubic_stiffness": 4e9,
    "damping_ratio": 0.005,
    "force": 40.0,
}
SETTLING = {"tolerance": 1e-9, "patience": 300, "limit": 1500, "watched": 50}
ADDITIONS = ["response", "orbits", "forces", "masses", "transients", "competitors"]


def made_up_design(decision="build", told=None, **changed):
    """Return the dataset. `changed` replaces values of variables, `told` replaces parameters."""
    data = _complete(decision).copy()
    for name, values in changed.items():
        data[name] = (data[name].dims, np.asarray(values, data[name].dtype), data[name].attrs)
    made = MACHINE | {"gap": 7e-3, "damper_mass": 0.6, "restitution": 0.7}
    asked = {
        "machine": MACHINE,
        "mass": 0.6,
        "restitution": 0.7,
        "band": [26.0, 34.0],
        "starts": 96,
        "share": 0.95,
        "seed": 1995,
        "gap": None,
        "tolerances": {"gap": 0.1, "restitution": 0.1},
        "gravity": 0.0,
        "friction": 0.0,
        "settling": SETTLING,
        "compared_settling": SETTLING | {"patience": 150, "limit": 900},
    }
    return data.assign_attrs(
        machine=json.dumps(made | {"contact_stiffness": 2e7, "gravity": 0.0, "friction": 0.0}),
        parameters=json.dumps(asked | (told or {})),
        name="made_up",
    )


@cache
def _complete(decision):
    """Return all variables, which are made once for each decision."""
    data = labelled(
        _decision(decision) | _promise() | _search() | _maps(),
        frequency=FREQUENCY,
        promise_frequency=FREQUENCY,
        searched_gap=[5.0, 6.0, 7.0, 8.0, 9.0],
        side=["lower", "upper"],
        varied=["gap", "restitution", "contact_stiffness", "stiffness", "damping", "force"],
        other_mass=[0.3, 0.6, 1.2],
        operating_frequency=FREQUENCY,
        force_share=[0.25, 0.5, 1.0, 2.0, 4.0],
        competitor=["bare", "tuned"],
        detuning=[-0.1, 0.0, 0.1],
        addition=ADDITIONS,
    )
    data = data.merge(labelled(_motions()))
    data = data.merge(labelled(_orbits()))
    data = data.merge(_transients())
    data = data.merge(labelled(_absorbers()))
    return data


def _decision(decision):
    return {
        "design_gap": 7.0,
        "decision": flag("decision", decision),
        "displacement_limit": np.nan,
        "limit_status": flag("limit_status", "none"),
        "promised_displacement": 1.0,
        "promised_frequency": 30.0,
        "promised_set": 2,
        "promised_share": 0.95,
        "promise_starts": 96,
        "promise_rank": 2,
        "gap_promised_displacement": 0.9,
        "confirmation": flag("confirmation", "confirmed"),
        "peak_status": flag("peak_status", "known"),
        "record_status": flag("record_status", "known"),
        "largest_bare_displacement": 10.0,
        "largest_bare_frequency": 34.0,
        "tuned_displacement": 0.5,
        "detuned_displacement": 0.6,
        "least_ratio": 0.05,
        "worst_ratio": 0.15,
        "worst_ratio_frequency": 26.0,
        "branch_frequency": 30.0,
        "lost_gap": [np.nan, 8.0],
        "lost_displacement": [np.nan, 6.0],
        "lost_kind": [flag("lost_kind", "none"), flag("lost_kind", "jump")],
        "range_gap": [[2.0, 2.5], [6.2, 7.9]],
        "range_displacement": [1.1, 0.95],
        "best_orbit_gap": 8.8,
        "best_orbit_displacement": 0.4,
        "best_orbit_beyond": flag("best_orbit_beyond", "yes"),
        "addition_status": [flag("addition_status", "computed")] * len(ADDITIONS),
    }


def _promise():
    factors = np.ones((3, 6))
    factors[1:, 0] = 0.9, 1.1
    return {
        "promise_factor": factors,
        "promise_displacement": np.outer([0.8, 0.9, 1.0], [0.9, 0.95, 1.0, 0.9, 0.8]),
        "promise_bare_displacement": np.linspace(6.0, 10.0, 5),
        "unsettled_share": np.zeros(5),
        "settling_late": np.full(5, 100.0),
    }


def _search():
    return {
        "searched_displacement": [0.9, 0.9, 0.8, 0.8, 6.0],
        "searched_tolerated": [0.9, 0.9, 0.9, 6.0, 6.0],
    }


def _maps():
    """Return the map over the force, the other masses, and the costs of the largest motions."""
    return {
        "force_map_displacement": np.tile([0.2, 0.4, 0.8, 6.0, 9.0], (5, 1)),
        "other_gap": [14.0, 7.0, 3.0],
        "other_displacement": [5.0, 1.0, 0.8],
        "other_force": [900.0, 600.0, 1500.0],
        "reached_displacement": np.linspace(0.8, 0.4, 5),
        "untouched_displacement": np.full(5, np.nan),
        "impact_rate_by_frequency": np.linspace(14.0, 10.0, 5),
        "contact_force_by_frequency": np.linspace(600.0, 500.0, 5),
        "penetration_by_frequency": np.full(5, 0.03),
        "impact_speed_by_frequency": np.full(5, 0.2),
        "impact_power_by_frequency": np.full(5, 0.04),
        "acceleration_by_frequency": np.linspace(9.0, 8.0, 5),
        "absolute_displacement_by_frequency": np.full(5, np.nan),
        "pressure_by_frequency": np.full(5, np.nan),
        "yields_by_frequency": np.full(5, flag("yields_by_frequency", "unknown")),
    }


def _motions():
    """Return a settled motion and a chaotic motion at each frequency."""
    sizes = np.stack([np.linspace(0.5, 0.3, 5), np.linspace(0.8, 0.4, 5)], axis=1)
    outcomes = [flag("outcome", "settled"), flag("outcome", "chaotic")]
    return {
        "maximum_displacement": sizes,
        "outcome": np.tile(outcomes, (5, 1)),
        "motion_starts": np.tile([40, 33], (5, 1)),
        "missed_share": 0.04,
    }


def _orbits():
    return {
        "gap_of_orbit": [6.0, 7.0, 8.0, 9.0],
        "displacement_by_gap": [0.8, 0.7, 0.5, 0.4],
        "modulus_by_gap": [1.2, 0.9, 0.8, 1.1],
    }


def _transients():
    """Return sweeps up and down, and a ring-down that decays at two rates."""
    turning = np.linspace(20.0, 36.0, 9)
    sizes = np.stack([np.linspace(1.0, 9.0, 9), np.full(9, 0.5)])
    time = np.linspace(0.0, 10.0, 21)
    values = {
        "sweep_frequency": [turning, turning[::-1]],
        "sweep_envelope": [sizes, sizes],
        "ring_time": [time, time],
        "ring_envelope": 2 * np.exp([-0.5 * time, -2 * time]),
    }
    return labelled(values, direction=["up", "down"], equipment=["bare", "damped"])


def _absorbers():
    """Return displacements in proportion to the excitation; the tuned absorber is the best."""
    worst = np.array([10.0, 0.5])
    share = np.array([0.25, 0.5, 1.0, 2.0, 4.0])
    sizes = worst[:, None, None, None] * share * np.ones((2, 3, 5, 1))
    sizes[:, [0, 2]] *= 1.2
    return {
        "competitor_displacement": sizes,
        "competitor_status": [flag("competitor_status", "one_harmonic")] * 2,
        "absorber_stiffness": np.tile([[np.nan], [9e3]], 3),
        "absorber_damping": np.tile([[np.nan], [20.0]], 3),
    }
