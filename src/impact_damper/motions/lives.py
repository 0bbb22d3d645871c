"""Lives of chaotic motions: mean lives of transients, and lower bounds on lives of attractors.

Runs that begin close together on a chaotic motion are independent after a few tens of cycles. On a
transient they end at random times, distributed exponentially. The number of runs that end, divided
by the sum of the lives of all runs, therefore estimates the rate of ending, even if some do not
end.
"""

from dataclasses import replace

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.data.shares import escape_rate
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions import ensemble
from impact_damper.motions.ensemble import settle_many
from impact_damper.motions.records import CHAOTIC, MOTION, UNRESOLVED
from impact_damper.motions.watch import NEAR

# Z1 and Z1' of the first state of a run differ by at most APART from the state of the motion.
APART = 1e-4
# A transient ends when the distance of its state from an orbit falls below CAPTURE.
CAPTURE = 0.1
# A run that has not ended is continued for CHECKED forcing cycles, to decide whether it is still
# chaotic.
CHECKED = 300


def find_lives(parameters, outcomes, states, runs, periods, seed, settling, **running) -> dict:
    """Return the lives of the chaotic motions of a sweep, registered variables of shape (n, m).

    Parameters
    ----------
    parameters : array, shape (n, packed.COUNT)
    outcomes, states : array, shape (n, m) and (n, m, 4)
        Flags `outcome` of the motions at each value of the parameter, and their states at the
        strobe.
    runs, periods : int
        Number of runs of each chaotic motion, and forcing cycles of a run.
    **running
        `workers` and `progress` of `ensemble.settle`.
    """
    chaotic = np.argwhere(outcomes == flag("outcome", "chaotic"))
    table = {"life_ends": np.full(outcomes.shape, -1)}
    for name in ("mean_life", "mean_life_lower", "mean_life_upper"):
        table[name] = np.full(outcomes.shape, np.nan)
    if len(chaotic) == 0 or runs == 0:
        return table
    rows = np.repeat(parameters[chaotic[:, 0]], runs, axis=0)
    starts = np.repeat(states[tuple(chaotic.T)], runs, axis=0)
    starts[:, :2] += np.random.default_rng([seed, runs]).uniform(-APART, APART, (len(starts), 2))
    lives = _lives(rows, starts, periods, settling, **running).reshape(-1, runs)
    for place, own in zip(map(tuple, chaotic), lives, strict=True):
        rate, lower, upper = escape_rate(own, periods, lead=0)
        table["life_ends"][place] = np.sum(own <= periods)
        table["mean_life"][place] = 1 / rate if rate > 0 else np.nan
        table["mean_life_lower"][place] = 1 / upper
        table["mean_life_upper"][place] = 1 / lower if lower > 0 else np.inf
    return table


def _lives(parameters, states, periods, settling, **running):
    """Return the life of each run in forcing cycles; for a run that does not end `periods` + 1.

    When its chaos ends, a run approaches an orbit for some time before it counts as settled. This
    time is computed from the multiplier of the orbit and subtracted.
    """
    records, stop = np.zeros(len(states), MOTION), np.zeros(1, bool)

    def work(part):
        begin = 0.5 * np.pi / parameters[part, FREQUENCY]
        # The patience exceeds the limit. Therefore no run is stopped as chaotic, and no
        # neighbouring motion (tangent) is followed for the Lyapunov exponent.
        settle_many(
            parameters[part],
            states[part],
            begin,
            settling.tolerance,
            2 * periods + 2,
            periods,
            records[part],
            stop,
        )

    ensemble.run_chunks(work, len(states), running["workers"], running["progress"], stop)
    lasting = np.flatnonzero(records["outcome"] == UNRESOLVED)
    checked = replace(settling, patience=CHECKED, limit=CHECKED)
    again = ensemble.settle(
        parameters[lasting], records["state"][lasting], checked, from_strobe=True, **running
    )
    lives = records["periods_run"].astype(float)
    with np.errstate(divide="ignore", invalid="ignore"):
        decay = -np.log(np.abs(records["multiplier"])) / records["period"]
        approach = np.nan_to_num(np.log(CAPTURE / NEAR) / decay)
    lives = np.maximum(lives - approach, 1)
    # A run that proves no longer chaotic when it is continued counts as ended at `periods`.
    still = np.isin(again["outcome"], (CHAOTIC, UNRESOLVED))
    lives[lasting] = np.where(still, periods + 1, periods)
    return lives
