"""Tables of harmonic balance: dampers at their design points, and convergence with harmonics.

A curve is a frequency response of the configuration; its design point is the peak frequency Wp. The
quiet orbit is the small periodic motion for which the damper is designed. A start is a random
initial state.
"""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as extract
from chatterjee1995.reading.datasets import Missing
from chatterjee1995.tables.columns import SYMBOLS, parameter_columns
from impact_damper.data.datasets import flag, is_settled

# Table of convergence: the parameters listed, and accuracy -> column with the harmonics needed.
MOTION = ("damping", "frequency", "mass_ratio", "clearance", "restitution", "contact_stiffness")
ACCURACIES = {0.01: "N for 1 %", 1e-3: "N for 1e-3", 1e-6: "N for 1e-6"}
# Error measures of the dataset and their columns. N is the highest harmonic of the balance.
MEASURES = {
    "maximum": "max |Z1|",
    "retained": "up to N",
    "omitted": "beyond N",
    "multiplier": "multipliers",
}
# How cold starts end, and their columns.
COLD_STARTS = {
    "same_motion": "same motion",
    "another_motion": "another motion",
    "stalled": "stalled",
    "iteration_limit": "not done",
}


# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "harmonic_balance": {
        "curve": "curve",
        "h": "damping h",
        "rm": "mass ratio rm",
        "d0": "clearance d0",
        "Wp": "peak frequency Ωp",
        "d0 of (19)": "d0 by rule (19)",
        "|a| at Wp": "amplitude |a| at Ωp, balance",
        "max |Z1| of quiet orbit": "max |Z1| at Ωp, exact orbit",
        "quiet orbit": "stability of the exact orbit",
    },
    "harmonic_convergence": {
        "motion": "motion",
        "max |Z1|": "displacement max |Z1|",
        "N for 1 %": "harmonics for an error of 1 %",
        "N for 1e-6": "harmonics for an error of 1e-6",
        "decay": "decrease with harmonics N",
        "max |Z1|, observed": "power or rate, observed",
        "max |Z1|, predicted": "power or rate, predicted",
        "cold starts": "cold starts",
        "same motion": "cold starts that find the motion",
    },
}


def harmonic_balance(datasets) -> pd.DataFrame:
    """Return the paper's rule (19), harmonic balance and exact orbit of each curve at its Wp."""
    rows = []
    for name, data in extract.damped(datasets, "harmonic_balance").items():
        peak = float(data.peak_frequency)
        parameters = parameter_columns(
            data, "damping", "linear_frequency", "mass_ratio", "clearance"
        )
        inertia = parameters["rm"] * peak**2
        rows.append(
            {"curve": name}
            | parameters
            | {
                "Wp": peak,
                "free |a| at Wp": float(data.peak_amplitude),
                "d0 of (19)": 1 / inertia,
                "rm Wp^2 d0": inertia * parameters["d0"],
                "|a| at Wp": float(data.quiet_amplitude),
                "reduction at Wp": float(data.reduction),
            }
            | _exact_orbit(datasets.get("design_orbit", {}).get(name))
        )
    return pd.DataFrame(rows)


def _exact_orbit(orbit):
    """Return columns on the exact quiet orbit and on random starts, both at the design point."""
    if orbit is None:
        return {}
    starts = {
        "starts that settle": float(np.mean(is_settled({"outcome": orbit.design_run_outcome}))),
        "largest max |Z1| of starts": float(orbit.design_run_displacement.max()),
    }
    try:
        quiet = extract.design_point(orbit)
    except Missing:
        return {"quiet orbit": "not found"} | starts
    multiplier = float(extract.largest_multiplier(quiet))
    return {
        "quiet orbit": "stable" if multiplier < 1 else "unstable",
        "max |Z1| of quiet orbit": float(quiet.orbit_displacement),
        "largest multiplier": multiplier,
        "stable from h": extract.stable_from(orbit),
    } | starts


def harmonic_convergence(datasets) -> pd.DataFrame:
    """Return for each motion the harmonics needed, the decrease of errors, and cold starts.

    Errors decrease with N as a power or an exponential; both the observed and the predicted power
    or rate are listed. In a cold start Newton's method for N harmonics begins from the solution
    with one harmonic.
    """
    return pd.DataFrame(
        {"motion": name} | _convergence(data)
        for name, data in datasets.get("harmonic_convergence", {}).items()
    )


def _convergence(data):
    """Return the row of a motion in the table of convergence."""
    highest = data["highest_harmonic"].values
    error = data["series_error"]
    row = {SYMBOLS[name]: np.nan for name in MOTION} | parameter_columns(data, *MOTION)
    row |= {"max |Z1|": float(data["exact_maximum"])}
    for accuracy, title in ACCURACIES.items():
        row[title] = _needed(highest, error.sel(error_measure="maximum").values, accuracy)
    row |= {
        "highest N": highest[-1],
        "failed": int(np.sum(data["series_status"] != flag("series_status", "converged"))),
        "Hill failed": int(np.sum(data["hill_status"] != flag("hill_status", "found"))),
        "error of multipliers": float(error.sel(error_measure="multiplier")[-1]),
        "decay": "exp(-rate N)" if data["decay_kind"] == 1 else "N^-power",
        "fitted from N": float(data["asymptotic_harmonic"]),
    }
    for measure, title in MEASURES.items():
        decay = data.sel(error_measure=measure)
        row[f"{title}, observed"] = float(decay["decay_observed"])
        row[f"{title}, predicted"] = float(decay["decay_predicted"])
    tried = data["cold_status"].values >= 0
    row["cold starts"] = int(np.sum(tried))
    for meaning, title in COLD_STARTS.items():
        row[title] = int(np.sum(data["cold_status"] == flag("cold_status", meaning)))
    lost = data["cold_status"].values > flag("cold_status", "same_motion")
    row["first lost at N"] = int(highest[lost][0]) if lost.any() else np.nan
    return row


def _needed(highest, error, accuracy):
    """Return the smallest N from which on all errors are at most `accuracy`; NaN if none is."""
    above = np.flatnonzero(~(error <= accuracy))
    first = above[-1] + 1 if len(above) else 0
    return highest[first] if first < len(highest) else np.nan
