"""Systems and periodic orbits that tests in several rooms use."""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions import strobe_map

PAPER = Oscillator(0.215)
DESIGN = Damper(0.12, 2.0)
INELASTIC = Damper(0.25, 1.0, restitution=0.75)

# Orbit -> damper, frequency, and a state near the orbit at W T = pi/2. In these states the loose
# mass touches no wall.
STARTS = {
    "resonance": (None, 2.0, (2.35, -0.78, 2.35, -0.78)),
    "non-resonance": (None, 2.0, (0.027, 0.5, 0.027, 0.5)),
    "design": (DESIGN, 2.0, (0.006, 0.187, 0.002, -2.408)),
    "inelastic": (INELASTIC, 2.0, (0.082, 0.169, 0.381, -1.088)),
    "large": (DESIGN, 1.7, (1.8787, -2.4769, 0.0245, -0.4529)),
}
IMPACTING = ["design", "inelastic", "large"]


class KnownOrbit(NamedTuple):
    """An orbit of period 1: packed parameters, and its state (4,) at the strobe, W T = pi/2."""

    parameters: np.ndarray
    state: np.ndarray
    damper: Damper | None
    frequency: float

    @property
    def period(self):
        """Length of a forcing cycle."""
        return 2 * math.pi / self.frequency

    @property
    def strobe(self):
        """Time T of the state."""
        return 0.5 * math.pi / self.frequency


def polished_orbit(name):
    """Return the orbit `name` of `STARTS`, with a state accurate to 1e-13."""
    damper, frequency, start = STARTS[name]
    p, state = pack(PAPER, damper, frequency), np.array(start)
    converged, _, _ = strobe_map.polish(p, state, 1, 0.1, 1e-13)
    assert converged
    return KnownOrbit(p, state, damper, frequency)
