"""Table of the dampers designed for machines in SI units; the gap is the full play."""

import json

import numpy as np
import pandas as pd

from impact_damper.data.datasets import named, parameters_of

ADVICE = {"build": "build it", "do_not_build": "do not build it"}


def machines(datasets) -> pd.DataFrame:
    """Return a table of machines: gap of the damper, advice, and largest displacements."""
    return pd.DataFrame([_row(name, data) for name, data in datasets.get("machines", {}).items()])


def _row(name, data):
    made, asked = json.loads(data.attrs["machine"]), parameters_of(data)
    tolerance = 100 * asked["tolerances"].get("gap", 0.0)
    return {
        "machine": name,
        "loose mass [kg]": made["damper_mass"],
        "band [Hz]": " to ".join(f"{end:g}" for end in asked["band"]),
        "gap, full play [mm]": f"{float(data['design_gap']):.3g} ± {tolerance:.3g} %",
        "advice": ADVICE[named(data, "decision")],
        "largest displacement without damper [mm]": float(data["largest_bare_displacement"]),
        "promised displacement [mm]": escape_or(data["promised_displacement"]),
        "promised for the share of starts": float(data["promised_share"]),
        "largest with the best tuned absorber [mm]": escape_or(data["tuned_displacement"]),
        "largest with this absorber detuned by 10 % [mm]": escape_or(data["detuned_displacement"]),
    }


def escape_or(size):
    """Return a displacement as a number, or the word "escapes" if it is infinite."""
    size = float(size)
    return "escapes" if np.isinf(size) else size
