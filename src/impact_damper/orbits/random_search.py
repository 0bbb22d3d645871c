"""Stable orbits by Newton's method from random states, for branches without a settled motion.

Newton's method finds orbits of small basins, to which hardly a random start settles.
"""

import numpy as np

from impact_damper.motions.simulate import random_states
from impact_damper.orbits.shooting import find_orbit

# Frequencies, spread evenly over the range, random states at each of them, and periods looked for.
FREQUENCIES, STATES, PERIODS = 20, 6, (1, 2, 3)
# Radius of the ball from which states are drawn, as in the paper, and seed.
RADIUS, SEED = 2.0, 4
COUNT = FREQUENCIES * STATES * len(PERIODS)


def stable_orbits(family, damper, span):
    """Yield the frequency and the orbit of every search, of COUNT, that ends at a stable orbit.

    Motions that touch no wall are left out if there is a damper.

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
