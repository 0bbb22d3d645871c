"""Policies of migration compared: when should the damper be switched off?

Without the damper the oscillator has a large motion, the resonance motion, and a small one, the
goal. Migration leads from the large to the small motion by switching the damper on and off.
Switching off is called release. The release set contains the states from which a release leads to
the goal; its margin is a required distance of the measured state from the boundary of this set.

Each policy of `migration.policies` is tried from the resonance motion. The parameters of a policy
are chosen in trials with other random numbers than the trials that measure its success. The success
of a controller that knows the future (`migration.clairvoyant`) is an upper bound.

Z1 is the displacement of the primary mass and W the forcing frequency. A stage is a step of the
workflow.
"""

import math
from dataclasses import replace

import numpy as np

from chatterjee1995.stages.release_trials import PHASES, QUANTILES, free_case, quantile, summary
from impact_damper.data.datasets import dataset
from impact_damper.data.shares import BOUNDS, wilson
from impact_damper.model.bounds import RUNS_RANGE, SEED_RANGE, check_count
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.model.settling import check_settling
from impact_damper.motions.clairvoyant import clairvoyant
from impact_damper.motions.damped_labels import orbit_passages
from impact_damper.motions.migration import PAPER_CYCLES
from impact_damper.motions.policies import DRAWS, PHASE, SETTLED, Policy, hold, run_trials
from impact_damper.motions.policy_choice import chosen_policies

POLICIES = ["settled", "hold", "phase", "state", "clairvoyant"]
# Margins of the policy by state, divided by max |Z1| of the resonance motion.
MARGINS = (0.0, 0.02, 0.04, 0.08, 0.16)
# Disturbances of the policy by state.
# noise: standard deviation of the measured Z1, divided by max |Z1| of the resonance motion.
# delay: time from the measurement to the release, in 1/PHASES of a cycle.
# model: factors of damping and force of the wrong model from which the release set is computed.
DISTURBANCES = {
    "none": {},
    "noise 0.1 %": {"noise": 0.001},
    "noise 1 %": {"noise": 0.01},
    "noise 3 %": {"noise": 0.03},
    "noise 10 %": {"noise": 0.1},
    "delay 1/16": {"delay": 1},
    "delay 1/8": {"delay": 2},
    "delay 1/4": {"delay": 4},
    "h +5 %, force +1 %": {"model": (1.05, 1.01)},
    "h +5 %, force -1 %": {"model": (1.05, 0.99)},
    "h -5 %, force +1 %": {"model": (0.95, 1.01)},
    "h -5 %, force -1 %": {"model": (0.95, 0.99)},
    "noise 3 %, delay 1/8, h +5 %, force -1 %": {"noise": 0.03, "delay": 2, "model": (1.05, 0.99)},
}
# To save time there are fewer trials with a disturbance, by the factor DISTURBED, and of the
# clairvoyant bound, by the factor CLAIRVOYANT.
DISTURBED, CLAIRVOYANT = 2, 4
# Changes of velocity that are tried to reach the goal without a damper, divided by W max |Z1| of
# the resonance motion.
IMPULSES = np.linspace(-2, 2, 801)
# Cycles with the damper on before a release that tests whether the release set is right.
TESTED_HOLD = 10


