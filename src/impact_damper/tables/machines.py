"""Table of machines in SI units."""

import json

import numpy as np
import pandas as pd

from impact_damper.data.datasets import flag


def machines(datasets) -> pd.DataFrame:
    """What a damper does to each machine: over the frequency, and over the gap at one frequency."""
    rows = []
    for name, data in datasets.get("machines", {}).items():
        made = json.loads(data.attrs["machine"])
        bare, orbits = data["bare_displacement"].values, data["frequency"].values
        size = data["maximum_displacement"].max("motion").values
        escaped = data["run_outcome"].values == flag("run_outcome", "escaped")
        peak, place = int(np.argmax(bare)), int(np.nanargmax(np.where(np.isfinite(size), size, 0)))
        gaps = data["gap"].values
        near = int(np.argmin(np.abs(gaps - float(data["optimum_gap"]))))
        known = np.isfinite(float(data["optimum_gap"]))
        rows.append(
            {
                "machine": name,
                "mass of the loose mass, kg": made["damper_mass"],
                "gap (full play), mm": 1e3 * made["gap"],
                "largest without damper, mm": bare[peak],
                "at, Hz": data["bare_frequency"].values[peak],
                "largest with damper, mm": size[place],
                "at, Hz (with damper)": orbits[place],
                "share of starts that escape": escaped.mean(),
                "gap varied at, Hz": float(data["swept_frequency"]),
                "best gap (full play)": data.attrs["optimum"],
                "starts that end quiet near it": data["quiet_share"].values[near] if known else 0,
                "largest near it, mm": data["largest_displacement"].values[near]
                if known
                else np.nan,
            }
        )
    return pd.DataFrame(rows)
