"""Table of how many harmonics a motion needs, and how its errors fall."""

import numpy as np
import pandas as pd

from impact_damper.data.datasets import flag, parameters_of

PARAMETERS = {
    "damping": "h",
    "frequency": "W",
    "mass_ratio": "rm",
    "clearance": "d0",
    "restitution": "e",
    "contact_stiffness": "r1",
}
SHARES = {0.01: "N for 1 %", 1e-3: "N for 1e-3", 1e-6: "N for 1e-6"}
NAMES = {
    "maximum": "max |Z1|",
    "retained": "up to N",
    "omitted": "beyond N",
    "multiplier": "multipliers",
}
COLD = {
    "same_motion": "same motion",
    "another_motion": "another motion",
    "stalled": "stalled",
    "iteration_limit": "not done",
}


def harmonics(datasets) -> pd.DataFrame:
    """A row for each motion: parameters, harmonics needed, errors, decays, and cold starts."""
    return pd.DataFrame(
        {"motion": name} | _row(data) for name, data in datasets.get("harmonics", {}).items()
    )


def _row(data):
    given = parameters_of(data)
    highest = data["highest_harmonic"].values
    error = data["series_error"]
    row = {symbol: given.get(name, np.nan) for name, symbol in PARAMETERS.items()}
    row |= {"max |Z1|": float(data["exact_maximum"])}
    for share, words in SHARES.items():
        row[words] = _needed(highest, error.sel(error_measure="maximum").values, share)
    row |= {
        "highest N": highest[-1],
        "failed": int(np.sum(data["series_status"] != flag("series_status", "converged"))),
        "Hill failed": int(np.sum(data["hill_status"] != flag("hill_status", "found"))),
        "error of multipliers": float(error.sel(error_measure="multiplier")[-1]),
        "decay": "exp(-rate N)" if data["decay_kind"] == 1 else "N^-power",
        "fitted from N": float(data["asymptotic_harmonic"]),
    }
    for measure, words in NAMES.items():
        at = data.sel(error_measure=measure)
        row[f"{words}, observed"] = float(at["decay_observed"])
        row[f"{words}, predicted"] = float(at["decay_predicted"])
    tried = data["cold_status"].values >= 0
    row["cold starts"] = int(np.sum(tried))
    for meaning, words in COLD.items():
        row[words] = int(np.sum(data["cold_status"] == flag("cold_status", meaning)))
    lost = data["cold_status"].values > flag("cold_status", "same_motion")
    row["first lost at N"] = int(highest[lost][0]) if lost.any() else np.nan
    return row


def _needed(highest, error, share):
    """Least N from which on every error is at most a share; NaN if the last is not."""
    above = np.flatnonzero(~(error <= share))
    first = above[-1] + 1 if len(above) else 0
    return highest[first] if first < len(highest) else np.nan
