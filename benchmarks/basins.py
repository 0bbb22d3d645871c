"""States of the free oscillator at W = 1.85 that are labelled, and looked up, in a second.

Free means without damper, and a release is the switching off of the damper. To label a state is to
find the motion to which it leads. A release set is a precomputed table of the states from which the
free motion settles on the small motion.
"""

import numpy as np
import pandas as pd

from benchmarks.timing import interleaved, spread
from impact_damper.kernel.compiling import kernel
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.attractors import free_attractors, release_set
from impact_damper.motions.ensemble import label_states
from impact_damper.motions.legs import depth_of

# Half widths of the plane in Z1 and Z1'.
PLANE = np.array([3.2, 5.0])
# Cells on each axis of the coarse grid of the release set, as in the configuration.
CELLS = 64


@kernel
def look_up(depth, half, states):
    """Return the number of states inside a release set; state i is looked up at phase i mod n."""
    inside = 0
    for i in range(len(states)):
        inside += depth_of(depth, half, i % len(depth), states[i, 0], states[i, 1]) > 0
    return inside


def table(count, rounds):
    """Return states labelled and looked up in a second, for about `count` states on a grid."""
    p, settling = pack(Oscillator(0.215), None, 1.85), Settling()
    attractors = free_attractors(p, PLANE, settling)
    axes = [np.linspace(-half, half, round(count**0.5)) for half in PLANE]
    states = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    limits = settling.tolerance, settling.limit

    def label():
        return label_states(p, states, np.pi / 2, attractors, *limits)

    _, periods = label()
    releases = release_set(Oscillator(0.215), 1.85, settling, cells=CELLS)
    mixed = np.random.default_rng(1).permutation(states)

    def look():
        look_up(releases.depth, releases.half, mixed)

    look()
    seconds = interleaved({"labelled": label, "looked up": look}, rounds)
    return pd.DataFrame([
        {"states": name, "number": len(states), "mean_periods": mean}
        | spread("states_a_second", len(states) / seconds[name])
        for name, mean in (("labelled", np.mean(periods)), ("looked up", np.nan))
    ])  # fmt: skip
