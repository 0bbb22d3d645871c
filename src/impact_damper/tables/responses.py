"""Tables of frequency responses: suppression bands, subharmonics, branches and bifurcations.

A curve is a frequency response of the configuration; a branch is a sequence of periodic orbits
along the forcing frequency W. Free means without the damper. The suppression band is the range of
frequencies in which the damper works. A high or violent motion is at least half as large as the
free resonance.
"""

import numpy as np
import pandas as pd

from impact_damper.claims import exact_orbits, extract
from impact_damper.claims.claim import Missing
from impact_damper.claims.suppression import chaotic_high, high_motions, suppression_band
from impact_damper.data.datasets import flag
from impact_damper.tables.columns import parameter_columns, runs_of_true

DAMPER = ("mass_ratio", "clearance", "restitution")


# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "bands": {
        "curve": "curve",
        "h": "damping h",
        "rm": "mass ratio rm",
        "d0": "clearance d0",
        "e": "restitution e",
        "lower edge, balance": "lower edge Ω by harmonic balance",
        "upper edge, balance": "upper edge Ω by harmonic balance",
        "lower edge, motions": "lower edge Ω by the motions found",
        "upper edge, motions": "upper edge Ω by the motions found",
    },
    "subharmonic": {
        "data": "curve",
        "damper": "damper",
        "h": "damping h",
        "rm": "mass ratio rm",
        "d0": "clearance d0",
        "branch": "branch",
        "from W": "stable from Ω",
        "to W": "stable to Ω",
        "largest max |Z1|": "largest displacement max |Z1|",
    },
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
        "least speed of contact": "least speed at which a contact begins",
    },
}
# Column -> function that turns the text of a cell of the CSV file into the text shown in Markdown.
# In columns without a function, underscores become spaces.
CELLS = {"event": lambda cell: cell.replace("neimark sacker", "Neimark-Sacker")}


def bands(datasets) -> pd.DataFrame:
    """Return the suppression band of each curve by harmonic balance and by the motions found."""
    designs = extract.damped(datasets, "harmonic_balance")
    responses = extract.damped(datasets, "response")
    rows = []
    for name in dict.fromkeys([*designs, *responses]):
        row = {"curve": name} | parameter_columns(
            designs.get(name, responses.get(name)), "damping", "linear_frequency", *DAMPER
        )
        if name in designs:
            row |= _balance_band(designs[name])
        if name in responses:
            row |= _existing_band(datasets, name)
        rows.append(row)
    return pd.DataFrame(rows)


def _balance_band(data):
    """Return columns on the suppression band by harmonic balance."""
    lower, upper = data.edge_frequency.values
    lower_event, upper_event = (
        extract.meaning("edge_event", value) for value in data.edge_event.values
    )
    return {
        "lower edge, balance": float(lower),
        "event at lower edge": lower_event,
        "upper edge, balance": float(upper),
        "event at upper edge": upper_event,
        "width, balance": float(data.band_width),
        "least reduction in band": float(data.edge_reduction.min()),
        "no reduction above W": float(data.break_even_frequency),
    }


def _existing_band(datasets, name):
    """Return columns on the band by the motions found, and on chaotic violent motions."""
    response = datasets["response"][name]
    try:
        free = exact_orbits.free_of(datasets, response)
        band = suppression_band(datasets, name)
    except Missing:
        return {}
    frequency, step = response.frequency.values, extract.spacing(response)
    motions = extract.touching(response).sum("motion")
    inside = frequency[(frequency > band.lower + band.resolution) & (frequency <= band.upper)]
    chaotic = chaotic_high(response, free).values
    high = high_motions(response, free) & extract.is_outcome(response, "chaotic")
    share = (
        response.motion_starts.where(high, 0).sum("motion").values[chaotic]
        / response.sizes["start"]
    )
    return {
        "lower edge, motions": band.lower,
        "lower edge at most": band.lower + band.resolution,
        "upper edge, motions": band.upper,
        "width, motions": band.width,
        "share of band with one motion": float((motions.sel(frequency=inside) == 1).mean())
        if len(inside)
        else np.nan,
        "high chaos from W": frequency[chaotic].min() if chaotic.any() else np.nan,
        "high chaos to W": frequency[chaotic].max() if chaotic.any() else np.nan,
        "width of high chaos": chaotic.sum() * step,
        "widest range of high chaos": extract.longest_run(chaotic) * step,
        "share of starts in high chaos": np.mean(share) if chaotic.any() else np.nan,
    }


def subharmonic(datasets) -> pd.DataFrame:
    """Return the one-third subharmonic without damper, and its stable branches with damper."""
    rows = [
        {"data": name, "damper": "off"}
        | parameter_columns(free, "damping", "linear_frequency")
        | _free_subharmonic(free)
        for name, free in extract.free(datasets, "branches").items()
    ]
    for name, curve in datasets.get("subharmonic", {}).items():
        head = {"data": name, "damper": "on"} | parameter_columns(
            curve, "damping", "linear_frequency", "mass_ratio", "clearance"
        )
        existing = curve.where(curve.free_subharmonic.notnull())
        led = existing.switched_share.sel(switched_motion="subharmonic")
        rows.append(
            head
            | {
                "branch": "all",
                "largest max |Z1|": float(existing.damped_subharmonic.max()),
                "largest ratio to free max |Z1|": float(existing.subharmonic_ratio.max()),
                "share of starts on the free one that lead to it": float(led.mean()),
            }
        )
        if name in datasets.get("branches", {}):
            part = exact_orbits.stable_subharmonics(datasets["branches"][name])
            rows += [head | _stable_part(branch) for _, branch in part.groupby("branch")]
    return pd.DataFrame(rows)


def _stable_part(part):
    """Return number, period, range of W and size of the stable part of a branch."""
    return {
        "branch": f"{part.branch.iloc[0] + 1}",
        "period": part.period.iloc[0],
        "from W": part.lower.min(),
        "to W": part.upper.max(),
        "largest max |Z1|": part["size"].max(),
    }


def _free_subharmonic(free):
    """Return columns on the free one-third subharmonic; without one, {"branch": "none"}."""
    try:
        part = exact_orbits.subharmonic(free)
    except Missing:
        return {"branch": "none"}
    return _stable_part(part[part.stable])


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
                    "max |Z1|": float(data["event_displacement"][k]),
                    "walls before": str(data["walls_before"].values[k]),
                    "walls after": str(data["walls_after"].values[k]),
                    "least speed of contact": float(data["event_speed"][k]),
                }
            )
    frame = pd.DataFrame(rows)
    return frame.sort_values(["data", "branch", "W"], kind="stable") if rows else frame
