"""Orbits that many tests use."""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.motions import strobe_map
from impact_damper.system.packed import pack
from impact_damper.system.parameters import Damper, Oscillator

PAPER = Oscillator(0.215)
DESIGN = Damper(0.12, 2.0)
INELASTIC = Damper(0.25, 1.0, restitution=0.75)

# A state close to each orbit at W T = pi/2, which is in mid-flight on all of them.
STARTS = {
    "resonance": (None, 2.0, (2.35, -0.78, 2.35, -0.78)),
    "non-resonance": (None, 2.0, (0.027, 0.5, 0.027, 0.5)),
    "design": (DESIGN, 2.0, (0.006, 0.187, 0.002, -2.408)),
    "inelastic": (INELASTIC, 2.0, (0.082, 0.169, 0.381, -1.088)),
    "large": (DESIGN, 1.7, (1.8787, -2.4769, 0.0245, -0.4529)),
}
IMPACTING = ["design", "inelastic", "large"]


class Scene(NamedTuple):
    """An orbit of period 1: packed parameters, its state at W T = pi/2, and what it is of."""

    parameters: np.ndarray
    state: np.ndarray
    damper: Damper | None
    frequency: float

    @property
    def period(self):
        return 2 * math.pi / self.frequency

    @property
    def strobe(self):
        return 0.5 * math.pi / self.frequency


def scene_of(name):
    damper, frequency, start = STARTS[name]
    p, state = pack(PAPER, damper, frequency), np.array(start)
    found, _, _ = strobe_map.polish(p, state, 1, 0.1, 1e-13)
    assert found
    return Scene(p, state, damper, frequency)
