"""Periodic orbits that one thread finds in a second, by single and by multiple shooting.

Shooting is Newton's method for the state that repeats after a period. Multiple shooting divides the
period, for strongly unstable orbits. The quiet motion is the small motion with damper.
"""

from functools import partial

import numpy as np
import pandas as pd

from benchmarks.timing import interleaved, spread
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit

DAMPER, FREQUENCY, SPAN = Damper(0.12, 2.0), 2.0, (0.3, 2.6)
# A state near the quiet motion, and the disturbance of a state from which an orbit is found again.
QUIET, DISTURBED = (0.006, 0.187, 0.002, -2.408), 1e-8


def family(frequency):
    """Return the parameters, packed by `pack`, of the damper of figure 5 (a) of the paper."""
    return pack(Oscillator(0.215), DAMPER, frequency)


def mild_and_strong(count):
    """Return orbits of the branch of the quiet motion, about `count` for each kind of shooting."""
    branch = follow_branch(family, find_orbit(family(FREQUENCY), QUIET), FREQUENCY, SPAN)
    orbits = {"single": [], "multiple": []}
    for point in branch.points:
        orbits["single" if len(point.orbit.states) == 1 else "multiple"].append(point.orbit)
    return {name: found[:: max(1, len(found) // count)] for name, found in orbits.items()}


def table(count, rounds):
    """Return how many orbits are found in a second from disturbed states, by kind of shooting.

    `maps_each` is the mean number of times that Newton's method integrates over the period.
    """
    orbits = mild_and_strong(count)

    def find(name):
        return [
            find_orbit(each.p, each.state + DISTURBED, each.periods, each.phase)
            for each in orbits[name]
        ]

    found = {name: find(name) for name in orbits}
    lines = []
    for name, seconds in interleaved({n: partial(find, n) for n in orbits}, rounds).items():
        row = {
            "shooting": name,
            "orbits": len(orbits[name]),
            "largest_multiplier": max(abs(each.multipliers[0]) for each in orbits[name]),
            "maps_each": np.mean([each.maps for each in found[name]]),
            "converged": np.mean([each.converged for each in found[name]]),
        }
        lines.append(row | spread("orbits_a_second", len(orbits[name]) / seconds))
    return pd.DataFrame(lines)
