"""Invented datasets of every stage, from closed forms, in which every claim of the paper holds."""

import json
from functools import cache

import numpy as np
import xarray as xr

import helpers.every_variable  # noqa: F401
from helpers.made_up_orbits import branch, branches
from impact_damper.data.datasets import dataset, flag
from impact_damper.data.motion_variables import DAMPED_MOTION, FREE_MOTION

STIFFNESS = 2000.0  # r1 of the walls
PEAKS = {0.215: 2.0, 0.15: 2.37, 0.107: 2.8}  # damping h -> Wp without linear stiffness
LINEAR = {0.0: 2.0, 1.0: 2.1, 1.5: 2.3}  # linear frequency -> Wp for h = 0.215
# Curve -> (lower edge of the suppression band) / Wp, mass ratio, damping, linear frequency.
CURVES = {
    "figure_05a": (0.95, 0.12, 0.215, 0.0),
    "figure_05b": (0.92, 0.25, 0.215, 0.0),
    "figure_05c": (0.90, 0.4, 0.215, 0.0),
    "figure_08": (0.95, 0.12, 0.107, 0.0),
    "figure_10": (0.80, 0.25, 0.215, 0.0),
    "figure_03a": (0.93, 0.12, 0.215, 1.5),
    "figure_03b": (0.94, 0.12, 0.215, 1.0),
    "figure_03a_rule": (0.93, 0.12, 0.215, 1.5),
    "figure_03b_rule": (0.94, 0.12, 0.215, 1.0),
    "figure_03c_rule": (0.95, 0.12, 0.215, 0.0),
}
SIMULATED = ("figure_05a", "figure_05b", "figure_05c", "figure_08", "figure_10")
BOUNDS = {"bound": ["share", "lower", "upper"]}


def made(data, coordinates, **given):
    """Return a dataset with the variables `data` and the parameters `given`."""
    return dataset(data, coordinates, given, "made up")


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


def harmonic_balance(name):
    """Return a quiet solution with a = 0 at the peak, and a high solution below the band."""
    start, mass_ratio, damping, linear = CURVES[name]
    peak = LINEAR[linear] if damping == 0.215 else PEAKS[damping]
    frequency = np.linspace(0.5, 1.5, 201) * peak
    given = damper(mass_ratio, peak)
    quiet = np.sign(frequency - peak + 1e-9) * quiet_size(frequency, peak, mass_ratio)
    size = resonance_size(frequency, peak, damping)
    amplitude = np.stack([quiet, np.where(frequency < start * peak, 0.9 * size, np.nan)], axis=-1)
    depth = np.zeros_like(amplitude)
    for _ in range(20):
        force = mass_ratio * frequency[:, None] ** 2 * (given["clearance"] + depth - amplitude)
        depth = (np.pi * force / (2 * STIFFNESS)) ** 2 / (2 * given["clearance"])
    found = np.isfinite(amplitude)
    data = {
        "amplitude": amplitude,
        "relative_amplitude": given["clearance"] + depth,
        "kind": np.where(found, flag("kind", "impacting"), flag("kind", "absent")),
        "stability": np.where(found, flag("stability", "stable"), flag("stability", "absent")),
        "rigid_amplitude": amplitude * 1.001,
        "rigid_wall": np.where(found, flag("rigid_wall", "pushes"), flag("rigid_wall", "absent")),
        "free_amplitude": np.where(frequency <= peak, size, 0.2)[:, None],
        "peak_frequency": peak,
        "peak_amplitude": 1 / (damping * peak),
        "quiet_amplitude": 1e-3,
        "reduction": 1 - 1e-3 * damping * peak,
        "band_width": (1 - start) * peak,
        "edge_frequency": np.array([start, 1.0]) * peak,
        "band_status": flag("band_status", "found"),
    }
    coordinates = {"frequency": frequency, "edge": ["lower", "upper"]}
    return made(data, coordinates, **parameters(damping, linear, **given))


