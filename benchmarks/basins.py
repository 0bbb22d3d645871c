"""States at W = 1.85 that are labelled, and looked up, in a second, without damper and with it.

Free means without damper, and a release is the switching off of the damper. To label a state is to
find the motion to which it leads. A release set is a precomputed table of the states from which the
free motion settles on the small motion.
"""

from functools import partial

import numpy as np
import pandas as pd

from benchmarks.timing import interleaved, spread
from impact_damper.kernel.compiling import kernel
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.attractors import free_attractors, label_damped, release_set
from impact_damper.motions.ensemble import label_states
from impact_damper.motions.legs import depth_of

# Half widths of the plane in Z1 and Z1'.
PLANE = np.array([3.2, 5.0])
# Cells on each axis of the coarse grid of the release set, as in the configuration.
CELLS = 64
# Restitutions of the damper, and the frequency, of the states that are labelled with a damper.
RESTITUTIONS, DAMPED = (1.0, 0.75), 1.95


@kernel
def look_up(depth, half, states):
    """Return the number of states inside a release set; state i is looked up at phase i mod n."""
    inside = 0
    for i in range(len(states)):
        inside += depth_of(depth, half, i % len(depth), states[i, 0], states[i, 1]) > 0
    return inside


def table(count, rounds):
    """Return states labelled and looked up in a second, for about `count` states on a grid.

    With the damper a tenth of the states is labelled, the loose mass at rest in mid-gap.
    """
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
    few = np.hstack([mixed[: len(states) // 10], np.zeros((len(states) // 10, 2))])
    calls, means = {"labelled": label, "looked up": look}, {"labelled": np.mean(periods)}
    for restitution in RESTITUTIONS:
        row = pack(Oscillator(0.215), Damper(0.25, 1.0, restitution), DAMPED)
        given = row, few, np.pi / 2, settling
        name = f"labelled, with damper, e = {restitution}"
        calls[name] = partial(label_damped, *given)
        means[name] = np.mean(label_damped(*given)[1])
    seconds = interleaved(calls, rounds)
    numbers = {name: len(few) if "damper" in name else len(states) for name in calls}
    return pd.DataFrame([
        {"states": name, "number": numbers[name], "mean_periods": means.get(name, np.nan)}
        | spread("states_a_second", numbers[name] / seconds[name])
        for name in calls
    ])  # fmt: skip
