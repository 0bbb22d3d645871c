"""Choose the parameters hold and phase of release policies such that the goal is reached soonest.

A hold is a time with the damper on, which ends with a release (switching the damper off). The goal
is that the motion without the damper settles to the free non-resonance motion. The choice takes two
steps, with random numbers that are independent of those of the final trials. First, holds are
recorded, and the free motions after releases at all candidate moments are labelled by where they
settle. If a hold with the release takes c forcing cycles on average and leads to the goal with
probability q, the goal is reached after c/q cycles on average. Second, the candidates with the
smallest c/q are run in full trials.
"""

import math

import numpy as np

from impact_damper.migration.policies import DRAWS, HOLD, PHASE, STATE, Draws, Policy, run_trials
from impact_damper.migration.recorded import label_moments, record

# HOLDS: candidate lengths of a hold in forcing cycles. TRIED: number of candidates in full trials.
HOLDS = (1, 2, 3, 5, 8, 13, 21, 34)
TRIED = 3


def chosen_policies(on, free, trials, limit, seed):
    """Return the best policy of each of the kinds HOLD, PHASE and STATE.

    The arguments are those of `policies.run_trials`.
    """
    hold_cycles, phase_cycles = expected_cycles(on, free, trials, [*seed, 0])
    holds = [Policy(HOLD, HOLDS[k]) for k in np.argsort(hold_cycles, kind="stable")[:TRIED]]
    order = np.argsort(phase_cycles, axis=None, kind="stable")[:TRIED]
    places = zip(*np.unravel_index(order, phase_cycles.shape), strict=True)
    phases = [Policy(PHASE, HOLDS[k], int(phase)) for k, phase in places]
    # Candidate longest holds of the policy by state: the best fixed holds, the longest one, and
    # holds without limit.
    waits = [Policy(STATE, each.hold) for each in holds[:2]] + [Policy(STATE, HOLDS[-1])]
    waits.append(Policy(STATE, math.inf))

    kinds = holds, phases, waits
    return [best_policy(on, free, each, trials, limit, [*seed, 1]) for each in kinds]


def best_policy(on, free, candidates, trials, limit, seed):
    """Return the policy among `candidates` that needs the fewest cycles on average.

    A trial that does not reach the goal counts with `limit` cycles. The other arguments are those
    of `policies.run_trials`.
    """

    def cost(policy):
        outcome = run_trials(on, free, policy, trials, limit, seed)
        return np.mean(np.minimum(outcome.cycles, limit))

    return min(candidates, key=cost)


def expected_cycles(on, free, trials, seed):
    """Return estimates of the forcing cycles from a free resonance motion until the goal.

    Returns
    -------
    of_hold : numpy.ndarray, shape (holds,)
        Cycles for a release after each hold of HOLDS.
    of_phase : numpy.ndarray, shape (holds, phases)
        Cycles for a release after each hold, at each phase of the forcing. Infinite where no
        release led to the goal.
    """
    drawn = Draws(seed, trials).following()
    starts = free.strobe_states(np.full(trials, free.resonance), drawn[:, DRAWS])
    limits = np.full(trials, HOLDS[-1] + 1.0)
    recording = record(on, free, starts, drawn[:, :DRAWS].copy(), limits)
    phases = recording.phases
    # For each length of a hold and each phase of the forcing: the first moment that has this phase
    # after a hold of this length.
    moments = np.add.outer(phases * np.array(HOLDS), np.arange(phases))
    rows = np.repeat(np.arange(trials), moments.size)
    columns = np.tile(moments.ravel(), trials)
    labels, times = label_moments(free, recording, rows, columns, np.full(len(rows), np.inf))
    hold = np.tile(np.repeat(np.arange(len(HOLDS)), phases), trials)
    cell = hold * phases + recording.phase(rows, columns)
    shape = len(HOLDS), phases
    hits, cycles = (
        np.bincount(cell, weights, math.prod(shape)).reshape(shape)
        for weights in (labels == free.goal, times)
    )
    with np.errstate(divide="ignore"):
        return np.sum(cycles, axis=1) / np.sum(hits, axis=1), cycles / hits
