"""Table of the dampers designed for machines in SI units.

The gap is the full play of the loose mass. A design promises a share of starts (initial states)
that lead to a quiet motion, one below a displacement limit, and tests this promise with new starts.
The dataset of a design holds its choices as flags, integers with a meaning each.
"""

import json

import numpy as np
import pandas as pd

from impact_damper.data.datasets import named, parameters_of
from impact_damper.data.sweeps import quiet_gaps

# Advice for each kind of choice that the design makes.
CHOICES = {
    "robust": "build it",
    "needs_tolerance": "build it, with a closer tolerance of the gap",
    "least_worst": "do not build it",
}
# Text for each result of the test with new starts.
PROMISES = {
    "robust_kept": "kept within all tolerances",
    "nominal_kept": "kept at nominal values",
    "none_made": "none made",
    "broken": "BROKEN",
}


def machines(datasets) -> pd.DataFrame:
    """Return for each machine the gap, displacements, the promise, and the best tuned absorber."""
    return pd.DataFrame([_row(name, data) for name, data in datasets.get("machines", {}).items()])


def _row(name, data):
    """Return the row of one machine; a corner combines extremes of all tolerances."""
    made, asked = json.loads(data.attrs["machine"]), parameters_of(data)
    sizes = data["competitor_displacement"].sel(force_share=1.0, detuning=0.0).max("frequency")
    absorbers = sizes.drop_sel(competitor="bare").values
    unseen = data["corner_share"].values[:, 0]
    return {
        "machine": name,
        "loose mass [kg]": made["damper_mass"],
        "band [Hz]": " to ".join(f"{end:g}" for end in asked["band"]),
        "gap, full play [mm]": _gap(data, asked["tolerances"].get("gap", 0.0)),
        "advice": CHOICES[named(data, "design_choice")],
        "largest displacement without damper [mm]": float(data["balance_displacement"].max()),
        "largest displacement with damper [mm]": escape_or(data["reached_displacement"].max()),
        "promise, tested with new starts": PROMISES[named(data, "promise")],
        "largest with the best tuned absorber [mm]": escape_or(np.fmin.reduce(absorbers)),
        "quiet share of 1000 unseen starts": unseen[0],
        "corners of the tolerances": len(unseen) - 1,
        "least quiet share at a corner": unseen[1:].min() if len(unseen) > 1 else "-",
    }


def _gap(data, tolerance):
    """Return the gap as text, with its tolerance or with the narrower range that it must keep."""
    gap = f"{float(data['design_gap']):.3g}"
    if named(data, "design_choice") == "needs_tolerance":
        return f"{gap}, held from {quiet_gaps(data)}"
    return f"{gap} ± {100 * tolerance:.3g} %"


def escape_or(size):
    """Return a size as a number, or "escapes" for a motion that escapes, which has no size."""
    size = float(size)
    return "escapes" if np.isinf(size) else size
