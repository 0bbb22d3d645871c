"""Policies of migration compared: when should the damper be let go of?

Each policy of `migration.policies` is tried from the free resonance motion. The numbers of `hold`
and `phase` are chosen with other random draws than those that they are judged with.
"""

import math

import numpy as np

from impact_damper.attraction.damped_labels import orbit_passages
from impact_damper.attraction.labels import label_states
from impact_damper.data.datasets import dataset
from impact_damper.data.shares import BOUNDS, QUANTILE, wilson
from impact_damper.migration.policies import (
    DRAWS,
    HOLD,
    PHASE,
    SETTLED,
    STATE,
    Policy,
    hold,
    run_trials,
)
from impact_damper.migration.release_set import release_set
from impact_damper.motions.free_motions import free_motions
from impact_damper.stages.basins import REACH, free_attractors
from impact_damper.stages.migration import PAPER_CYCLES
from impact_damper.system.bounds import RUNS_RANGE, SEED_RANGE, check_count
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.system.parameters import Oscillator, describe
from impact_damper.system.settling import check_settling

POLICIES = ["settled", "hold", "phase", "state"]
QUANTILES = [0.5, 0.95]
# Phases of the forcing at which the state is looked at.
PHASES = 16
# Forcing periods of a hold of which the best is chosen.
HOLDS = (1, 2, 3, 5, 8, 13, 21, 34)
# Margins, errors of the measured state, and delays in PHASES-ths of a period.
MARGINS = (0.0, 0.01, 0.02, 0.04, 0.08)
NOISES = (0.0, 0.001, 0.003, 0.01, 0.03, 0.1)
DELAYS = (0, 1, 2, 4)
# Factors of damping and force in a wrong model of the oscillator.
WRONG_DAMPING, WRONG_FORCE = 1.05, 1.01
# Changes of velocity that are tried, in units of the largest speed of the resonance motion.
IMPULSES = np.linspace(-2, 2, 801)
# Forcing periods with the damper on before a release that tests the prediction.
TESTED_HOLD = 10


