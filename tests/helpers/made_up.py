"""Invented datasets of every stage, from closed forms, in which every claim of the paper holds.

Tests of claims, tables and figures change one dataset and expect one claim to fail. Functions with
the name of a stage return a dataset of this stage. Wp is the peak frequency without damper.
With damper there are a small motion (quiet), and below the suppression band a large one (high).
"""

import json
from functools import cache

import numpy as np
import xarray as xr

from helpers.made_up_orbits import branch, branches
from impact_damper.data.datasets import dataset, flag
from impact_damper.data.variables import DAMPED_MOTION, FREE_MOTION

STIFFNESS = 2000.0  # r1 of the walls
# Peak frequency by damping without linear stiffness, and by linear frequency at damping 0.215.
PEAKS = {0.215: 2.0, 0.15: 2.37, 0.107: 2.8}
LINEAR = {0.0: 2.0, 1.0: 2.1, 1.5: 2.3}
# Lower edge of the suppression band over Wp, by curve.
BAND_START = {
    "figure_05a": 0.95,
    "figure_03b": 0.94,
    "figure_03a": 0.93,
    "figure_03c_rule": 0.95,
    "figure_03b_rule": 0.94,
    "figure_03a_rule": 0.93,
    "figure_05b": 0.92,
    "figure_05c": 0.90,
    "figure_08": 0.95,
    "figure_10": 0.80,
}
# Mass ratio by curve.
DAMPERS = {
    "figure_05a": 0.12,
    "figure_05b": 0.25,
    "figure_05c": 0.4,
    "figure_08": 0.12,
    "figure_10": 0.25,
}


def frequencies(peak):
    """Return a grid of frequencies around the peak."""
    return np.linspace(0.5, 1.5, 201) * peak


def parameters(damping=0.215, linear=0.0, **others):
    """Return the parameters of a dataset."""
    return {"damping": damping, "linear_frequency": linear} | others


def damper(mass_ratio, peak, restitution=1.0):
    """Return the parameters of a damper with the clearance by the paper's rule (19)."""
    return {
        "mass_ratio": mass_ratio,
        "clearance": 1 / (mass_ratio * peak**2),
        "restitution": restitution,
        "contact_stiffness": STIFFNESS,
    }


def quiet_size(frequency, peak, mass_ratio):
    """Return an invented amplitude of the quiet motion, smallest at the peak."""
    return 1e-3 + 0.02 / mass_ratio * np.abs(frequency / peak - 1)


def resonance_size(frequency, peak, damping):
    """Return an invented amplitude of the resonance motion without damper, rising to the peak."""
    return frequency / (damping * peak**2)


def design(name, mass_ratio=0.12, damping=0.215, linear=0.0):
    """Return a harmonic balance: a quiet solution with a = 0 at the peak, and a high solution.

    a is the amplitude of Z1. The high solution exists below the suppression band.
    """
    peak = LINEAR[linear] if damping == 0.215 else PEAKS[damping]
    frequency = frequencies(peak)
    given = damper(mass_ratio, peak)
    size = quiet_size(frequency, peak, mass_ratio)
    high = np.where(
        frequency < BAND_START[name] * peak, 0.9 * resonance_size(frequency, peak, damping), np.nan
    )
    amplitude = np.stack([np.sign(frequency - peak + 1e-9) * size, high], axis=-1)
    depth = np.zeros_like(amplitude)
    for _ in range(20):
        force = mass_ratio * frequency[:, None] ** 2 * (given["clearance"] + depth - amplitude)
        depth = (np.pi * force / (2 * STIFFNESS)) ** 2 / (2 * given["clearance"])
    free = np.where(frequency <= peak, resonance_size(frequency, peak, damping), 0.2)
    found = np.isfinite(amplitude)
    edges = np.array([BAND_START[name], 1.0]) * peak
    data = {
        "amplitude": amplitude,
        "relative_amplitude": given["clearance"] + depth,
        "kind": np.where(found, flag("kind", "impacting"), flag("kind", "absent")),
        "stability": np.where(found, flag("stability", "stable"), flag("stability", "absent")),
        "rigid_amplitude": amplitude * 1.001,
        "rigid_wall": np.where(found, flag("rigid_wall", "pushes"), flag("rigid_wall", "absent")),
        "free_amplitude": free[:, None],
        "peak_frequency": peak,
        "peak_amplitude": 1 / (damping * peak),
        "quiet_amplitude": 1e-3,
        "reduction": 1 - 1e-3 * damping * peak,
        "band_width": edges[1] - edges[0],
        "edge_frequency": edges,
        "edge_reduction": np.full(2, 0.99),
        "edge_event": [
            flag("edge_event", "other_motion_appears"),
            flag("edge_event", "resonance_branch_ends"),
        ],
        "band_status": flag("band_status", "found"),
        "break_even_frequency": 1.4 * peak,
    }
    return dataset(
        data,
        {"frequency": frequency, "edge": ["lower", "upper"]},
        parameters(damping, linear, **given),
        "made up",
    )


