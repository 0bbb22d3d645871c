"""Starts (initial states) that one thread runs until they settle or are classified, in a second.

With most of the random dampers the motions are chaotic.
"""

from dataclasses import replace
from functools import partial

import numpy as np
import pandas as pd

from benchmarks.timing import interleaved, spread
from impact_damper.data.motion_variables import OUTCOME
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble
from impact_damper.motions.simulate import random_states

SEED = 3
# Least and greatest mass ratio, clearance, forcing frequency and restitution of random dampers.
LEAST, MOST = (0.05, 0.25, 1.0, 0.6), (0.5, 4.0, 3.0, 1.0)
STARTS = 8  # for each damper


def draw(count):
    """Return packed parameters and starts of random dampers, STARTS for each, `count` in all."""
    generator = np.random.default_rng(SEED)
    rows, states = [], []
    for number in range(count // STARTS):
        mass_ratio, clearance, frequency, restitution = generator.uniform(LEAST, MOST)
        damper = Damper(mass_ratio, clearance, restitution)
        rows += [pack(Oscillator(0.215), damper, frequency)] * STARTS
        states.append(random_states(STARTS, 2.0, damper, [SEED, number]))
    return np.array(rows), np.concatenate(states)


def table(count, rounds):
    """Return starts settled in a second, in two ways of treating undecided motions.

    A motion is undecided if its kind is not certain at the end of a normal run. Such motions are
    left unresolved ("left"), or run longer until their kind is found ("named").
    """
    rows, states = draw(count)
    kinds = {"left": replace(Settling(), further=0), "named": Settling()}
    calls = {
        name: partial(ensemble.settle, rows, states, settling) for name, settling in kinds.items()
    }
    found = {name: call() for name, call in calls.items()}
    lines = []
    for name, seconds in interleaved(calls, rounds).items():
        shares = {
            outcome: np.mean(found[name]["outcome"] == OUTCOME[outcome])
            for outcome in ("settled", "chaotic", "quasi_periodic", "drifting", "unresolved")
        }
        row = {"undecided motions": name, "starts": len(rows)}
        lines.append(row | spread("starts_a_second", len(rows) / seconds) | shares)
    return pd.DataFrame(lines)
