"""Find stable periodic orbits by Newton's method from random states.

Newton's method also finds orbits to which hardly any motion from a random state leads, because
their basins are small. Simulations would miss the branches of such orbits.
"""

import numpy as np

from impact_damper.motions.simulate import random_states
from impact_damper.orbits.shooting import find_orbit

# FREQUENCIES: number of frequencies, spread evenly over the range.
# STATES: number of random states at each frequency.
# PERIODS: periods of the orbits, in forcing cycles.
FREQUENCIES, STATES, PERIODS = 20, 6, (1, 2, 3)
# Radius of the ball from which states are drawn, as in the paper, and seed of the draws.
RADIUS, SEED = 2.0, 4
# Number of searches.
COUNT = FREQUENCIES * STATES * len(PERIODS)


def stable_orbits(family, damper, span):
    """Yield the frequency and the orbit of each of the COUNT searches that finds a stable orbit.

    With a damper, orbits without contacts are omitted.

    Parameters
    ----------
    family : callable
        Maps the frequency to packed parameters.
    damper : Damper or None
    span : tuple of float
        Least and greatest frequency.
    """
    for number, value in enumerate(np.linspace(*span, FREQUENCIES + 2)[1:-1]):
        p = family(float(value))
        for state in random_states(STATES, RADIUS, damper, [SEED, number]):
            for period in PERIODS:
                orbit = find_orbit(p, state, period)
                touches = damper is None or orbit.touching > 0
                if orbit.converged and touches and orbit.stable and not orbit.repeats_sooner():
                    yield float(value), orbit
