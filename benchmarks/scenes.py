"""Motions on which methods are timed: the scenes of the configuration, with exact states."""

import math
from typing import NamedTuple

import numpy as np
from references import extended
from references.extended.scenes import configured_scenes, packed

from impact_damper.system.packed import CLEARANCE, FREQUENCY

# Starts differ from the scene's state by at most this in each component.
SPREAD = 1e-3
# Smaller where motions from such starts leave the orbit for a chaotic one, next to grazing.
SPREADS = {"grazing": 1e-8}


class BenchmarkScene(NamedTuple):
    """Motions from states close to each other, all in flight at the beginning.

    Attributes
    ----------
    name : str
    parameters : numpy.ndarray, shape (packed.COUNT,)
        As of `parameters.pack`.
    begin, end : float
        Times, W T = pi/2 at the beginning.
    periods : int
    starts, exact : numpy.ndarray, shape (m, 4)
        States at the beginning and, by 80-bit arithmetic, at the end; the first start is that of
        the configuration.
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
    rows = np.tile(p, (count, 1))
    exact = extended.run_many(rows, starts, np.full(count, begin), np.full((count, 1), end))
    return BenchmarkScene(name, p, begin, end, periods, starts, exact.states.astype(float))


def from_configuration(count):
    """Return all scenes of the configuration but chaotic ones, with `count` starts each."""
    return [
        make(name, packed(parameters), state, periods, count)
        for name, parameters, state, periods in configured_scenes()
    ]