def release_policies(
    oscillator,
    dampers,
    frequencies,
    *,
    noisy_frequencies=(),
    trials=200,
    tested=10_000,
    cells=64,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Compare policies of migration, and test the release set.

    Parameters
    ----------
    oscillator : Oscillator
    dampers : list of Damper
    frequencies : sequence of float
        Forcing frequencies at which both free motions of period 1 exist.
    noisy_frequencies : sequence of float
        Frequencies, among `frequencies`, at which noise, delay and a wrong model are studied.
    trials : int
        Trials of each policy; half as many with each disturbance, and a quarter as many for the
        clairvoyant bound.
    tested : int
        Releases that test the release set, spread evenly over the phases.
    cells : int
        Cells on each axis of the coarse grid of a release set.
    seed : int
    settling : Settling, optional
    workers : int
        Threads; the result does not depend on it.
    progress : str, optional
        Unused; jobs pass it to every stage.

    Returns
    -------
    xarray.Dataset
        A case is a damper. For each (case, frequency, policy) the share of trials that reach the
        goal within 350 cycles, quantiles of the cycles until the goal, and the cost (time with the
        damper on, impacts, releases), each with the ends of its 95 % interval; the shares of
        releases that lead to the goal, as predicted by the release set and as realised; the
        smallest change of velocity that leads to the goal without a damper; success and median of
        the cycles under noise, delay and a wrong model for each margin.

    Raises
    ------
    ValueError
        If an argument is out of range, or the free oscillator lacks one of its two motions at a
        frequency.
    """
    settling = check_settling(settling)
    check_count("trials", trials, **RUNS_RANGE)
    check_count("tested", tested, **RUNS_RANGE)
    check_count("seed", seed, **SEED_RANGE)
    shape = len(dampers), len(frequencies), len(POLICIES)
    disturbed = len(dampers), len(noisy_frequencies), len(DISTURBANCES), len(MARGINS), 3
    data = {
        "policy_success": np.empty((*shape, 3)),
        "policy_cycles": np.empty((*shape, len(QUANTILES), 3)),
        "policy_damper": np.empty((*shape, 3)),
        "policy_impacts": np.empty((*shape, 3)),
        "policy_releases": np.empty(shape),
        "policy_hold": np.full(shape, np.nan),
        "policy_phase": np.full(shape, np.nan),
        "predicted_share": np.empty((*shape[:2], 3)),
        "realised_share": np.empty((*shape[:2], 3)),
        "agreeing_share": np.empty((*shape[:2], 3)),
        "least_impulse": np.empty(shape[1]),
        "median_impulse": np.empty(shape[1]),
        "disturbed_success": np.empty(disturbed),
        "disturbed_cycles": np.empty(disturbed),
    }
    for j, frequency in enumerate(frequencies):
        free = free_case(oscillator, frequency, cells, settling, workers)
        models = {(1.0, 1.0): free}
        if frequency in noisy_frequencies:
            models |= wrong_models(oscillator, frequency, cells, free)
        data["least_impulse"][j], data["median_impulse"][j] = impulses(free)
        for i, damper in enumerate(dampers):
            on = pack(oscillator, damper, frequency)
            policies, outcomes = compared(on, free, trials, seed)
            for k, outcome in enumerate(outcomes):
                for name, values in summary(outcome).items():
                    data[name][i, j, k] = values
            for k, policy in enumerate(policies):
                if policy.kind != SETTLED:
                    data["policy_hold"][i, j, k] = policy.hold
                if policy.kind == PHASE:
                    data["policy_phase"][i, j, k] = 2 * math.pi * policy.phase / PHASES
            for name, values in prediction(on, free, tested, seed).items():
                data[name][i, j] = values
            if frequency in noisy_frequencies:
                place = i, list(noisy_frequencies).index(frequency)
                success, cycles = under_disturbance(on, models, policies[3], trials, seed)
                data["disturbed_success"][place] = success
                data["disturbed_cycles"][place] = cycles
    made = describe(oscillator, settling) | {"trials": trials, "tested": tested, "seed": seed}
    made |= {"cells": cells}
    for name in ("mass_ratio", "clearance", "restitution"):
        data[f"case_{name}"] = [getattr(damper, name) for damper in dampers]
    coordinates = {
        "case": np.arange(len(dampers)),
        "frequency": frequencies,
        "policy": POLICIES,
        "quantile": QUANTILES,
        "bound": BOUNDS,
        "noisy_frequency": list(noisy_frequencies),
        "disturbance": list(DISTURBANCES),
        "margin": list(MARGINS),
    }
    return dataset(data, coordinates, made, "Policies of migration")


def compared(on, free, trials, seed):
    """Return the policies, and the outcomes of their trials.

    The last outcome is that of the clairvoyant bound, which has no policy.
    """
    limit = float(PAPER_CYCLES)
    policies = [Policy(SETTLED), *chosen_policies(on, free, trials, limit, [seed, 1])]
    outcomes = [run_trials(on, free, policy, trials, limit, [seed, 0]) for policy in policies]
    examined = math.ceil(trials / CLAIRVOYANT)
    outcomes.append(clairvoyant(on, free, trials, limit, [seed, 0], examined))
    return policies, outcomes


def prediction(on, free, count, seed):
    """Return the variables of a test of the release set by releases at every phase, a dict.

    They are shares of the releases, each with the ends of its 95 % interval: predicted and realised
    share of the goal, and share of releases for which both agree.
    """
    generator = np.random.default_rng([seed, 2])
    each = max(1, count // PHASES)
    start = np.tile(free.attractors.centre[-1], (each, 1))
    limits, none = np.full(each, TESTED_HOLD + 2.0), np.zeros((each, 2))
    depths, reached = [], []
    for phase in range(PHASES):
        policy = Policy(PHASE, float(TESTED_HOLD), phase)
        held = hold(on, free, start, generator.random((each, DRAWS)), limits, policy, none)
        depths.append(held["depth"])
        reached.append(free.labels(held["state"])[0] == free.goal)
    inside, reached = np.concatenate(depths) > 0, np.concatenate(reached)
    return {
        "predicted_share": wilson(np.sum(inside), len(inside)),
        "realised_share": wilson(np.sum(reached), len(inside)),
        "agreeing_share": wilson(np.sum(inside == reached), len(inside)),
    }


def impulses(free):
    """Return the smallest change of velocity that leads from the resonance motion to the goal.

    The first result is the change at the best phase of the forcing, the second the median over the
    phases.
    """
    speed = free.size * free.p[FREQUENCY]
    least = []
    for phase in 2 * math.pi * np.arange(PHASES) / PHASES:
        x, v = orbit_passages(free.p, free.attractors.records[-1], phase)[0]
        states = np.stack([np.full(len(IMPULSES), x), v + speed * IMPULSES], axis=1)
        hit = free.labels(states, phase)[0] == free.goal
        least.append(np.min(np.abs(speed * IMPULSES[hit]), initial=np.inf))
    return np.min(least), np.median(least)


def wrong_models(oscillator, frequency, cells, free):
    """Return copies of `free` with release sets of wrong models, a dict.

    Its keys are the factors of damping and force of the wrong models.
    """
    found = {}
    for damping, force in {each["model"] for each in DISTURBANCES.values() if "model" in each}:
        wrong = replace(
            oscillator, damping=oscillator.damping * damping, force=oscillator.force * force
        )
        known = free_case(wrong, frequency, cells, free.settling, free.workers)
        found[damping, force] = free._replace(releases=known.releases)
    return found


def under_disturbance(on, models, policy, trials, seed, disturbances=DISTURBANCES):
    """Return success and median of the cycles for each disturbance and margin.

    Both have the shape (disturbances, margins, 3), with the ends of the 95 % interval.

    Parameters
    ----------
    on : array, shape (packed.COUNT,)
        Packed parameters with the damper.
    models : dict
        `FreeCase` with the true release set, keyed by (1.0, 1.0), and the result of `wrong_models`.
    policy : Policy
        The policy by state.
    trials, seed : int
    disturbances : dict
        Names and disturbances as in DISTURBANCES.
    """
    success, cycles = [], []
    for disturbance in disturbances.values():
        free = models[disturbance.get("model", (1.0, 1.0))]
        for margin in MARGINS:
            disturbed = policy._replace(
                margin=margin * free.size,
                noise=disturbance.get("noise", 0.0) * free.size,
                delay=disturbance.get("delay", 0),
            )
            examined = math.ceil(trials / DISTURBED)
            limit = float(PAPER_CYCLES)
            outcome = run_trials(on, free, disturbed, trials, limit, [seed, 0], examined)
            success.append(wilson(np.sum(outcome.reached), examined))
            cycles.append(quantile(outcome.cycles, 0.5))
    shape = len(disturbances), len(MARGINS), 3
    return np.reshape(success, shape), np.reshape(cycles, shape)