def motions(frequency, columns):
    """Return variables of motions over frequency, a column for each motion.

    A column is a pair: a mask of the frequencies at which the motion exists, and a dict of the
    variables that differ from a settled motion of period 1.
    """
    fill = {
        "outcome": flag("outcome", "absent"),
        "period": 0,
        "contacts": np.nan,
        "maximum_displacement": np.nan,
        "motion_starts": 0,
    }
    usual = {
        "outcome": flag("outcome", "settled"),
        "period": 1,
        "motion_starts": 1,
    }
    data = {}
    for name, absent in fill.items():
        data[name] = np.stack(
            [np.where(present, (usual | others).get(name), absent) for present, others in columns],
            axis=-1,
        )
    return data


def free_branches(damping, linear=0.0):
    """Return a resonance branch with a fold at the peak, and a closed subharmonic branch."""
    peak = LINEAR[linear] if linear else PEAKS[damping]
    rising, falling = np.linspace(0.5, 1, 101) * peak, np.linspace(1, 0.6, 81)[1:] * peak
    beyond = np.linspace(0.6, 1.5, 181)[1:] * peak
    top = 1 / (damping * peak)
    size = [resonance_size(rising, peak, damping), np.linspace(top, 0.5, 80), 0.2 * beyond / beyond]
    stable = np.repeat([True, False, True], [101, 80, 180])
    curve = np.concatenate([rising, falling, beyond])
    there = np.linspace(0.8, 1.1, 61) * peak
    return branches(
        branch(curve, np.concatenate(size), stable=stable, contacts=0.0, phase=0.0),
        branch(there, 0.8, contacts=0.0, phase=0.0, period=3),
        folds=[(0, peak, top), (0, 0.6 * peak, 0.5)],
        parameters=parameters(damping, linear),
    )


def damped_branches(name, damping=0.215, restitution=1.0, third=None):
    """Return high orbits up to the band, quiet orbits at all frequencies, and orbits of period 3.

    The orbits that the high solutions of harmonic balance (7) approximate are unstable. `third` is
    the size of the orbits of period 3.
    """
    peak, mass_ratio = PEAKS[damping], DAMPERS[name]
    below, all_over = np.linspace(0.5, BAND_START[name], 101) * peak, frequencies(peak)
    high = 0.9 * resonance_size(below, peak, damping)
    size = quiet_size(all_over, peak, mass_ratio) * (1 if restitution == 1 else 1.3)
    phase = np.where(all_over < peak, np.pi, 0.0)
    parts = [
        branch(below, high, contacts=4.0, restitution=restitution),
        branch(below, high, phase=0.0, stable=False, restitution=restitution),
        branch(all_over, size, phase=phase, restitution=restitution),
    ]
    if third is not None:
        parts.append(branch(np.linspace(0.8, 1.1, 61) * peak, third, period=3))
    return branches(*parts, parameters=parameters(damping, **damper(mass_ratio, peak, restitution)))


def response(name, damping=0.215, restitution=1.0):
    peak, mass_ratio = PEAKS[damping], DAMPERS[name]
    frequency = frequencies(peak)
    edge = BAND_START[name] * peak
    size = quiet_size(frequency, peak, mass_ratio) * (1 if restitution == 1 else 1.3)
    high = 0.9 * resonance_size(frequency, peak, damping)
    chaos = np.abs(frequency / peak - 0.7) < 0.01
    data = motions(
        frequency,
        [
            (
                frequency < edge,
                {
                    "contacts": 4.0,
                    "maximum_displacement": high,
                    "outcome": np.where(
                        chaos, flag("outcome", "chaotic"), flag("outcome", "settled")
                    ),
                },
            ),
            (
                frequency > 0,
                {
                    "contacts": 2.0,
                    "maximum_displacement": size,
                },
            ),
        ],
    )
    data["run_outcome"] = np.ones((len(frequency), 2))
    data["life_ends"] = np.stack([np.where(chaos, 0, -1), np.full(len(frequency), -1)], axis=1)
    return dataset(
        data,
        {"frequency": frequency},
        parameters(damping, **damper(mass_ratio, peak, restitution)),
        "made up",
    )


