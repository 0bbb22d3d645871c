"""Motions on which methods are timed: the scenes (test cases) of the configuration.

An exact state is computed in 80-bit arithmetic.
"""

import math
from typing import NamedTuple

import numpy as np
from references import extended
from references.extended.scenes import configured_scenes, packed

from impact_damper.model.packed import CLEARANCE, FREQUENCY

# Starts differ from the scene's state by at most this in each component.
SPREAD = 1e-3
# Smaller differences for the scene next to grazing, an orbit with very short contacts: motions from
# starts farther away would become chaotic.
SPREADS = {"grazing": 1e-8}


class BenchmarkScene(NamedTuple):
    """Motions from states close to each other, all in flight at the beginning.

    `begin` (W T = pi/2) and `end` are times T with `periods` forcing cycles between them. `starts`
    and `exact`, shape (m, 4), are the states at these times. The first start is the state of the
    scene in the configuration.
    """

    name: str
    parameters: np.ndarray
    begin: float
    end: float
    periods: int
    starts: np.ndarray
    exact: np.ndarray

    @property
    def components(self):
        """Number of components of the state: without a damper there is no Z2."""
        return 2 if self.parameters[CLEARANCE] == math.inf else 4

    def error(self, states):
        """Return the largest error of states at the end, from the first len(states) starts."""
        n = self.components
        return float(np.abs(states[:, :n] - self.exact[: len(states), :n]).max())


def make(name, p, state, periods, count, seed=1995):
    """Return a scene with `count` starts."""
    p, state = np.array(p, float), np.array(state, float)
    width = SPREADS.get(name, SPREAD)
    starts = state + width * np.random.default_rng(seed).uniform(-1, 1, (count, 4))
    starts[0] = state
    begin = 0.5 * math.pi / p[FREQUENCY]
    end = begin + periods * 2 * math.pi / p[FREQUENCY]
    if np.any(np.abs(starts[:, 2]) >= p[CLEARANCE]):
        raise ValueError(f"scene {name}: must begin in flight")
    exact = [extended.run(p, each, begin, [end]).states[-1] for each in starts]
    return BenchmarkScene(name, p, begin, end, periods, starts, np.array(exact, float))


def from_configuration(count):
    """Return all scenes of the configuration that are not chaotic, with `count` starts each."""
    return [
        make(name, packed(parameters), state, periods, count)
        for name, parameters, state, periods in configured_scenes()
    ]
