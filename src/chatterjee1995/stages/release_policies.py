"""Policies that say when to switch the damper off, compared by trials of migration."""

import math
from typing import NamedTuple

import numpy as np

from chatterjee1995.stages.releases import PAPER_CYCLES
from impact_damper.data.datasets import dataset
from impact_damper.data.shares import BOUNDS, QUANTILE, wilson
from impact_damper.data.variables import register
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import CLEARANCE, FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.motions import ensemble
from impact_damper.motions.attractors import PHASES, release_set
from impact_damper.motions.legs import HOLD, PHASE, SETTLED, STATE, hold
from impact_damper.motions.steady import run_chunks
from impact_damper.motions.strobe_map import strobe_time

register(
    """
case | case | | | index of a damper
policy | policy | | | policy by which the damper is switched off
quantile | quantile | | | quantile over all trials
case_mass_ratio | case | | rm | mass ratio of a damper
case_clearance | case | clearance | d0 | clearance of a damper
case_restitution | case | | e | coefficient of restitution of a damper
policy_success | case frequency policy bound | | | share of trials that reach the goal within 350
  cycles
policy_cycles | case frequency policy quantile bound | | | cycles until the motion has settled on
  the goal, infinite without success
policy_damper | case frequency policy | | | median of the cycles with the damper on
policy_impacts | case frequency policy | | | median of the impacts
policy_releases | case frequency policy | | | mean number of releases
policy_hold | case frequency policy | | | cycles for which the policy keeps the damper on; for
  release by state, at most
policy_phase | case frequency policy | angle | | phase Omega T of the release that the policy
  chose
    """
)

POLICIES = ["settled", "hold", "phase", "state"]
HOLDS = (1, 2, 3, 5, 8, 13, 21, 34)  # numbers of cycles for which policies leave the damper on
QUANTILES = [0.5, 0.95]  # quantiles of the cycles until the goal
# A run with the damper on, for a number of `cycles`. `released` is true if a rule ended the run,
# and false if a limit of cycles ended it. At the end of the run the damper is switched off. The
# next strobe comes `ahead` cycles later, and `state` holds Z1 and Z1' at this strobe.
HELD = np.dtype(
    [("released", "?"), ("cycles", "f8"), ("impacts", "i8"), ("state", "f8", 2), ("ahead", "f8")]
)
# A rule for the release (`legs.hold`): kind of policy, number of cycles, index of a forcing phase.
RULE = np.dtype([("kind", "i8"), ("cycles", "f8"), ("phase", "i8")])


class Outcome(NamedTuple):
    """Results of trials: `cycles` to the goal, and cycles with the damper on (`damper`)."""

    reached: np.ndarray
    cycles: np.ndarray
    damper: np.ndarray
    impacts: np.ndarray
    releases: np.ndarray