def motions(*columns):
    """Return variables of motions over frequency."""
    absent = {"outcome": flag("outcome", "absent"), "period": 0, "motion_starts": 0}
    absent |= {"contacts": np.nan, "maximum_displacement": np.nan}
    usual = {"outcome": flag("outcome", "settled"), "period": 1, "motion_starts": 1}
    return {
        name: np.stack(
            [np.where(present, (usual | others)[name], value) for present, others in columns], -1
        )
        for name, value in absent.items()
    }


def free_branches(damping, linear=0.0):
    """Return a resonance branch with a fold at the peak, and a closed subharmonic branch."""
    peak = LINEAR[linear] if linear else PEAKS[damping]
    rising, falling = np.linspace(0.5, 1, 101) * peak, np.linspace(1, 0.6, 81)[1:] * peak
    beyond, there = np.linspace(0.6, 1.5, 181)[1:] * peak, np.linspace(0.8, 1.1, 61) * peak
    top = 1 / (damping * peak)
    size = [resonance_size(rising, peak, damping), np.linspace(top, 0.5, 80), np.full(180, 0.2)]
    stable = np.repeat([True, False, True], [101, 80, 180])
    curve = np.concatenate([rising, falling, beyond])
    return branches(
        branch(curve, np.concatenate(size), stable=stable, contacts=0.0, phase=0.0),
        branch(there, 0.8, contacts=0.0, phase=0.0, period=3),
        folds=[(0, peak, top), (0, 0.6 * peak, 0.5)],
        parameters=parameters(damping, linear),
    )


def damped_branches(name, restitution=1.0, third=None):
    """Return high orbits, quiet orbits, and orbits of period 3 of the size `third`."""
    start, mass_ratio, damping, _ = CURVES[name]
    peak = PEAKS[damping]
    below, all_over = np.linspace(0.5, start, 101) * peak, np.linspace(0.5, 1.5, 201) * peak
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


def response(name, restitution=1.0):
    """Return the high motion below the band, chaotic near 0.7 Wp, and the quiet motion."""
    start, mass_ratio, damping, _ = CURVES[name]
    peak = PEAKS[damping]
    frequency = np.linspace(0.5, 1.5, 201) * peak
    chaos = np.abs(frequency / peak - 0.7) < 0.01
    outcome = np.where(chaos, flag("outcome", "chaotic"), flag("outcome", "settled"))
    high = {"contacts": 4.0, "outcome": outcome}
    high["maximum_displacement"] = 0.9 * resonance_size(frequency, peak, damping)
    size = quiet_size(frequency, peak, mass_ratio) * (1 if restitution == 1 else 1.3)
    quiet = {"contacts": 2.0, "maximum_displacement": size}
    data = motions((frequency < start * peak, high), (frequency > 0, quiet))
    data["life_ends"] = np.stack([np.where(chaos, 0, -1), np.full(len(frequency), -1)], axis=1)
    given = parameters(damping, **damper(mass_ratio, peak, restitution))
    return made(data, {"frequency": frequency}, **given)


def matched_sweep():
    """Return a response with three motions: quiet, chaotic, and a motion that no start reached."""
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
    return made(data, {"frequency": [1.0, 1.5, 2.0]}, **parameters(**damper(0.12, 2.0)))


def motion():
    """Return a motion with a state of three components; the paper omits the fourth (claim S3)."""
    data = {name: np.zeros(3) for name in ("displacement", "velocity", "relative_displacement")}
    return made(data, {"time": np.arange(3.0)}, **parameters(frequency=2.0))


def collisions():
    """Return a dataset of collisions in which all starts collide."""
    data = {"beyond_wall": [0.2, 0.0], "colliding": [1.0, 1.0], "longest_wait": [9.0, 90.0]}
    given = parameters(**damper(0.12, 2.0), starts=2000)
    return made(data, {"ball": ["literal", "within_gap"]}, **given)


