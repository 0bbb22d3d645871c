"""An invented dataset of `design_damper` in round numbers, for tables, figures and pages."""

import json

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
# A share of 1 with its interval.
SURE = [1.0, 0.95, 1.0]


def made_up_design(choice="robust", promise="robust_kept", told=None, **changed):
    """Return the dataset; `changed` replaces values of variables, and `told` parameters."""
    data = labelled(
        _screening() | _comparison(choice) | _deviations(promise) | _masses(),
        frequency=FREQUENCY,
        screened_gap=[6.0, 7.0, 8.0],
        coarse_gap=[5.0, 6.0, 7.0, 8.0, 9.0],
        candidate_gap=[6.0, 7.0, 8.0, 9.0],
        side=["lower", "upper"],
        other_mass=[0.3, 0.6, 1.2],
        operating_frequency=FREQUENCY,
        force_share=[0.25, 0.5, 1.0, 2.0, 4.0],
        map_gap=[4.0, 6.0, 8.0],
        map_restitution=[0.5, 0.75, 1.0],
        competitor=["bare", "tuned"],
        detuning=[-0.1, 0.0, 0.1],
    )
    data = data.merge(labelled(_motions()))
    data = data.merge(labelled(_branches(), changed=["force", "gap", "unbalance"]))
    data = data.merge(_transients())
    data = data.merge(labelled(_absorbers()))
    data["followed_value"] = ("point", np.linspace(*FREQUENCY[[0, -1]], 6))
    for name, values in changed.items():
        data[name] = (data[name].dims, np.asarray(values, data[name].dtype), data[name].attrs)
    made = MACHINE | {"gap": 7e-3, "damper_mass": 0.6, "restitution": 0.7}
    asked = {
        "machine": MACHINE,
        "mass": 0.6,
        "restitution": 0.7,
        "band": [26.0, 34.0],
        "starts": 73,
        "share": 0.95,
        "seed": 1995,
        "tolerances": {"gap": 0.1, "restitution": 0.1},
        "later_displacement": 1.5,
        "holdable": 0.01,
        "lead": 200,
        "longest": 3000,
        "unseen": 1000,
        "pull_free_restitution": 0.72,
        "settling": SETTLING,
        "compared_settling": SETTLING | {"patience": 150, "limit": 900},
    }
    return data.assign_attrs(
        machine=json.dumps(made | {"contact_stiffness": 2e7}),
        parameters=json.dumps(asked | (told or {})),
        name="made_up",
    )


def _screening():
    return {
        "balance_displacement": np.linspace(6.0, 10.0, 5),
        "displacement_limit": 2.0,
        "best_orbit_frequency": 34.0,
        "best_orbit_gap": 9.0,
        "best_orbit_displacement": 0.4,
        "best_orbit_status": flag("best_orbit_status", "smooth"),
        "screen_motions": 320,
        "screen_orbits": 100,
    }


def _comparison(choice):
    shares = np.ones((4, 5))
    shares[3, 2] = 0.5
    ends = np.stack([0.95 * shares, np.minimum(1.0, 1.1 * shares)], axis=-1)
    worst = np.where(shares < 1, 6.0, 0.8)
    return {
        "coarse_displacement": [7.0, 0.9, 0.8, 0.8, 6.0],
        "coarse_share": [0.2, 1.0, 1.0, 1.0, 0.4],
        "start_quiet_share": shares,
        "start_quiet_interval": ends,
        "worst_displacement": worst,
        "quiet_time_median": np.full((4, 5), 80.0),
        "quiet_time_late": np.full((4, 5), [100.0, 120.0, 110.0, 100.0, 90.0]),
        "compared_motions": 1000,
        "design_gap": 7.0,
        "design_choice": flag("design_choice", choice),
        "cliff_gap": [6.0, 8.5],
        "cliff_beyond": [np.nan, 8.6],
        "cliff_frequency": [np.nan, 30.0],
        "cliff_status": [flag("cliff_status", "range_ends"), flag("cliff_status", "found")],
        "reached_quiet_share": np.ones(5),
        "reached_quiet_interval": np.tile([0.95, 1.0], (5, 1)),
        "reached_displacement": np.linspace(0.8, 0.4, 5),
        "untouched_displacement": np.full(5, np.nan),
        "motion_rms": np.linspace(0.4, 0.2, 5),
        "motion_peak_high": np.linspace(0.7, 0.3, 5),
        "impact_rate_by_frequency": np.linspace(14.0, 10.0, 5),
        "contact_force_by_frequency": np.linspace(600.0, 500.0, 5),
        "penetration_by_frequency": np.full(5, 0.03),
        "impact_speed_by_frequency": np.full(5, 0.2),
        "impact_loss_by_frequency": np.full(5, 0.003),
        "impact_power_by_frequency": np.full(5, 0.04),
        "noise_by_frequency": np.full(5, 0.25),
        "pressure_by_frequency": np.full(5, np.nan),
        "yields_by_frequency": np.full(5, flag("yields_by_frequency", "unknown")),
    }


