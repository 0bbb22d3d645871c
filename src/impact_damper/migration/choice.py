"""Choose the numbers of policies: hold and phase that lead to the goal soonest.

Two steps, on random numbers apart from those of the final trials. Holds are recorded once, and
releases at all candidate moments are labelled. In a renewal process in which a try takes c forcing
periods on average and succeeds with chance q, the goal is reached after c/q on average. The
candidates with the smallest c/q are then tried in full.
"""

import math

import numpy as np

from impact_damper.migration.policies import DRAWS, HOLD, PHASE, STATE, Draws, Policy, run_trials
from impact_damper.migration.recorded import label_moments, record

# Forcing periods of a hold among which is chosen, and candidates that are tried in full.
HOLDS = (1, 2, 3, 5, 8, 13, 21, 34)
TRIED = 3


def chosen_policies(on, free, trials, limit, seed):
    """Return the best policies of the kinds HOLD, PHASE and STATE; arguments of `run_trials`."""
    hold_cycles, phase_cycles = expected_cycles(on, free, trials, [*seed, 0])
    holds = [Policy(HOLD, HOLDS[k]) for k in np.argsort(hold_cycles, kind="stable")[:TRIED]]
    order = np.argsort(phase_cycles, axis=None, kind="stable")[:TRIED]
    places = zip(*np.unravel_index(order, phase_cycles.shape), strict=True)
    phases = [Policy(PHASE, HOLDS[k], int(phase)) for k, phase in places]
    # patience of the policy by state: holds that may lead to the goal, and without end
    waits = [Policy(STATE, each.hold) for each in holds[:2]] + [Policy(STATE, HOLDS[-1])]
    waits.append(Policy(STATE, math.inf))

    kinds = holds, phases, waits
    return [best_policy(on, free, each, trials, limit, [*seed, 1]) for each in kinds]


def best_policy(on, free, candidates, trials, limit, seed):
    """Return the policy with the fewest cycles in trials; arguments of `run_trials`."""

    def quality(policy):
        outcome = run_trials(on, free, policy, trials, limit, seed)
        # the mean of cycles, at most the limit, tells successes and times at once
        return np.mean(np.minimum(outcome.cycles, limit))

    return min(candidates, key=quality)


def expected_cycles(on, free, trials, seed):
    """Return estimates of the forcing periods until the goal, of each hold and of (hold, phase).

    Holds begin on the resonance motion.

    Returns
    -------
    of_hold : numpy.ndarray, shape (holds,)
    of_phase : numpy.ndarray, shape (holds, phases)
        Infinite where no release led to the goal.
    """
    drawn = Draws(seed, trials).following()
    starts = free.strobe_states(np.full(trials, free.resonance), drawn[:, DRAWS])
    limits = np.full(trials, HOLDS[-1] + 1.0)
    recording = record(on, free, starts, drawn[:, :DRAWS].copy(), limits)
    phases = recording.phases
    # the first moments at each phase after a hold
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
