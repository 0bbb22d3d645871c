"""Tables of frequency responses: suppression bands and subharmonics.

A curve is a frequency response of the configuration; a branch is a sequence of periodic orbits
along the forcing frequency W. Free means without the damper. The suppression band is the range of
frequencies in which the damper works. A high or violent motion is at least half as large as the
free resonance.
"""

import numpy as np
import pandas as pd

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.claim import Missing
from chatterjee1995.claims.suppression import chaotic_high, high_motions, suppression_band
from chatterjee1995.tables.columns import parameter_columns

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
}


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