def sweep(damping, mass_ratio, restitution=1.0):
    """Return a clearance sweep. The optimum is 5 % above the rule for e = 1, lower for e < 1."""
    frequency = PEAKS[damping]
    rule = 1 / (mass_ratio * frequency**2)
    best = rule * (1.05 - 0.5 * (1 - restitution))
    steepness = 1.5 - 4 * (1 - restitution)
    clearance = np.linspace(0.5, 1.5, 101) * best
    size, missing = 0.02 * (0.12 / mass_ratio) ** 0.25, np.full(101, np.nan)
    data = {
        "quiet_displacement": size * (1 + steepness * np.abs(clearance / best - 1)),
        "optimum_clearance": best,
        "optimum_displacement": size,
        "rule_clearance": rule,
        "peak_rule_clearance": rule,
        "analytical_optimum": rule if restitution == 1 else np.nan,
        "analytical_amplitude": np.abs(clearance - rule) if restitution == 1 else missing,
        "optimum_ratio": 1.05,
        "optimum_kind": flag("optimum_kind", "kink"),
        "straight_flight_ratio": 1.05,
        "near_clearance": best * np.array([0.9, 1.1]),
    }
    given = {"frequency": frequency, "mass_ratio": mass_ratio, "restitution": restitution}
    coordinates = {"clearance": clearance, "edge": ["lower", "upper"]}
    return made(data, coordinates, **parameters(damping, **given))


def subharmonic(name, damped=np.nan):
    """Return the free subharmonic from 0.8 to 1.1 Wp, and a subharmonic of size `damped`."""
    _, mass_ratio, damping, _ = CURVES[name]
    peak = PEAKS[damping]
    frequency = np.linspace(0.8, 1.1, 61) * peak
    present = np.full(len(frequency), np.isfinite(damped))
    size = 0.8 * peak / 2
    data = motions(
        (present, {"contacts": 2.0, "maximum_displacement": damped, "period": 3}),
        (frequency > 0, {"contacts": 2.0, "maximum_displacement": 0.01}),
    )
    data |= {
        "free_subharmonic": np.full(len(frequency), size),
        "damped_subharmonic": np.where(present, damped, np.nan),
        "subharmonic_ratio": np.where(present, damped, 0.0) / size,
        "switched_share": 0.5 * present,
    }
    coordinates = {"frequency": frequency, "edge": ["lower", "upper"]}
    return made(data, coordinates, **parameters(damping, **damper(mass_ratio, peak)))


def destinations(subharmonic_share):
    """Return the names of free motions, and shares of releases to period 3 and to the goal."""
    names = list(FREE_MOTION)[1:]
    share = np.asarray(subharmonic_share, float)
    shares = np.zeros((*share.shape, len(names), 3))
    shares[..., names.index("subharmonic"), :] = share[..., None]
    shares[..., names.index("non_resonance"), :] = 1 - share[..., None]
    return names, shares


def migration(frequency, subharmonic_share):
    """Return four runs of the controller, and releases from an unsettled and a quiet motion."""
    names, shares = destinations([subharmonic_share] * 2)
    kinds = list(DAMPED_MOTION)[1:]
    counts = np.zeros((len(kinds), len(names)), int)
    counts[kinds.index("unsettled")] = np.rint(10 * shares[0, :, 0])
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
        "trial_outcome": np.full(4, flag("trial_outcome", "reached")),
        "destination": destination,
        "switchings": np.array([1, 2, 3, 4]),
        "damper_time": np.full(4, 50.0),
        "total_time": np.array([60.0, 120.0, 180.0, 300.0]),
        "reached_share": np.ones(3),
        "within_share": np.ones(3),
    }
    coordinates = BOUNDS | {"damped_motion": kinds, "free_motion": names}
    given = parameters(**damper(0.12, 2.0), frequency=frequency, releases=240)
    return made(data, coordinates, **given)


