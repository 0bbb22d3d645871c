"""Table of machines in SI units; the gap is the full play of the loose mass."""

import json

import numpy as np
import pandas as pd

from impact_damper.data.datasets import flag


def machines(datasets) -> pd.DataFrame:
    """For each machine: largest motions without and with damper, best gap at one frequency."""
    rows = []
    for name, data in datasets.get("machines", {}).items():
        made = json.loads(data.attrs["machine"])
        bare, sizes = data["bare_displacement"].values, data["maximum_displacement"].values
        # motions that escape have no size
        size = np.where(np.isfinite(sizes), sizes, 0).max(axis=1)
        escaped = data["run_outcome"].values == flag("run_outcome", "escaped")
        peak, place = int(np.argmax(bare)), int(np.argmax(size))
        share, largest = _near_optimum(data)
        rows.append(
            {
                "machine": name,
                "mass of the loose mass, kg": made["damper_mass"],
                "gap (full play), mm": 1e3 * made["gap"],
                "largest without damper, mm": bare[peak],
                "at, Hz": data["bare_frequency"].values[peak],
                "largest with damper, mm": size[place],
                "at, Hz (with damper)": data["frequency"].values[place],
                "share of starts that escape": escaped.mean(),
                "gap varied at, Hz": float(data["swept_frequency"]),
                "best gap (full play)": data.attrs["optimum"],
                "starts that end quiet near it": share,
                "largest near it, mm": largest,
            }
        )
    return pd.DataFrame(rows)


def _near_optimum(data):
    """Return the share of starts that reach the quiet motion, and the largest size of all motions.

    Both are taken at the gap of the sweep nearest to the best gap. Words stand in their place if
    there is no best gap, and in place of the size if a motion escapes.
    """
    best = float(data["optimum_gap"])
    if np.isnan(best):
        return "no quiet motion", "no quiet motion"
    near = int(np.argmin(np.abs(data["gap"].values - best)))
    largest = data["largest_displacement"].values[near]
    return data["quiet_share"].values[near], "escapes" if np.isinf(largest) else largest
