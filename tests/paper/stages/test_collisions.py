"""Shares of random starts that collide, against the volume of the ball and simulated contacts."""

import math

import numpy as np
from helpers.known_orbits import PAPER
from helpers.sampling import sample
from scipy import stats

from chatterjee1995.stages.collisions import collisions
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper
from impact_damper.motions.simulate import random_states


def test_collisions():
    """The share beyond a wall follows from the volume of the ball, the waits from simulations."""
    damper, starts = Damper(0.25, 1.0), 1500
    data = collisions(PAPER, damper, 1.8, starts=starts, radius=2.0, periods=60)
    literal, within = data.isel(ball=0), data.isel(ball=1)
    expected = 2 * stats.beta(2.5, 2.5).cdf((1 - damper.clearance / 2) / 2)
    error = math.sqrt(expected * (1 - expected) / starts)
    assert abs(literal.beyond_wall - expected) < 4 * error
    assert within.beyond_wall == 0
    assert literal.colliding >= literal.beyond_wall
    p, waits = pack(PAPER, damper, 1.8), []
    for state in random_states(starts, 2.0, damper, [1995, 1])[:100]:
        _, log = sample(p, state, 0.0, [60 * 2 * math.pi / 1.8], 1e-9)
        waits.append(log[0, 1] * 1.8 / (2 * math.pi) if len(log) else math.inf)
    finite = np.array(waits)[np.isfinite(waits)]
    assert np.max(finite) <= within.longest_wait + 1e-9
    assert abs(within.colliding - len(finite) / 100) < 0.15