def _deviations(promise):
    shares = np.array([SURE, [0.98, 0.96, 0.99], SURE])
    return {
        "promise": flag("promise", promise),
        "sample_displacement": [0.8, 5.0, 0.9],
        "sample_share": shares,
        "corner_displacement": [0.8, 6.0, 0.9],
        "corner_share": shares,
        "force_map_share": np.tile([1.0, 1.0, 1.0, 0.5, 0.0], (5, 1)),
        "force_map_displacement": np.tile([0.2, 0.4, 0.8, 6.0, 9.0], (5, 1)),
        "damper_map_share": np.tile([1.0, 0.9, 0.1], (3, 1)),
        "damper_map_displacement": np.tile([0.8, 0.9, 6.0], (3, 1)),
        "force_map_modulus": np.tile([np.nan, 0.8, 0.9, 0.95, 1.1], (5, 1)),
        "damper_map_modulus": np.tile([0.8, 0.9, 1.1], (3, 1)),
        "stability_force_by_frequency": np.tile([0.5, 2.8], (5, 1)),
    }


def _masses():
    return {
        "other_gap": [14.0, 7.0, 3.0],
        "other_displacement": [5.0, 0.9, 0.8],
        "other_share": [0.5, 1.0, 1.0],
        "other_force": [900.0, 600.0, 1500.0],
        "other_best": [0, 1, 1],
    }


def _motions():
    """Return a settled motion and a chaotic one at each frequency."""
    sizes = np.stack([np.linspace(0.5, 0.3, 5), np.linspace(0.8, 0.4, 5)], axis=1)
    outcomes = [flag("outcome", "settled"), flag("outcome", "chaotic")]
    return {
        "maximum_displacement": sizes,
        "outcome": np.tile(outcomes, (5, 1)),
        "motion_starts": np.tile([40, 33], (5, 1)),
        "missed_share": 0.04,
    }


def _branches():
    x = np.linspace(26.0, 34.0, 6)
    return {
        "orbit_branch": np.zeros(6, int),
        "orbit_displacement": np.linspace(0.5, 0.3, 6),
        "orbit_stability": np.where(x < 30, 1, -1),
        "branch_period": [1],
        "bare_branch": np.repeat([0, 1], 3),
        "bare_frequency": np.tile([26.0, 30.0, 34.0], 2),
        "bare_displacement": [6.0, 8.0, 10.0, 5.0, 7.0, 9.0],
        "bare_stability": [1, 1, 1, -1, -1, -1],
        "branch_frequency": 30.0,
        "displacement_change": [2.6, -1.6, 0.0],
        "modulus_change": [0.2, -0.2, 0.0],
        "gap_of_orbit": [6.0, 7.0, 8.0, 9.0],
        "displacement_by_gap": [0.8, 0.7, 0.5, 0.4],
        "modulus_by_gap": [1.2, 0.9, 0.8, 1.1],
        "stability_gap": [6.5, 8.8],
        "stability_gap_event": [flag("stability_gap_event", "fold")] * 2,
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
        "den_hartog_stiffness": 9.1e3,
        "den_hartog_damping": 20.5,
        "absorber_stiffness": np.tile([[np.nan], [9e3]], 3),
        "absorber_damping": np.tile([[np.nan], [20.0]], 3),
    }
