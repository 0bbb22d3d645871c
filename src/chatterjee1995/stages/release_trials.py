"""The free oscillator, and statistics of trials, for all stages on policies of migration.

Without the damper (free) the oscillator has a large motion, the resonance motion, and a small one,
the non-resonance motion. Migration leads from the large to the small one by switching the damper on
and off. A policy decides when to switch the damper off. The release set contains the states from
which the free motion settles to the small motion.

A stage is a step of the workflow.
"""

import math

import numpy as np

from impact_damper.data.shares import QUANTILE, wilson
from impact_damper.model.packed import pack
from impact_damper.motions.free_case import FreeCase
from impact_damper.motions.free_motions import free_motions
from impact_damper.motions.release_set import release_set
from impact_damper.orbits.basins import REACH, free_attractors

# Number of phases in a cycle at which the controller observes the state.
PHASES = 16
# Quantiles of the cycles until the goal that are stored: the median and the 95 % quantile.
QUANTILES = [0.5, 0.95]


def free_case(oscillator, frequency, cells, settling, workers) -> FreeCase:
    """Return the `FreeCase` at a frequency, with its release set.

    `cells` is the number of cells on each axis of the coarse grid of the release set.

    Raises
    ------
    ValueError
        If the free oscillator does not have both a non-resonance and a resonance motion.
    """
    p = pack(oscillator, None, frequency)
    known = free_motions(oscillator, frequency, settling)
    window = REACH / 2 * np.array([known.displacement, known.speed])
    attractors = free_attractors(p, window, settling)
    ones = np.flatnonzero(attractors.records["period"] == 1)
    if len(ones) < 2 or ones[-1] != len(attractors.records) - 1:
        raise ValueError(
            f"frequency = {frequency:g}: must have a non-resonance and a resonance motion "
            "without the damper"
        )
    goal = int(ones[0])
    releases = release_set(p, attractors, goal, PHASES, cells, settling, workers)
    return FreeCase(p, attractors, goal, releases, settling, workers)


def summary(outcome):
    """Return a dict of dataset variables of the trials of one policy, from their `Outcome`."""
    return {
        "policy_success": wilson(np.sum(outcome.reached), len(outcome.reached)),
        "policy_cycles": [quantile(outcome.cycles, share) for share in QUANTILES],
        "policy_damper": quantile(outcome.damper, 0.5),
        "policy_impacts": quantile(outcome.impacts, 0.5),
        "policy_releases": np.mean(outcome.releases),
    }


def quantile(values, share):
    """Return a quantile and the ends of its 95 % confidence interval, shape (3,).

    The interval needs no assumption on the distribution of the values: the number of values below
    the quantile has a binomial distribution, which gives the ends as sorted values (order
    statistics).
    """
    ordered, count = np.sort(np.asarray(values, float)), len(values)
    spread = QUANTILE * math.sqrt(count * share * (1 - share))
    places = count * share + np.array([0.0, -spread, spread])
    rounded = [math.ceil(places[0]) - 1, math.floor(places[1]) - 1, math.ceil(places[2])]
    return ordered[np.clip(rounded, 0, count - 1)]