def release_scan(frequency, subharmonic_share):
    """Return a scan of releases from two motions with damper: unsettled and quiet."""
    names, shares = destinations(np.repeat(np.array(subharmonic_share)[:, None], 3, axis=1))
    shares[:, 2] = np.nan
    kinds = [DAMPED_MOTION[kind] for kind in ("unsettled", "quiet", "none")]
    rows = ("frequency", "damped")
    data = {
        "damped_kind": (rows, np.tile(kinds, (len(frequency), 1))),
        "damped_period": (rows, np.tile([0, 1, -1], (len(frequency), 1))),
        "release_share": ((*rows, "free_motion", "bound"), shares),
    }
    coordinates = BOUNDS | {"frequency": frequency, "free_motion": names}
    return made(data, coordinates, **parameters(**damper(0.12, 2.0)))


def policies(case, frequency):
    """Return releases by state, hold and phase, with shares of success 0.1, 0.2 and 0.3."""
    shares = (np.array([0.1, 0.2, 0.3])[:, None] + [0, -0.05, 0.05])[None, None]
    dims = ("case", "frequency", "policy", "bound")
    cycles = np.repeat(100 * shares[:, :, :, None], 2, axis=3)
    given = json.loads(case.attrs["parameters"])
    names = ("mass_ratio", "clearance", "restitution")
    return xr.Dataset(
        {
            "policy_success": (dims, shares),
            "policy_cycles": ((*dims[:3], "quantile", "bound"), cycles),
            "policy_damper": (dims[:3], 100 * shares[..., 0]),
            "policy_impacts": (dims[:3], 100 * shares[..., 0]),
            "policy_releases": (dims[:3], np.ones((1, 1, 3))),
            "policy_hold": (dims[:3], np.full((1, 1, 3), 5.0)),
            "policy_phase": (dims[:3], np.full((1, 1, 3), 1.5)),
        }
        | {f"case_{name}": ("case", [given[name]]) for name in names},
        BOUNDS
        | {"policy": ["state", "hold", "phase"]}
        | {"frequency": [frequency], "quantile": [0.5, 0.95]},
        case.attrs,
    )


def design_orbit(name):
    """Return a branch of small orbits that are stable at every damping."""
    linear = CURVES[name][3]
    given = parameters(linear=linear) | damper(0.12, LINEAR[linear])
    runs = {
        "design_orbit_status": flag("design_orbit_status", "found"),
        "design_run_outcome": np.full(4, flag("outcome", "settled")),
        "design_run_displacement": np.full(4, 0.05),
    }
    orbit = branches(branch([0.215, 2.0], [0.05, 0.04]), parameters=given)
    return orbit.assign(made(runs, {}, **given).variables)


def world():
    """Return datasets by stage and name in which every claim is reproduced, in new dicts."""
    return {stage: dict(named) for stage, named in _world().items()}


@cache
def _world():
    """Return the datasets of `world`, which are made once."""
    inelastic, third = {"figure_10": 0.75}, {"figure_05c": 0.1}
    designs = [name for name in CURVES if name != "figure_10"]
    elastic = [name for name in SIMULATED if name != "figure_10"]
    return {
        "harmonic_balance": {name: harmonic_balance(name) for name in designs},
        "branches": {f"free_h{1000 * h:.0f}": free_branches(h) for h in PEAKS}
        | {f"free_l{100 * k:.0f}": free_branches(0.215, k) for k in (1.5, 1.0)}
        | {k: damped_branches(k, inelastic.get(k, 1.0), third.get(k)) for k in SIMULATED},
        "design_orbit": {
            name: design_orbit(name) for name in designs if name[7:9] == "03" or name[7:] == "05a"
        },
        "response": {name: response(name, inelastic.get(name, 1.0)) for name in SIMULATED},
        "motion": {"figure_04": motion()},
        "collisions": {"figure_05a": collisions()},
        "optimum": {
            f"{h}_{rm}_{e}": sweep(h, rm, e)
            for h, e in ((0.215, 1.0), (0.107, 1.0), (0.215, 0.75))
            for rm in (0.12, 0.18)
        },
        "subharmonic": {
            name: subharmonic(name, {"figure_05a": 0.16, "figure_05c": 0.1}.get(name, np.nan))
            for name in elastic
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