def release_policies(
    oscillator, dampers, frequencies, *, trials=200, cells=64, seed=1995, settling, workers=1
):
    """Return a dataset that compares release policies for each damper and frequency.

    Each policy has `trials` trials. The grid of a release set has `cells`^2 cells. The cells at the
    edge of the set are divided into smaller cells.
    """
    shape = len(dampers), len(frequencies), len(POLICIES)
    data = {
        "policy_success": np.empty((*shape, 3)),
        "policy_cycles": np.empty((*shape, len(QUANTILES), 3)),
        "policy_damper": np.empty(shape),
        "policy_impacts": np.empty(shape),
        "policy_releases": np.empty(shape),
        "policy_hold": np.full(shape, np.nan),
        "policy_phase": np.full(shape, np.nan),
    }
    for j, frequency in enumerate(frequencies):
        releases = release_set(oscillator, frequency, settling, cells=cells, workers=workers)
        for i, damper in enumerate(dampers):
            runs = Trials(pack(oscillator, damper, frequency), releases, settling, workers)
            rules = runs.rules(max(1, trials // 4), [seed, 1])
            outcomes = runs.run(rules, trials, [seed, 0])
            for k, (rule, outcome) in enumerate(zip(rules, outcomes, strict=True)):
                for name, values in summary(outcome).items():
                    data[name][i, j, k] = values
                if rule[0] != SETTLED:
                    data["policy_hold"][i, j, k] = rule[1]
                if rule[0] == PHASE:
                    data["policy_phase"][i, j, k] = 2 * math.pi * rule[2] / PHASES
    for name in ("mass_ratio", "clearance", "restitution"):
        data[f"case_{name}"] = [getattr(damper, name) for damper in dampers]
    made = describe(oscillator, settling) | {"trials": trials, "seed": seed}
    coordinates = {"case": np.arange(len(dampers)), "frequency": frequencies}
    coordinates |= {"policy": POLICIES, "quantile": QUANTILES, "bound": BOUNDS}
    return dataset(data, coordinates, made | {"cells": cells}, "Policies of migration")


class Trials(NamedTuple):
    """Trials of migration with one damper at one frequency."""

    on: np.ndarray
    releases: tuple
    settling: tuple
    workers: int = 1

    def rules(self, trials, seed):
        """Return for each policy the rule that reaches the goal in the fewest cycles on average."""

        def costs(rules):
            cycles = [outcome.cycles for outcome in self.run(rules, trials, seed)]
            return np.mean(np.minimum(cycles, PAPER_CYCLES), axis=1)

        holds = [(HOLD, float(cycles), 0) for cycles in HOLDS]
        states = [(STATE, float(cycles), 0) for cycles in HOLDS]
        of_holds, of_states = np.split(costs(holds + states), 2)
        best = holds[np.argmin(of_holds)]
        after = sorted({1.0, best[1]})
        phases = [(PHASE, cycles, index) for cycles in after for index in range(PHASES)]
        chosen = phases[np.argmin(costs(phases))], states[np.argmin(of_states)]
        return [(SETTLED, 0.0, 0), best, *chosen]

    def run(self, rules, trials, seed):
        """Return a list with the `Outcome` of each rule. All trials run together to save time."""
        generator, limit = np.random.default_rng(seed), float(PAPER_CYCLES)
        owner = self.releases.attractors.owner
        resonance, count = owner[-1], len(rules) * trials
        place, spent, damper = np.full(count, resonance), np.zeros(count), np.zeros(count)
        impacts, released = np.zeros((2, count), int)
        reached, running = np.zeros(count, bool), np.arange(count)
        rules = np.repeat(np.array(rules, RULE), trials)
        while len(running):
            # Four random numbers for each trial: three for `hold_many`, one for the start.
            draws = generator.random((trials, 4))[running % trials]
            first = np.searchsorted(owner, place[running])
            number = np.searchsorted(owner, place[running], side="right") - first
            chosen = first + np.minimum((draws[:, 3] * number).astype(int), number - 1)
            starts = self.releases.attractors.centre[chosen]
            held = self.hold(starts, draws, limit - spent[running], rules[running])
            damper[running] += held["cycles"]
            impacts[running] += held["impacts"]
            spent[running] += held["cycles"]
            held, rows = held[held["released"]], running[held["released"]]
            labels, periods = self.labels(held["state"])
            spent[rows] += held["ahead"] + periods
            released[rows] += 1
            reached[rows] = (labels == self.releases.goal) & (spent[rows] <= limit)
            place[rows] = np.where(labels >= 0, labels, resonance)
            running = rows[(labels != self.releases.goal) & (spent[rows] < limit)]
        columns = reached, np.where(reached, spent, np.inf), damper, impacts, released
        return list(map(Outcome, *(column.reshape(-1, trials) for column in columns)))

    def hold(self, starts, draws, limits, rules):
        """Call `hold_many` in several threads. Return a HELD record for each of `starts`."""
        held, stop = np.zeros(len(starts), HELD), np.zeros(1, bool)
        set_ = self.releases

        def work(part):
            runs = starts[part], draws[part], limits[part], rules[part]
            sets = set_.depth, set_.half, self.settling.tolerance
            hold_many(self.on, set_.p, *runs, *sets, held[part], stop)

        work(slice(0, 0))
        run_chunks(work, len(starts), self.workers, None, stop, size=64)
        return held

    def labels(self, states):
        """Return labels and convergence times of the free motions from `states` at the strobe."""
        settings = self.settling.tolerance, self.settling.limit, self.workers
        return ensemble.label_states(
            self.releases.p, states, math.pi / 2, self.releases.attractors, *settings
        )


@kernel
def hold_many(on, off, starts, draws, limits, rules, depth, half, tolerance, held, stop):
    """Run each trial with the damper on, then without the damper to the next strobe.

    `starts` (n, 2) are Z1 and Z1' at the strobe before the damper is switched on. `draws` set the
    phase of switching on, the place of the loose mass and the release. `legs.hold` explains the
    other arguments. The results are written to `held`.
    """
    none, path, work, y = np.empty((0, 4)), np.empty((0, 5)), workspace(), np.empty(4)
    period, first = 2.0 * math.pi / on[FREQUENCY], strobe_time(on)
    for i in range(len(starts)):
        if stop[0]:
            return
        y[0], y[1], y[2], y[3] = starts[i, 0], starts[i, 1], starts[i, 0], starts[i, 1]
        begin = first + draws[i, 0] * 2.0 * math.pi / on[FREQUENCY]
        advance(off, y, none, 0, first, begin, tolerance, work)
        y[2], y[3] = (2.0 * draws[i, 1] - 1.0) * on[CLEARANCE], 0.0
        side, draw, out = side_of(on, y), draws[i, 2], held[i]
        rule = rules[i].kind, rules[i].cycles, rules[i].phase
        t, released, contacts = hold(
            on, y, side, begin, limits[i], rule, draw, depth, half, tolerance, path, work
        )
        out.released, out.impacts, out.cycles = released, contacts, (t - begin) / period
        count = math.ceil((t - first) / period - 1e-12)
        advance(off, y, none, 0, t, first + count * period, tolerance, work)
        out.ahead = first / period + count - t / period
        out.state[0], out.state[1] = y[0], y[1]


def summary(outcome):
    """Return a dict: the variables of the dataset, for the trials of one policy."""
    return {
        "policy_success": wilson(np.sum(outcome.reached), len(outcome.reached)),
        "policy_cycles": [quantile(outcome.cycles, share) for share in QUANTILES],
        "policy_damper": quantile(outcome.damper, 0.5)[0],
        "policy_impacts": quantile(outcome.impacts, 0.5)[0],
        "policy_releases": np.mean(outcome.releases),
    }


def quantile(values, share):
    """Return a quantile and both ends of its approximate 95 % confidence interval."""
    ordered, count = np.sort(np.asarray(values, float)), len(values)
    spread = QUANTILE * math.sqrt(count * share * (1 - share))
    places = count * share + np.array([0.0, -spread, spread])
    rounded = [math.ceil(places[0]) - 1, math.floor(places[1]) - 1, math.ceil(places[2])]
    return ordered[np.clip(rounded, 0, count - 1)]
