"""States labelled a second by one thread, in the plane of the free oscillator at W = 1.85."""

import numpy as np
import pandas as pd

from benchmarks.timing import interleaved, spread
from impact_damper.attraction.labels import label_states
from impact_damper.stages.basins import free_attractors
from impact_damper.system.packed import pack
from impact_damper.system.parameters import Oscillator
from impact_damper.system.settling import Settling

# Half widths of the plane in Z1 and Z1'.
PLANE = np.array([3.2, 5.0])


def table(count, rounds):
    """Return states labelled a second, for about `count` states on a grid."""
    p, settling = pack(Oscillator(0.215), None, 1.85), Settling()
    attractors = free_attractors(p, PLANE, settling)
    axes = [np.linspace(-half, half, round(count**0.5)) for half in PLANE]
    states = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    limits = settling.tolerance, settling.limit

    def label():
        return label_states(p, states, np.pi / 2, attractors, *limits)

    _, periods = label()
    median, lower, upper = spread(len(states) / interleaved({"basin": label}, rounds)["basin"])
    return pd.DataFrame(
        [
            {"states": len(states), "states_a_second": median, "lower_quartile": lower}
            | {"upper_quartile": upper, "mean_periods": np.mean(periods)}
        ]
    )