def matched_sweep():
    """Return a response with three motions: quiet, chaotic, and one that no start reached.

    Quiet and chaotic motion change places in the list from frequency to frequency.
    """
    quiet, chaos, absent = (flag("outcome", name) for name in ("settled", "chaotic", "absent"))
    starts = np.array([[5, 5, 0], [1, 9, 0], [10, 0, 0]])
    data = {
        "outcome": [[quiet, chaos, quiet], [chaos, quiet, absent], [chaos, absent, absent]],
        "period": [[1, 0, 3], [0, 1, 0], [0, 0, 0]],
        "branch": [[7, 2, 4], [2, 7, -1], [2, -1, -1]],
        "motion_starts": starts,
        "share_lower": starts / 20,
        "share_upper": 0.5 + starts / 20,
        "run_outcome": np.ones((3, 10)),
        "missed_share": 0.3,
    }
    made = parameters(**damper(0.12, 2.0))
    return dataset(data, {"frequency": [1.0, 1.5, 2.0]}, made, "made up")


def motion():
    """Return a motion with a state of three components; the paper omits the fourth (claim S3)."""
    data = {name: np.zeros(3) for name in ("displacement", "velocity", "relative_displacement")}
    return dataset(data, {"time": np.arange(3.0)}, parameters(frequency=2.0), "made up")


def collisions():
    """Return a dataset of collisions in which all starts collide."""
    data = {"beyond_wall": [0.2, 0.0], "colliding": [1.0, 1.0], "longest_wait": [9.0, 90.0]}
    made = parameters(**damper(0.12, 2.0), starts=2000)
    return dataset(data, {"ball": ["literal", "within_gap"]}, made, "made up")


def sweep(damping, mass_ratio, restitution=1.0):
    """Return a clearance sweep with a flat optimum 5 % above the rule, smaller for smaller e.

    The displacement becomes slightly smaller with larger mass ratio.
    """
    frequency = PEAKS[damping]
    rule = 1 / (mass_ratio * frequency**2)
    best = rule * (1.05 - 0.5 * (1 - restitution))
    flatness = 0.1 + (1 - restitution)
    steepness = 1.5 - 4 * (1 - restitution)
    clearance = np.linspace(0.5, 1.5, 101) * best
    size = (0.12 / mass_ratio) ** 0.25
    data = {
        "quiet_displacement": 0.02 * size * (1 + steepness * np.abs(clearance / best - 1)),
        "optimum_clearance": best,
        "optimum_displacement": 0.02 * size,
        "rule_clearance": rule,
        "peak_rule_clearance": rule,
        "analytical_optimum": rule,
        "optimum_ratio": 1.05,
        "optimum_kind": flag("optimum_kind", "kink"),
        "straight_flight_ratio": 1.05,
        "first_harmonic_share": 4.7,
        "straight_flight_share": 1.0,
        "near_clearance": best * np.array([1 - flatness, 1 + flatness]),
    }
    return dataset(
        data,
        {"clearance": clearance, "edge": ["lower", "upper"]},
        parameters(damping, frequency=frequency, mass_ratio=mass_ratio, restitution=restitution),
        "made up",
    )


def subharmonic(name, damping=0.215, damped=np.nan):
    """Return the free subharmonic from 0.8 to 1.1 Wp, and with damper a small one or none.

    `damped` is the size of the subharmonic with damper; NaN if there is none.
    """
    peak = PEAKS[damping]
    frequency = np.linspace(0.8, 1.1, 61) * peak
    present = np.full(len(frequency), np.isfinite(damped))
    size = 0.8 * peak / 2
    data = motions(
        frequency,
        [
            (present, {"contacts": 2.0, "maximum_displacement": damped, "period": 3}),
            (frequency > 0, {"contacts": 2.0, "maximum_displacement": 0.01}),
        ],
    )
    ratio = np.where(present, damped, 0.0) / size
    data |= {
        "free_subharmonic": np.full(len(frequency), size),
        "damped_subharmonic": np.where(present, damped, np.nan),
        "subharmonic_ratio": ratio,
        "switched_share": 0.5 * present[:, None],
    }
    return dataset(
        data,
        {"frequency": frequency, "edge": ["lower", "upper"], "switched_motion": ["subharmonic"]},
        parameters(damping, **damper(DAMPERS[name], peak)),
        "made up",
    )


