"""How often starts in a ball of states lead to a collision (section 3, iii)."""

import math

import numpy as np

from impact_damper.data.datasets import dataset
from impact_damper.data.variables import register
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import side_of, step, workspace
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.motions.simulate import random_states

register(
    """
ball | ball | | | ball of states from which random starts are drawn
beyond_wall | ball | | | share of starts that lie beyond a wall
colliding | ball | | | share of starts that lead to a collision
longest_wait | ball | | | longest time to the first collision, cycles
    """
)


def collisions(
    oscillator, damper, frequency, *, starts=2000, radius, seed=1995, periods=2000, tolerance=1e-9
):
    """Return a dataset: shares of starts that lead to a collision within `periods` cycles.

    There are `starts` starts in a ball of states, and `starts` more in its part between the walls.
    """
    p = pack(oscillator, damper, frequency)
    shares = np.empty((2, 3))
    for row, within_gap in enumerate((False, True)):
        states = random_states(starts, radius, damper, [seed, row], within_gap=within_gap)
        waits = np.array([first_collision(p, state, periods, tolerance) for state in states])
        met = np.isfinite(waits)
        shares[row] = np.mean(waits == 0), np.mean(met), np.max(waits[met], initial=0.0)
    data = dict(zip(("beyond_wall", "colliding", "longest_wait"), shares.T, strict=True))
    made = describe(oscillator, damper) | {"frequency": float(frequency), "starts": starts}
    made |= {"radius": radius, "seed": seed, "periods": periods}
    return dataset(data, {"ball": ["literal", "within_gap"]}, made, "First collisions")


@kernel
def first_collision(p, state, limit, tolerance):
    """Return the cycles until the first contact, or infinity if `limit` cycles have none."""
    work, y, t, side = workspace(), state.copy(), 0.0, side_of(p, state)
    end = limit * 2.0 * math.pi / p[FREQUENCY]
    while side == 0 and t < end:
        length, side = step(p, y, side, t, end - t, tolerance, work)
        t += length
    return t * p[FREQUENCY] / (2.0 * math.pi) if side != 0 else np.inf
