"""Choose the two parameters of release policies with which the goal is reached soonest.

Without the damper the oscillator has a large motion, the resonance motion, and a small one, the
non-resonance motion. The goal is that the free motion settles to the small one. A hold is a time
with the damper on, which ends with a release (switching the damper off). A policy decides when to
release. Its parameters are the length of a hold and the phase of the forcing at the release.

The choice takes two steps. First, holds are recorded, and the free motion after a release at each
candidate moment is labelled by the motion to which it settles. If a hold and the free motion after
this hold take c forcing cycles on average and lead to the goal with probability q, the goal is
reached after c/q cycles on average. Second, the candidates with the smallest c/q are run in full
trials. Both steps use other random numbers than the trials that compare the policies later.
"""

import math

import numpy as np

from impact_damper.motions.policies import DRAWS, HOLD, PHASE, STATE, Draws, Policy, run_trials
from impact_damper.motions.recorded import label_moments, record

# HOLDS: candidate lengths of a hold in forcing cycles (Fibonacci numbers, each about 1.6 times the
# one before). TRIED: number of candidates of the kinds HOLD and PHASE in full trials.
HOLDS = (1, 2, 3, 5, 8, 13, 21, 34)
TRIED = 3


def chosen_policies(on, free, trials, limit, seed):
    """Return a list of the best policy of each of the kinds HOLD, PHASE and STATE.

    The kinds are explained in `policies`. The arguments are those of `policies.run_trials`.
    """
    hold_cycles, phase_cycles = expected_cycles(on, free, trials, [*seed, 0])
    holds = [Policy(HOLD, HOLDS[k]) for k in np.argsort(hold_cycles, kind="stable")[:TRIED]]
    order = np.argsort(phase_cycles, axis=None, kind="stable")[:TRIED]
    places = zip(*np.unravel_index(order, phase_cycles.shape), strict=True)
    phases = [Policy(PHASE, HOLDS[k], int(phase)) for k, phase in places]
    # For the kind STATE, `hold` is the largest length of a hold. Candidates are the two best
    # lengths of the kind HOLD, the last of HOLDS, and infinity.
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
        Cycles with releases after each length of HOLDS, averaged over the phases of the forcing.
    of_phase : numpy.ndarray, shape (holds, phases)
        Cycles with releases after each length of HOLDS, at each phase of the forcing. Infinite
        where no release led to the goal.
    """
    drawn = Draws(seed, trials).following()
    starts = free.strobe_states(np.full(trials, free.resonance), drawn[:, DRAWS])
    limits = np.full(trials, HOLDS[-1] + 1.0)
    recording = record(on, free, starts, drawn[:, :DRAWS].copy(), limits)
    phases = recording.phases
    # Moments of the release, indices of recorded states. For each length of a hold these are all
    # moments of the cycle that follows it, so each phase of the forcing occurs once.
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
