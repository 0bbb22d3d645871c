"""Tables of harmonic balance: designs, errors by number of harmonics, and maps of errors."""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading.datasets import Missing
from chatterjee1995.tables.files import parameter_columns
from impact_damper.data.datasets import decode, is_settled, parameters_of
from impact_damper.data.shares import wilson

NEAR = 0.2  # an amplitude is near the exact amplitude if the relative difference is at most this
ACCURACIES = {0.01: "1 %", 1e-3: "1e-3", 1e-6: "1e-6"}  # error of the amplitude -> text
# Question about each cell of a map -> variable of the dataset with the answers.
QUESTIONS = {
    "quiet motion": "quiet_verdict",
    "start at the quiet solution": "quiet_run_motion",
    "violent motion": "high_verdict",
}
TRUTHS = {
    "high": "violent",
    "high chaotic": "violent and chaotic",
    "low": "small",
    "low chaotic": "small and chaotic",
    "other low": "another small motion",
    "near": "violent, max |Z1| within 20 % of |a|",
    "far": "violent, max |Z1| more than 20 % from |a|",
}


def harmonic_balance(datasets) -> pd.DataFrame:
    """Return a table of dampers: clearance by rule (19), and amplitudes at the peak frequency."""
    rows = []
    for name, data in reading.damped(datasets, "harmonic_balance").items():
        peak = float(data.peak_frequency)
        mass_ratio, clearance = reading.parameters(data, "mass_ratio", "clearance")
        rows.append(
            {"curve": name}
            | parameter_columns(data, "damping", "mass_ratio", "clearance")
            | {
                "peak frequency Ωp": peak,
                "d0 by rule (19)": 1 / (mass_ratio * peak**2),
                "amplitude |a| at Ωp, balance": float(data.quiet_amplitude),
            }
            | _exact_orbit(datasets.get("design_orbit", {}).get(name))
            | {
                "free |a| at Ωp": float(data.peak_amplitude),
                "rm Ωp^2 d0": mass_ratio * peak**2 * clearance,
                "reduction at Ωp": float(data.reduction),
            }
            | parameter_columns(data, "linear_frequency")
        )
    return pd.DataFrame(rows)


def _exact_orbit(orbit):
    columns = {"max |Z1| at Ωp, exact orbit": np.nan, "stability of the exact orbit": ""}
    if orbit is None:
        return columns
    columns |= {
        "largest multiplier": np.nan,
        "starts that settle": float(np.mean(is_settled({"outcome": orbit.design_run_outcome}))),
        "largest max |Z1| of starts": float(orbit.design_run_displacement.max()),
    }
    try:
        quiet = reading.design_point(orbit)
    except Missing:
        return columns | {"stability of the exact orbit": "not found"}
    multiplier = float(reading.largest_multiplier(quiet))
    return columns | {
        "max |Z1| at Ωp, exact orbit": float(quiet.orbit_displacement),
        "stability of the exact orbit": "stable" if multiplier < 1 else "unstable",
        "largest multiplier": multiplier,
    }


def harmonic_convergence(datasets) -> pd.DataFrame:
    """Return a table of motions: how the error of harmonic balance falls with more harmonics."""
    return pd.DataFrame(
        {"motion": name} | _convergence(data)
        for name, data in datasets.get("harmonic_convergence", {}).items()
    )


def _convergence(data):
    # A cold start begins Newton's method from the solution with one harmonic.
    highest, cold = data["highest_harmonic"].values, decode(data["cold_status"]).values
    error = data["series_error"].sel(error_measure="maximum").values
    decay = data.sel(error_measure="maximum")
    exponential = decode(data["decay_kind"]) == "exponential"
    lost = highest[~np.isin(cold, ["not_tried", "same_motion"])]

    def ended(meaning):
        return int(np.sum(cold == meaning))

    return (
        {"displacement max |Z1|": float(data["exact_maximum"])}
        | {
            f"harmonics for an error of {words}": _needed(highest, error, accuracy)
            for accuracy, words in ACCURACIES.items()
        }
        | {
            "decrease with harmonics N": "exp(-rate N)" if exponential else "N^-power",
            "power or rate, observed": float(decay["decay_observed"]),
            "power or rate, predicted": float(decay["decay_predicted"]),
            "cold starts": int(np.sum(cold != "not_tried")),
            "cold starts that find the motion": ended("same_motion"),
            "cold starts that find another motion": ended("another_motion"),
            "cold starts that stall": ended("stalled"),
            "first lost at N": int(lost[0]) if len(lost) else np.nan,
            "failed": int(np.sum(decode(data["series_status"]) != "converged")),
        }
        | parameter_columns(data, "damping", "frequency", "mass_ratio", "clearance", "restitution")
    )


def _needed(highest, error, accuracy):
    """Return the least number of harmonics at and above which `error` <= `accuracy`, or NaN."""
    above = np.flatnonzero(~(error <= accuracy))
    first = above[-1] + 1 if len(above) else 0
    return highest[first] if first < len(highest) else np.nan


def balance_map(datasets) -> pd.DataFrame:
    """Return a table that counts the map cells in which harmonic balance is right or wrong."""
    rows = []
    for name, data in datasets.get("balance_map", {}).items():
        found = []
        for question, variable in QUESTIONS.items():
            values = decode(data[variable]).values
            for meaning in data[variable].attrs["flag_meanings"].split():
                count = int(np.sum(values == meaning))
                if count:
                    found.append(_cells(question, *_answers(meaning), count, values.size))
        over = f"Ω/Ωp and {parameters_of(data)['parameter']}"
        rows += [{"map": name} | row | {"over": over} for row in [*found, *_summary(data)]]
    return pd.DataFrame(rows)


def _answers(meaning):
    balance, _, truth = meaning.partition("_")
    if balance not in ("none", "stable", "unstable") or not truth:
        balance, truth = "", meaning
    words = truth.replace("_", " ")
    return balance, TRUTHS.get(words, words)


def _cells(question, balance, truth, count, total):
    share, lower, upper = wilson(int(count), int(total))
    return {
        "question": question,
        "harmonic balance says": balance,
        "exact motions": truth,
        "map cells": int(count),
        "of cells": int(total),
        "share": share,
        "lower end of its 95 % interval": lower,
        "upper end of its 95 % interval": upper,
    }


def _summary(data):
    kinds = decode(data["high_run_motion"])
    chaotic = np.sum(kinds == "high_chaotic")
    settled = np.sum(kinds == "high")
    yield _cells("violent motions found", "", "chaotic", chaotic, chaotic + settled)
    agreed = decode(data["quiet_verdict"]).values == "stable_stable"
    landed = decode(data["quiet_run_motion"]).values[agreed] == "quiet"
    question = "balance stable, orbit stable"
    reached = "reached from the balance's solution"
    yield _cells(question, "", reached, landed.sum(), len(landed))
    size = data["balance_quiet_amplitude"].values[agreed]
    for words, variable in (
        ("max |Z1|", "quiet_orbit_displacement"),
        ("its first harmonic", "quiet_orbit_harmonic"),
    ):
        near = np.abs(size / data[variable].values[agreed] - 1) <= NEAR
        yield _cells(question, "", f"|a| within 20 % of {words}", near.sum(), len(near))
