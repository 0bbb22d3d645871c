"""How long chaotic motions last: mean lives of transients, and bounds on those of attractors.

A motion that is chaotic for some hundred periods may still be a transient. Runs that begin close
together on it differ entirely after a few tens of periods, and end at random: their lives are
exponentially distributed. So the number that end, divided by the time for which all of them last
together, estimates the rate of ending, whether or not all runs end.
"""

from dataclasses import replace

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.data.shares import escape_rate
from impact_damper.motions import ensemble
from impact_damper.motions.records import CHAOTIC, MOTION, UNRESOLVED
from impact_damper.motions.settling import settle_many
from impact_damper.motions.watch import NEAR
from impact_damper.system.packed import FREQUENCY

# Largest distance by which the runs of one motion differ at the beginning, in Z1 and Z1'.
APART = 1e-4
# Distance from an orbit at which a transient has ended.
CAPTURE = 0.1
# Forcing periods after which a run that has not ended is seen to be chaotic, or not any more.
CHECKED = 300


def find_lives(parameters, outcomes, states, runs, periods, seed, settling, **running) -> dict:
    """Return how long the chaotic motions of a sweep last.

    Parameters
    ----------
    parameters : array, shape (n, packed.COUNT)
        Packed parameters along the sweep.
    outcomes : array, shape (n, m)
        Flags `outcome` of the motions at each value of the parameter.
    states : array, shape (n, m, 4)
        States of the motions at the strobe.
    runs, periods : int
        Runs of each chaotic motion, and forcing periods of a run.
    seed : int
    settling : Settling
    **running
        `workers` and `progress` of `ensemble.settle`.

    Returns
    -------
    dict of numpy.ndarray, shape (n, m)
        `life_ends`, the number of runs that ended; `mean_life`, in forcing periods, NaN where none
        ended; `mean_life_lower` and `mean_life_upper`, the ends of its 95 % interval, infinite
        above where none ended. NaN (-1 for the number) for motions that are not chaotic.
    """
    chaotic = np.argwhere(outcomes == flag("outcome", "chaotic"))
    found = {"life_ends": np.full(outcomes.shape, -1)}
    for name in ("mean_life", "mean_life_lower", "mean_life_upper"):
        found[name] = np.full(outcomes.shape, np.nan)
    if len(chaotic) == 0 or runs == 0:
        return found
    rows = np.repeat(parameters[chaotic[:, 0]], runs, axis=0)
    starts = np.repeat(states[tuple(chaotic.T)], runs, axis=0)
    starts[:, :2] += np.random.default_rng([seed, runs]).uniform(-APART, APART, (len(starts), 2))
    lives = _lives(rows, starts, periods, settling, **running).reshape(-1, runs)
    for place, own in zip(map(tuple, chaotic), lives, strict=True):
        rate, lower, upper = escape_rate(own, periods, lead=0)
        found["life_ends"][place] = np.sum(own <= periods)
        found["mean_life"][place] = 1 / rate if rate > 0 else np.nan
        found["mean_life_lower"][place] = 1 / upper
        found["mean_life_upper"][place] = 1 / lower if lower > 0 else np.inf
    return found


def _lives(parameters, states, periods, settling, **running):
    """Return the periods after which each run ends, more than `periods` for a run that lasts.

    A run that ends approaches an orbit before it is found to have settled; this time, which follows
    from the multiplier of the orbit, is not part of its life.
    """
    records, stop = np.zeros(len(states), MOTION), np.zeros(1, bool)

    def work(part):
        begin = 0.5 * np.pi / parameters[part, FREQUENCY]
        # with this patience no run is stopped as chaotic, and no tangent is followed
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
    # a run that is not chaotic any more ended shortly before
    still = np.isin(again["outcome"], (CHAOTIC, UNRESOLVED))
    lives[lasting] = np.where(still, periods + 1, periods)
    return lives