def migration(frequency, subharmonic_share):
    """Return four runs of the controller, and releases of two motions with damper.

    These are a motion that has not settled, and the quiet motion.
    """
    kinds, destinations = list(DAMPED_MOTION)[1:], list(FREE_MOTION)[1:]
    shares = np.zeros((2, len(destinations), 3))
    shares[:, destinations.index("subharmonic")] = subharmonic_share
    shares[:, destinations.index("non_resonance")] = 1 - subharmonic_share
    counts = np.zeros((len(kinds), len(destinations)), int)
    counts[kinds.index("unsettled")] = np.rint(10 * shares[0, :, 0])
    reached = np.full(4, flag("trial_outcome", "reached"))
    # Run k (counted from 1) switches the damper k times, and the last release reaches the goal.
    destination = np.full((4, 4), FREE_MOTION["none"])
    destination[np.tril_indices(4, -1)] = FREE_MOTION["resonance"]
    destination[np.diag_indices(4)] = FREE_MOTION["non_resonance"]
    data = {
        "damped_kind": [DAMPED_MOTION["unsettled"], DAMPED_MOTION["quiet"]],
        "damped_period": np.array([0, 1]),
        "damped_displacement": np.array([np.nan, 0.1]),
        "damped_contacts": np.array([np.nan, 2.0]),
        "release_share": shares,
        "destination_count": counts,
        "trial_outcome": reached,
        "destination": destination,
        "switchings": np.array([1, 2, 3, 4]),
        "damper_time": np.full(4, 50.0),
        "total_time": np.array([60.0, 120.0, 180.0, 300.0]),
        "reached_share": np.ones(3),
        "within_share": np.ones(3),
        "landed_on": ("run", [1, 1]),
        "escape_rate": np.full(3, 0.1),
    }
    coordinates = {
        "bound": ["share", "lower", "upper"],
        "damped_motion": kinds,
        "free_motion": destinations,
    }
    made = parameters(**damper(0.12, 2.0), frequency=frequency, releases=240)
    return dataset(data, coordinates, made, "made up")


def release_scan(frequency, subharmonic_share):
    """Return a scan of releases of two motions with damper: unsettled and quiet."""
    destinations = list(FREE_MOTION)[1:]
    share = np.array(subharmonic_share)[:, None, None]
    shares = np.zeros((len(frequency), 3, len(destinations), 3))
    shares[:, :, destinations.index("subharmonic")] = share
    shares[:, :, destinations.index("non_resonance")] = 1 - share
    shares[:, 2] = np.nan
    kinds = [DAMPED_MOTION[kind] for kind in ("unsettled", "quiet", "none")]
    rows = {
        "damped_kind": np.tile(kinds, (len(frequency), 1)),
        "damped_period": np.tile([0, 1, -1], (len(frequency), 1)),
    }
    data = {name: (("frequency", "damped"), values) for name, values in rows.items()}
    data["release_share"] = (("frequency", "damped", "free_motion", "bound"), shares)
    coordinates = {
        "frequency": frequency,
        "bound": ["share", "lower", "upper"],
        "free_motion": destinations,
    }
    return dataset(data, coordinates, parameters(**damper(0.12, 2.0)), "made up")


def policies(case, frequency):
    """Return releases by state, hold and phase, with shares of success 0.1, 0.2 and 0.3.

    Cycles, time with the damper and impacts are 100 times these shares.
    """
    shares = np.array([0.1, 0.2, 0.3])[:, None] + [0, -0.05, 0.05]
    dims = ("case", "frequency", "policy", "bound")
    cycles = np.repeat(100 * shares[None, None, :, None], 2, axis=3)
    given = json.loads(case.attrs["parameters"])
    return xr.Dataset(
        {
            "policy_success": (dims, shares[None, None]),
            "policy_cycles": ((*dims[:3], "quantile", "bound"), cycles),
            "policy_damper": (dims, 100 * shares[None, None]),
            "policy_impacts": (dims, 100 * shares[None, None]),
            "policy_releases": (dims[:3], np.ones((1, 1, 3))),
            "policy_hold": (dims[:3], np.full((1, 1, 3), 5.0)),
            "policy_phase": (dims[:3], np.full((1, 1, 3), 1.5)),
            "realised_share": (("case", "frequency", "bound"), np.full((1, 1, 3), 0.7)),
        }
        | {
            f"case_{name}": ("case", [given[name]])
            for name in ("mass_ratio", "clearance", "restitution")
        },
        {
            "policy": ["state", "hold", "phase"],
            "frequency": [frequency],
            "quantile": [0.5, 0.95],
            "bound": ["share", "lower", "upper"],
        },
        case.attrs,
    )


