"""Tables of frequency responses: suppression bands and subharmonics.

A curve is a frequency response of the configuration; a branch is a sequence of periodic orbits
along the forcing frequency W. Free means without the damper. The suppression band is the range of
frequencies in which the damper works. A high or violent motion is at least half as large as the
free resonance.
"""

import pandas as pd

from chatterjee1995.reading import datasets as extract
from chatterjee1995.reading import orbits as exact_orbits
from chatterjee1995.reading.datasets import Missing
from chatterjee1995.tables.columns import parameter_columns

DAMPER = ("mass_ratio", "clearance", "restitution")


# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
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
