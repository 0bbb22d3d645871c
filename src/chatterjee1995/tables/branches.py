"""Tables of branches of periodic orbits, and of bifurcations at stable orbits."""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as reading
from chatterjee1995.tables.files import DAMPER, parameter_columns
from impact_damper.data.datasets import flag
from impact_damper.data.sweeps import runs_of_true

# Reason why a branch is not followed to its end -> words for it in the table.
LEFT = {
    "unstable": "left among unstable orbits, since it winds through chaos there",
    "point limit": "left after the largest number of orbits, since it winds through chaos",
    "lost": "left because Newton's method finds no further orbit",
}


def orbits(datasets) -> pd.DataFrame:
    """Return a table of branches of periodic orbits: period, range of W, stability and ends."""
    rows = []
    for name, data in _branches(datasets):
        for branch in range(data.sizes["branch"]):
            part = data.isel(point=np.flatnonzero(data["orbit_branch"].values == branch))
            value = part["followed_value"].values
            stable = part["orbit_stability"].values == flag("orbit_stability", "stable")
            ends = _ends_of(data, branch)
            rows.append(
                {
                    "curve": name,
                    "branch": branch + 1,
                    "period [cycles]": int(data["branch_period"][branch]),
                    "from Ω": value.min(),
                    "to Ω": value.max(),
                    "stable Ω": _stable_ranges(value, stable, closed="closed" in ends),
                    "largest displacement max |Z1|": float(part["orbit_displacement"].max()),
                    "one end": ends[0],
                    "other end": ends[1],
                    "orbits": len(value),
                    "events": int((data["event_branch"].values == branch).sum()),
                    "not located": int(data["branch_events_lost"][branch]),
                    "largest residual, absolute": float(part["orbit_residual"].max()),
                    "largest error of Liouville's determinant": float(
                        part["liouville_error"].max()
                    ),
                }
                | parameter_columns(data, "damping", *DAMPER)
            )
    return pd.DataFrame(rows)


def _branches(datasets):
    return [*reading.free(datasets, "branches").items()] + [
        *reading.damped(datasets, "branches").items()
    ]


def _ends_of(data, branch):
    ends, met = data["branch_end"][branch], data["branch_met"].values[branch]
    names = [LEFT.get(name, name) for name in map(reading.meaning, ends)]
    return [
        name if other < 0 else f"{name} of branch {other + 1}"
        for name, other in zip(names, met, strict=True)
    ]


def _stable_ranges(value, stable, *, closed):
    if closed:  # begin a closed branch at an unstable orbit, so that no stable range is divided
        cut = np.argmin(stable)
        value, stable = np.roll(value, -cut), np.roll(stable, -cut)
    parts = [value[first:last] for first, last in runs_of_true(stable)]
    parts = sorted((part.min(), part.max()) for part in parts)
    return ", ".join(f"{lower:.5g} to {upper:.5g}" for lower, upper in parts)


def bifurcations(datasets) -> pd.DataFrame:
    """Return a table of bifurcations, and of orbits at which contacts appear, vanish or merge.

    An event is listed if the orbit there, or a neighbouring orbit of the branch, is stable.
    """
    rows = []
    for name, data in _branches(datasets):
        for k in np.flatnonzero(_next_to_stable(data)):
            event = data.isel(event=k)
            branch = int(event["event_branch"])
            kind = reading.meaning(event["event_kind"])
            rows.append(
                {
                    "curve": name,
                    "branch": branch + 1,
                    "period [cycles]": int(data["branch_period"][branch]),
                    "forcing frequency Ω": f"{float(event['event_value']):.10f}",
                    "event": kind.replace("neimark sacker", "Neimark-Sacker"),
                    "displacement max |Z1|": float(event["event_displacement"]),
                    "order of the walls touched, before it": str(event["walls_before"].values),
                    "order of the walls touched, after it": str(event["walls_after"].values),
                    "least speed of contact": float(event["event_speed"]),
                }
            )
    frame = pd.DataFrame(rows)
    keys = ["curve", "branch", "forcing frequency Ω"]
    return frame.sort_values(keys, kind="stable") if rows else frame


def _next_to_stable(data):
    found = np.zeros(data.sizes["event"], bool)
    for branch in range(data.sizes["branch"]):
        points = np.flatnonzero(data["orbit_branch"].values == branch)
        stable = data["orbit_stability"].values[points] == flag("orbit_stability", "stable")
        ahead, behind = np.append(stable[1:], False), np.append(False, stable[:-1])
        at = data["followed_value"].values[points][ahead | behind | stable]
        events = np.flatnonzero(data["event_branch"].values == branch)
        found[events] = np.isin(data["event_value"].values[events], at)
    return found