# Linear frequency by number of the figure.
LINEAR_OF = {"3a": 1.5, "3b": 1.0, "3c": 0.0, "5a": 0.0}


def design_orbit(linear):
    """Return a branch of small orbits that are stable at every damping."""
    made = parameters(linear=linear) | damper(0.12, LINEAR[linear])
    runs = {
        "design_orbit_status": flag("design_orbit_status", "found"),
        "design_run_outcome": np.full(4, flag("outcome", "settled")),
        "design_run_displacement": np.full(4, 0.05),
    }
    orbit = branches(branch([0.215, 2.0], [0.05, 0.04]), parameters=made)
    return orbit.assign(dataset(runs, {}, made, "made up").variables)


def world():
    """Return datasets by stage and name in which every claim is reproduced.

    The datasets are made once and cannot be changed in place; the mappings are new.
    """
    return {stage: dict(named) for stage, named in _world().items()}


@cache
def _world():
    """Return the datasets of `world`, with arrays that cannot be written to."""
    made = _made()
    for named in made.values():
        for data in named.values():
            for variable in data.data_vars.values():
                variable.values.flags.writeable = False
    return made


def _made():
    """Return the datasets of `world`."""
    linear = {"a": 1.5, "b": 1.0}
    designs = {
        name: design(name, rm)
        for name, rm in DAMPERS.items()
        if name in ("figure_05a", "figure_05b", "figure_05c")
    }
    designs |= {
        f"figure_03{k}{tail}": design(f"figure_03{k}{tail}", linear=value)
        for k, value in linear.items()
        for tail in ("", "_rule")
    }
    designs |= {
        "figure_03c_rule": design("figure_03c_rule"),
        "figure_08": design("figure_08", damping=0.107),
    }
    responses = {name: response(name) for name in ("figure_05a", "figure_05b", "figure_05c")}
    responses |= {
        "figure_08": response("figure_08", 0.107),
        "figure_10": response("figure_10", restitution=0.75),
    }
    return {
        "harmonic_balance": designs,
        "branches": {f"free_h{1000 * h:.0f}": free_branches(h) for h in PEAKS}
        | {f"free_l{100 * k:.0f}": free_branches(0.215, k) for k in linear.values()}
        | {
            "figure_05a": damped_branches("figure_05a"),
            "figure_05b": damped_branches("figure_05b"),
            "figure_05c": damped_branches("figure_05c", third=0.1),
            "figure_08": damped_branches("figure_08", 0.107),
            "figure_10": damped_branches("figure_10", restitution=0.75),
        },
        "design_orbit": {
            name: design_orbit(LINEAR_OF[name[8:10]]) for name in designs if name[8:10] in LINEAR_OF
        },
        "response": responses,
        "motion": {"figure_04": motion()},
        "collisions": {"figure_05a": collisions()},
        "optimum": {
            f"{h}_{rm}_{e}": sweep(h, rm, e)
            for h, rm, e in (
                (0.215, 0.12, 1.0),
                (0.215, 0.18, 1.0),
                (0.107, 0.12, 1.0),
                (0.107, 0.18, 1.0),
                (0.215, 0.12, 0.75),
                (0.215, 0.18, 0.75),
            )
        },
        "subharmonic": {
            "figure_05a": subharmonic("figure_05a", damped=0.16),
            "figure_05b": subharmonic("figure_05b"),
            "figure_05c": subharmonic("figure_05c", damped=0.1),
            "figure_08": subharmonic("figure_08", 0.107),
        },
        "migration": {
            "figure_13": migration(1.95, 0.0),
            "figure_15": migration(1.7, 0.5),
            "figure_16": migration(1.85, 0.6),
        },
        "release_scan": {
            "wide": release_scan([1.5, 1.6, 1.7, 1.8, 1.9], [0.5, 0.0, 0.5, 0.5, 1.0]),
            "close": release_scan([1.65, 1.75], [0.2, 0.5]),
        },
    }
