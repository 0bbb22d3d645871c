"""Tables of the exact orbits: every branch with its ends, and every bifurcation on it."""

import numpy as np
import pandas as pd

from impact_damper.claims.extract import meaning
from impact_damper.data.datasets import flag, parameters_of

SYMBOLS = {"damping": "h", "mass_ratio": "rm", "clearance": "d0", "restitution": "e"}


def _all(datasets):
    """Name, parameters by symbol, and dataset of all branches, those of free oscillators first."""
    for stage in ("free_branches", "branches"):
        for name, data in datasets.get(stage, {}).items():
            given = parameters_of(data)
            yield name, {SYMBOLS[key]: given[key] for key in SYMBOLS if key in given}, data


def orbits(datasets) -> pd.DataFrame:
    """Branches of periodic orbits: period, range, where stable, ends, and how exact they are."""
    rows = []
    for name, given, data in _all(datasets):
        for branch in range(data.sizes["branch"]):
            part = data.isel(point=np.flatnonzero(data["orbit_branch"].values == branch))
            value = part["followed_value"].values
            stable = part["orbit_stability"].values == flag("orbit_stability", "stable")
            ends = [meaning("branch_end", end) for end in data["branch_end"].values[branch]]
            rows.append(
                {"data": name}
                | given
                | {
                    "branch": branch + 1,
                    "period": int(data["branch_period"][branch]),
                    "orbits": len(value),
                    "near grazing": int(
                        (part["orbit_status"].values == flag("orbit_status", "near_grazing")).sum()
                    ),
                    "from W": value.min(),
                    "to W": value.max(),
                    "stable W": _ranges(value, stable),
                    "largest max |Z1|": float(part["orbit_displacement"].max()),
                    "one end": ends[0],
                    "other end": ends[1],
                    "events": int((data["event_branch"].values == branch).sum()),
                    "not located": int(data["branch_events_lost"][branch]),
                    "largest residual, absolute": float(part["orbit_residual"].max()),
                    "largest error of Liouville's determinant": float(
                        part["liouville_error"].max()
                    ),
                }
            )
    return pd.DataFrame(rows)


def _ranges(value, stable):
    """Parts of a branch where it is stable, in words, each by its least and greatest value."""
    edges = np.flatnonzero(np.diff(stable.astype(int), prepend=0, append=0)).reshape(-1, 2)
    parts = [value[first:last] for first, last in edges]
    return ", ".join(f"{part.min():.5g} to {part.max():.5g}" for part in parts)


def bifurcations(datasets) -> pd.DataFrame:
    """Located bifurcations and changes of contact, by branch and forcing frequency."""
    rows = []
    for name, given, data in _all(datasets):
        for k in range(data.sizes["event"]):
            branch = int(data["event_branch"][k])
            rows.append(
                {"data": name}
                | given
                | {
                    "branch": branch + 1,
                    "period": int(data["branch_period"][branch]),
                    "W": f"{float(data['event_value'][k]):.10f}",
                    "event": meaning("event_kind", data["event_kind"].values[k]),
                    "max |Z1|": float(data["event_displacement"][k]),
                    "walls before": str(data["walls_before"].values[k]),
                    "walls after": str(data["walls_after"].values[k]),
                    "least speed of contact": float(data["event_speed"][k]),
                }
            )
    frame = pd.DataFrame(rows)
    return frame.sort_values(["data", "branch", "W"], kind="stable") if rows else frame