def release_policies(
    oscillator,
    dampers,
    frequencies,
    *,
    noisy_frequency,
    trials=200,
    tested=10_000,
    cells=64,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Compare policies of migration, and test the prediction of the release set.

    Parameters
    ----------
    oscillator : Oscillator
    dampers : list of Damper
    frequencies : sequence of float
        Forcing frequencies at which both free motions of period 1 exist.
    noisy_frequency : float
        One of them, at which noise, delay and a wrong model are studied with the first damper.
    trials : int
        Trials of each policy.
    tested : int
        Releases that test the prediction, spread evenly over the phases.
    cells : int
        Cells on each axis of the coarse grid of a release set.
    seed : int
    settling : Settling, optional
    workers : int
        Threads; the result does not depend on it.
    progress : str, optional
        Unused; jobs hand it to every stage.

    Returns
    -------
    xarray.Dataset
        For each (case, frequency, policy) success within 350 forcing periods, quantiles of the
        forcing periods until the goal, and the cost, each with 95 % bounds; predicted and realised
        shares of the test; the least impulse without a damper; success under noise, delay and a
        wrong model for each margin.

    Raises
    ------
    ValueError
        If an argument is out of range, or the free oscillator has not both motions at a frequency.
    """
    settling = check_settling(settling)
    check_count("trials", trials, **RUNS_RANGE)
    check_count("tested", tested, **RUNS_RANGE)
    check_count("seed", seed, **SEED_RANGE)
    shape = len(dampers), len(frequencies), len(POLICIES)
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
    }
    for j, frequency in enumerate(frequencies):
        free = _Free(oscillator, frequency, cells, settling, workers)
        data["least_impulse"][j], data["median_impulse"][j] = free.impulses()
        for i, damper in enumerate(dampers):
            runs = _Runs(free, damper, seed, trials)
            chosen, tests = runs.chosen_policies(tested)
            for name, values in tests.items():
                data[name][i, j] = values
            for k, policy in enumerate(chosen):
                outcome = runs.trial(policy, 0)
                for name, values in _summary(outcome).items():
                    data[name][i, j, k] = values
            data["policy_hold"][i, j, 1:3] = chosen[1].hold, chosen[2].hold
            data["policy_phase"][i, j, 2] = 2 * math.pi * chosen[2].phase / PHASES
            if frequency == noisy_frequency and i == 0:
                data |= _disturbed(runs)
    made = describe(oscillator, settling) | {"trials": trials, "tested": tested, "seed": seed}
    made |= {"noisy_frequency": noisy_frequency, "cells": cells}
    for name in ("mass_ratio", "clearance", "restitution"):
        data[f"case_{name}"] = [getattr(damper, name) for damper in dampers]
    coordinates = {
        "case": np.arange(len(dampers)),
        "frequency": frequencies,
        "policy": POLICIES,
        "quantile": QUANTILES,
        "bound": BOUNDS,
        "margin": list(MARGINS),
        "noise": list(NOISES),
        "delay": np.array(DELAYS) / PHASES,
    }
    return dataset(data, coordinates, made, "Policies of migration")


class _Free:
    """The free oscillator at one frequency: its attractors, its goal and its release set."""

    def __init__(self, oscillator, frequency, cells, settling, workers):
        self.oscillator, self.frequency = oscillator, frequency
        self.settling, self.workers = settling, workers
        self.p = pack(oscillator, None, frequency)
        known = free_motions(oscillator, frequency, settling)
        window = REACH / 2 * np.array([known.displacement, known.speed])
        self.attractors = free_attractors(self.p, window, settling)
        ones = np.flatnonzero(self.attractors.records["period"] == 1)
        if len(ones) < 2 or ones[-1] != len(self.attractors.records) - 1:
            raise ValueError(
                f"frequency = {frequency:g}: must have a non-resonance and a resonance motion "
                "without the damper"
            )
        self.goal, self.size = int(ones[0]), self.attractors.records["maximum_displacement"][-1]
        self.cells = cells
        self.releases = release_set(
            self.p, self.attractors, self.goal, PHASES, cells, settling, workers
        )

    def with_wrong_model(self):
        """Return the release set of an oscillator with wrong damping and force."""
        wrong = Oscillator(
            self.oscillator.damping * WRONG_DAMPING,
            self.oscillator.linear_frequency,
            self.oscillator.cubic,
            self.oscillator.force * WRONG_FORCE,
            self.oscillator.unbalance,
        )
        return _Free(wrong, self.frequency, self.cells, self.settling, self.workers).releases

    def labels(self, states, phase=math.pi / 2):
        """Return the labels of states at a phase."""
        limits = self.settling.tolerance, self.settling.limit
        return label_states(self.p, states, phase, self.attractors, *limits, self.workers)[0]

    def impulses(self):
        """Return the least change of velocity to the goal, at the best phase and as a median."""
        record = self.attractors.records[-1]
        speed = self.size * self.p[FREQUENCY]
        least = []
        for phase in 2 * math.pi * np.arange(PHASES) / PHASES:
            x, v = orbit_passages(self.p, record, phase)[0]
            states = np.stack([np.full(len(IMPULSES), x), v + speed * IMPULSES], axis=1)
            hit = self.labels(states, phase) == self.goal
            least.append(np.min(np.abs(speed * IMPULSES[hit]), initial=np.inf))
        return np.min(least), np.median(least)


class _Runs:
    """Trials with one damper at one frequency."""

    def __init__(self, free, damper, seed, trials):
        self.free, self.seed, self.trials = free, seed, trials
        self.on = pack(free.oscillator, damper, free.frequency)

    def trial(self, policy, stream, releases=None):
        """Return the outcome of trials of a policy, with the random draws of a stream."""
        free = self.free
        return run_trials(
            self.on,
            free.p,
            free.attractors,
            free.goal,
            policy,
            releases or free.releases,
            self.trials,
            float(PAPER_CYCLES),
            [self.seed, stream],
            free.settling,
            free.workers,
        )

    def tested_releases(self, count, stream):
        """Release at every phase in turn; return phases, depths, and whether the goal came."""
        free = self.free
        generator = np.random.default_rng([self.seed, stream])
        each = max(1, count // PHASES)
        start = np.tile(free.attractors.centre[-1], (each, 1))
        phases, depths, reached = [], [], []
        for phase in range(PHASES):
            draws = generator.random((each, DRAWS))
            policy = Policy(PHASE, float(TESTED_HOLD), phase)
            held = hold(
                self.on,
                free.p,
                start,
                draws,
                np.full(each, 2.0 * TESTED_HOLD),
                policy,
                free.releases,
                np.zeros((each, 2)),
                free.settling.tolerance,
                free.workers,
            )
            phases.append(np.full(each, phase))
            depths.append(held["depth"])
            reached.append(free.labels(held["state"]) == free.goal)
        return np.concatenate(phases), np.concatenate(depths), np.concatenate(reached)

    def chosen_policies(self, tested):
        """Return the four policies, and registered variables of the test of the prediction."""
        phases, _, reached = self.tested_releases(max(PHASES, self.trials * 8), 1)
        best = int(np.argmax([np.mean(reached[phases == k]) for k in range(PHASES)]))
        tries = [(self.trial(Policy(HOLD, float(cycles)), 2), cycles) for cycles in HOLDS]
        found = max(tries, key=lambda each: (each[0].reached.mean(), -np.median(each[0].cycles)))
        cycles = float(found[1])
        policies = Policy(SETTLED), Policy(HOLD, cycles), Policy(PHASE, cycles, best), Policy(STATE)
        _, depth, reached = self.tested_releases(tested, 3)
        tests = {
            "predicted_share": wilson(np.sum(depth > 0), len(depth)),
            "realised_share": wilson(np.sum(reached), len(depth)),
            "agreeing_share": wilson(np.sum((depth > 0) == reached), len(depth)),
        }
        return policies, tests


def _disturbed(runs):
    """Return registered variables of the state policy under noise, delay and a wrong model."""
    size = runs.free.size

    def success(releases=None, **disturbance):
        rows = []
        for margin in MARGINS:
            policy = Policy(STATE, margin=margin * size, **disturbance)
            rows.append(wilson(np.sum(runs.trial(policy, 0, releases).reached), runs.trials))
        return rows

    return {
        "noisy_success": [success(noise=noise * size) for noise in NOISES],
        "delayed_success": [success(delay=delay) for delay in DELAYS],
        "wrong_model_success": success(runs.free.with_wrong_model()),
    }


def _summary(outcome):
    """Return registered variables of the trials of one policy."""
    return {
        "policy_success": wilson(np.sum(outcome.reached), len(outcome.reached)),
        "policy_cycles": [quantile(outcome.cycles, share) for share in QUANTILES],
        "policy_damper": quantile(outcome.damper, 0.5),
        "policy_impacts": quantile(outcome.impacts, 0.5),
        "policy_releases": np.mean(outcome.releases),
    }


def quantile(values, share):
    """Return a quantile and its distribution-free 95 % interval, by order statistics, shape (3,).

    The number of values below the quantile is binomial.
    """
    ordered, count = np.sort(np.asarray(values, float)), len(values)
    spread = QUANTILE * math.sqrt(count * share * (1 - share))
    places = count * share + np.array([0.0, -spread, spread])
    rounded = [math.ceil(places[0]) - 1, math.floor(places[1]) - 1, math.ceil(places[2])]
    return ordered[np.clip(rounded, 0, count - 1)]
