"""Tables of branches of periodic orbits and of their bifurcations."""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as extract
from chatterjee1995.tables.columns import parameter_columns
from impact_damper.data.datasets import flag
from impact_damper.data.sweeps import runs_of_true

DAMPER = ("mass_ratio", "clearance", "restitution")
# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "orbits": {
        "data": "curve",
        "branch": "branch",
        "period": "period [cycles]",
        "from W": "from Ω",
        "to W": "to Ω",
        "stable W": "stable Ω",
        "largest max |Z1|": "largest displacement max |Z1|",
        "one end": "one end",
        "other end": "other end",
    },
    "bifurcations": {
        "data": "curve",
        "branch": "branch",
        "period": "period [cycles]",
        "W": "forcing frequency Ω",
        "event": "event",
        "max |Z1|": "displacement max |Z1|",
        "walls before": "order of the walls touched, before it",
        "walls after": "order of the walls touched, after it",
    },
}
# Table -> column and value of the rows in the Markdown table; the CSV file has all rows.
ROWS = {"bifurcations": ("next to stable orbits", "yes")}
# Column -> function that turns the text of a cell of the CSV file into the text shown in Markdown.
# In columns without a function, underscores become spaces.
CELLS = {"event": lambda cell: cell.replace("neimark sacker", "Neimark-Sacker")}
# End at which a branch is left although its orbits go on -> words with the reason.
LEFT = {
    "unstable": "left among unstable orbits, since it winds through chaos there",
    "point limit": "left after the largest number of orbits, since it winds through chaos",
    "lost": "left because Newton's method finds no further orbit",
}


def orbits(datasets) -> pd.DataFrame:
    """Return branches of periodic orbits: period, range of W, stable parts, ends and errors."""
    rows = []
    for name, parameters, data in _branches(datasets):
        for branch in range(data.sizes["branch"]):
            part = data.isel(point=np.flatnonzero(data["orbit_branch"].values == branch))
            value = part["followed_value"].values
            stable = part["orbit_stability"].values == flag("orbit_stability", "stable")
            grazing = part["orbit_status"].values == flag("orbit_status", "near_grazing")
            ends = _ends_of(data, branch)
            rows.append(
                {"data": name}
                | parameters
                | {
                    "branch": branch + 1,
                    "period": int(data["branch_period"][branch]),
                    "orbits": len(value),
                    "near grazing": int(grazing.sum()),
                    "from W": value.min(),
                    "to W": value.max(),
                    "stable W": _stable_ranges(value, stable, closed="closed" in ends),
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


def _ends_of(data, branch):
    """Return why a branch ends, at both ends, with the number of the branch that it meets there."""
    ends, met = (data[name].values[branch] for name in ("branch_end", "branch_met"))
    names = [extract.meaning("branch_end", end) for end in ends]
    names = [LEFT.get(name, name) for name in names]
    return [
        name if other < 0 else f"{name} of branch {other + 1}"
        for name, other in zip(names, met, strict=True)
    ]


def _branches(datasets):
    """Yield name, parameter columns and dataset of branches, those without a damper first."""
    free, damped = (choose(datasets, "branches") for choose in (extract.free, extract.damped))
    for name, data in (free | damped).items():
        yield name, parameter_columns(data, "damping", *DAMPER), data


def _stable_ranges(value, stable, *, closed):
    """Return the ranges of W of the stable parts of a branch, as text, in order of W.

    A closed branch is cut open at an unstable orbit, so that the cut divides no stable part.
    """
    if closed:
        cut = np.argmin(stable)
        value, stable = np.roll(value, -cut), np.roll(stable, -cut)
    parts = [value[first:last] for first, last in runs_of_true(stable)]
    parts = sorted((part.min(), part.max()) for part in parts)
    return ", ".join(f"{lower:.5g} to {upper:.5g}" for lower, upper in parts)


def bifurcations(datasets) -> pd.DataFrame:
    """Return located bifurcations and changes of the contacts, sorted by branch and frequency."""
    rows = []
    for name, parameters, data in _branches(datasets):
        stable = _next_to_stable(data)
        for k in range(data.sizes["event"]):
            branch = int(data["event_branch"][k])
            rows.append(
                {"data": name}
                | parameters
                | {
                    "branch": branch + 1,
                    "period": int(data["branch_period"][branch]),
                    "W": f"{float(data['event_value'][k]):.10f}",
                    "event": extract.meaning("event_kind", data["event_kind"].values[k]),
                    "next to stable orbits": "yes" if stable[k] else "no",
                    "max |Z1|": float(data["event_displacement"][k]),
                    "walls before": str(data["walls_before"].values[k]),
                    "walls after": str(data["walls_after"].values[k]),
                    "least speed of contact": float(data["event_speed"][k]),
                }
            )
    frame = pd.DataFrame(rows)
    return frame.sort_values(["data", "branch", "W"], kind="stable") if rows else frame


def _next_to_stable(data):
    """Return for each event whether an orbit before or after it on the branch is stable."""
    found = np.zeros(data.sizes["event"], bool)
    for branch in range(data.sizes["branch"]):
        points = np.flatnonzero(data["orbit_branch"].values == branch)
        stable = data["orbit_stability"].values[points] == flag("orbit_stability", "stable")
        ahead, behind = np.append(stable[1:], False), np.append(False, stable[:-1])
        at = data["followed_value"].values[points][ahead | behind | stable]
        events = np.flatnonzero(data["event_branch"].values == branch)
        found[events] = np.isin(data["event_value"].values[events], at)
    return found
