"""Dampers compared for migration and for suppression: maps over mass, gap and restitution.

Suppression means that the damper stays on and keeps the motion small. Migration means that the
damper is switched on and off until the oscillator without it changes from its large motion, the
resonance motion, to its small one, the goal. A policy decides when to switch the damper off (to
release it). A hold is the time with the damper on.

A stage is a step of the workflow.
"""

import math

import numpy as np

from chatterjee1995.stages.release_trials import free_case, quantile
from impact_damper.data.datasets import dataset, is_settled
from impact_damper.data.shares import BOUNDS, wilson
from impact_damper.model.bounds import RUNS_RANGE, SEED_RANGE, check_count
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, describe
from impact_damper.model.settling import check_settling
from impact_damper.motions import ensemble
from impact_damper.motions.migration import PAPER_CYCLES
from impact_damper.motions.policies import SETTLED, STATE, Policy, run_trials
from impact_damper.motions.policy_choice import best_policy
from impact_damper.motions.start_states import random_starts

# The policy by state switches the damper off once a release would lead to the goal. If no such
# state comes within a largest number of cycles, it switches the damper off and on again. Two such
# limits are tried, 5 cycles and no limit, and the better one counts.
WAITS = [Policy(STATE, 5.0), Policy(STATE, math.inf)]
POLICIES = ["settled", "state"]
# A motion is quiet if its largest displacement is below QUIET times that of the resonance motion
# without the damper.
QUIET = 0.5


def release_dampers(
    oscillator,
    frequencies,
    mass_ratios,
    clearances,
    restitutions,
    *,
    cut,
    trials=40,
    starts=12,
    cells=64,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Compare dampers by success and time of migration, and by the sizes of damped motions.

    Parameters
    ----------
    oscillator : Oscillator
    frequencies : sequence of float
        Forcing frequencies at which both free motions of period 1 exist.
    mass_ratios, clearances, restitutions : sequence of float
        Values of the dampers of the map; all combinations are computed.
    cut : dict
        Further dampers that differ in the restitution only: `mass_ratio`, `clearance`, and a list
        `restitutions`.
    trials : int
        Trials of each policy.
    starts : int
        Random starts of motions with the damper on.
    cells : int
        Cells on each axis of the coarse grid on which the states that lead to the goal are found.
    seed : int
    settling : Settling, optional
    workers : int
        Threads; the result does not depend on it.
    progress : str, optional
        Unused; jobs pass it to every stage.

    Returns
    -------
    xarray.Dataset
        For each damper and policy (the paper's, and the policy by state) the share of trials that
        reach the goal within 350 cycles and the median of the cycles until the goal. For each
        damper the largest displacement with the damper on, and the displacement of the quiet
        motion. This is the smallest settled motion of any period, if it is quiet (QUIET).

    Raises
    ------
    ValueError
        If an argument is out of range, or the free oscillator lacks one of its two motions at a
        frequency.
    """
    settling = check_settling(settling)
    check_count("trials", trials, **RUNS_RANGE)
    check_count("starts", starts, **RUNS_RANGE)
    check_count("seed", seed, **SEED_RANGE)
    map_shape = len(frequencies), len(restitutions), len(mass_ratios), len(clearances)
    mapped = [
        Damper(mass_ratio, clearance, restitution)
        for restitution in restitutions
        for mass_ratio in mass_ratios
        for clearance in clearances
    ]
    along = [Damper(cut["mass_ratio"], cut["clearance"], e) for e in cut["restitutions"]]
    found = {"damper": [], "cut": []}
    resonance = []
    for frequency in frequencies:
        free = free_case(oscillator, frequency, cells, settling, workers)
        resonance.append(free.size)
        judge = _Judge(free, oscillator, frequency, trials, starts, seed)
        found["damper"].append(judge.dampers(mapped))
        found["cut"].append(judge.dampers(along))
    data = {"resonance_displacement": resonance}
    shapes = {"damper": map_shape, "cut": (len(frequencies), len(along))}
    for part, rows in found.items():
        for name in rows[0]:
            values = np.array([row[name] for row in rows])
            data[f"{part}_{name}"] = values.reshape(*shapes[part], *values.shape[2:])
    made = describe(oscillator, settling) | {"trials": trials, "starts": starts, "seed": seed}
    made |= {"cut_mass_ratio": cut["mass_ratio"], "cut_clearance": cut["clearance"]}
    coordinates = {
        "frequency": frequencies,
        "restitution": restitutions,
        "mass_ratio": mass_ratios,
        "clearance": clearances,
        "cut_restitution": cut["restitutions"],
        "policy": POLICIES,
        "bound": BOUNDS,
    }
    return dataset(data, coordinates, made | {"cells": cells}, "Dampers for migration")


class _Judge:
    """Computes the results of dampers at one frequency.

    Parameters
    ----------
    free : FreeCase
        The oscillator without the damper, with the states that lead to the goal.
    oscillator, frequency, trials, starts, seed
        Arguments of `release_dampers`; `frequency` is one value.
    """

    def __init__(self, free, oscillator, frequency, trials, starts, seed):
        self.free, self.oscillator, self.frequency = free, oscillator, frequency
        self.trials, self.starts, self.seed = trials, starts, seed

    def dampers(self, dampers):
        """Return a dict of arrays, whose rows are dampers.

        "success" and "cycles" come from the trials of both policies, "quiet" and "largest" are
        displacements.
        """
        rows = [self._migration(damper) for damper in dampers]
        sizes = self._displacements(dampers)
        return {
            "success": np.array([success for success, _ in rows]),
            "cycles": np.array([cycles for _, cycles in rows]),
            "quiet": sizes[0],
            "largest": sizes[1],
        }

    def _migration(self, damper):
        """Return the success of each policy and the median of its cycles, shape (2, 3) each.

        A row holds a value and the ends of its 95 % confidence interval.
        """
        on, limit = pack(self.oscillator, damper, self.frequency), float(PAPER_CYCLES)
        chosen = best_policy(on, self.free, WAITS, self.trials, limit, [self.seed, 1])
        outcomes = [
            run_trials(on, self.free, policy, self.trials, limit, self.seed)
            for policy in (Policy(SETTLED), chosen)
        ]
        return (
            [wilson(np.sum(each.reached), self.trials) for each in outcomes],
            [quantile(each.cycles, 0.5) for each in outcomes],
        )

    def _displacements(self, dampers):
        """Return the quiet and the largest displacement with each damper; NaN if not found."""
        free = self.free
        parameters = [pack(self.oscillator, damper, self.frequency) for damper in dampers]
        given = self.frequency, self.starts, self.seed, free.settling
        states = [random_starts(self.oscillator, damper, *given)[0] for damper in dampers]
        found = ensemble.settle(
            np.repeat(parameters, self.starts, axis=0),
            np.concatenate(states),
            free.settling,
            workers=free.workers,
        ).reshape(len(dampers), self.starts)
        size = found["maximum_displacement"]
        quiet = np.where(is_settled(found) & (size < QUIET * free.size), size, np.inf).min(axis=1)
        return np.where(np.isfinite(quiet), quiet, np.nan), size.max(axis=1)
