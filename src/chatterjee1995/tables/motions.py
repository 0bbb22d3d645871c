"""Tables of motions: outcomes of starts, quasi-periodic motions, shares, and lives of chaos.

A start is a random initial state, and its outcome says how the run from it ended: settled on a
periodic motion, chaotic, and so on. The share of a motion is the fraction of starts that lead to
it. The life of chaos is the time until a chaotic motion settles, as transient chaos does.
"""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as extract
from chatterjee1995.reading import orbits as exact_orbits
from chatterjee1995.reading.bands import high_motions
from chatterjee1995.reading.datasets import Missing
from chatterjee1995.tables.columns import parameter_columns
from impact_damper.data.datasets import flag
from impact_damper.data.variables import OUTCOME

DAMPER = ("mass_ratio", "clearance", "restitution")
# Stages whose datasets hold the outcome of each random start and the motion to which it leads.
SWEPT = ("response", "subharmonic", "optimum")
# Dimension of the outcomes in datasets of studies: planes of two parameters with random starts.
COUNTED = "counted_outcome"
# Stages whose datasets say which motions at neighbouring parameter values are the same.
MATCHED = ("response", "optimum")
# A motion is listed if at some value of the parameter at least this share of starts leads to it.
LISTED = 0.05
# Rare outcomes, counted together in the column `other`.
OTHERS = ("diverged", "escaped", "at_rest")
# A Lyapunov exponent within this number of standard errors of 0 counts as 0.
NEUTRAL = 3.0


# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "outcomes": {
        "stage": "stage",
        "data": "data",
        "settled": "settled",
        "chaotic": "chaotic",
        "quasi periodic": "quasi-periodic",
        "non colliding": "no contact",
        "drifting": "no contact, still drifting",
        "unresolved": "unresolved",
        "other": "diverged, escaped or at rest",
    },
    "quasi_periodic": {
        "data": "curve",
        "rm": "mass ratio rm",
        "d0": "clearance d0",
        "W": "forcing frequency Ω",
        "max |Z1|": "displacement max |Z1|",
        "starts": "random starts that lead to it",
        "second frequency": "second frequency",
        "its error": "error of the second frequency",
        "rotation number": "rotation number",
    },
    "chaos": {
        "data": "curve",
        "W": "forcing frequency Ω",
        "max |Z1|": "displacement max |Z1|",
        "Lyapunov exponent": "Lyapunov exponent",
        "runs that end": "runs in which chaos ends",
        "of": "number of runs",
        "mean life, periods": "mean life [cycles]",
        "at least": "lower end of its 95 % interval",
        "at most": "upper end of its 95 % interval",
    },
}
# Texts shown in Markdown for cells of the column `stage`.
STAGES = {
    "response": "frequency responses",
    "subharmonic": "starts on the free subharmonic",
    "optimum": "clearance sweeps",
    "studies": "planes of two parameters",
    "balance_map, high run": "starts at the largest solution of harmonic balance",
}
# Column -> function that turns the text of a cell of the CSV file into the text shown in Markdown.
# In columns without a function, underscores become spaces.
CELLS = {"stage": lambda cell: STAGES.get(cell, cell)}


def outcomes(datasets) -> pd.DataFrame:
    """Return the numbers of starts with each outcome.

    Unresolved starts are also counted by the sign of their Lyapunov exponent.
    """
    rows = []
    for stage in SWEPT:
        for name, data in extract.damped(datasets, stage).items():
            counts = {each: np.sum(data.run_outcome == OUTCOME[each]) for each in OUTCOME}
            rows.append(_row(stage, name, counts) | _reasons(data))
    for name, data in datasets.get("studies", {}).items():
        totals = data.outcome_count.sum([dim for dim in data.outcome_count.dims if dim != COUNTED])
        counts = {str(each): totals.sel({COUNTED: each}) for each in data[COUNTED].values}
        rows.append(_row("studies", name, counts))
    for name, data in datasets.get("balance_map", {}).items():
        counts = {each: np.sum(data.high_run_outcome == OUTCOME[each]) for each in OUTCOME}
        rows.append(_row("balance_map, high run", name, counts))
    return pd.DataFrame(rows)


def _row(stage, name, counts):
    """Return the columns with the number of starts of each outcome."""
    counts = {each: int(value) for each, value in counts.items() if each != "absent"}
    shown = {each.replace("_", " "): counts[each] for each in counts if each not in OTHERS}
    others = sum(counts.get(each, 0) for each in OTHERS)
    starts = sum(counts.values())
    return (
        {"stage": stage, "data": name, "starts": starts}
        | shown
        | {
            "other": others,
            "unresolved per 2000 starts": 2000 * counts["unresolved"] / starts
            if starts
            else np.nan,
        }
    )


def _reasons(data):
    """Return the numbers of unresolved starts by the sign of the Lyapunov exponent."""
    dims = data.run_motion.dims
    chosen = {"motion": data.run_motion}
    mean, error = data.lyapunov_exponent.isel(chosen), data.lyapunov_error.isel(chosen)
    lost = data.run_outcome == flag("run_outcome", "unresolved")
    size = mean / error
    return {
        "unresolved, growing": int((lost & (size > NEUTRAL)).sum(dims)),
        "unresolved, neutral": int((lost & (np.abs(size) <= NEUTRAL)).sum(dims)),
        "unresolved, shrinking": int((lost & ~(size >= -NEUTRAL)).sum(dims)),
    }


def quasi_periodic(datasets) -> pd.DataFrame:
    """Return the quasi-periodic motions with both frequencies and the number of random starts."""
    rows = []
    for name, data in extract.damped(datasets, "response").items():
        for k, j in np.argwhere(extract.is_outcome(data, "quasi_periodic").values):
            motion = data.isel(frequency=k, motion=j)
            first, second = float(motion.first_frequency), float(motion.second_frequency)
            rows.append(
                {"data": name}
                | parameter_columns(data, "damping", *DAMPER)
                | {
                    "W": float(motion.frequency),
                    "max |Z1|": float(motion.maximum_displacement),
                    "starts": int(motion.motion_starts),
                    "closed curves": round(float(motion.frequency) / first),
                    "first frequency": f"{first:.10f}",
                    "second frequency": f"{second:.10f}",
                    "its error": float(motion.frequency_error),
                    "rotation number": f"{second / first:.10f}",
                    "Lyapunov exponent": float(motion.lyapunov_exponent),
                    "its standard error": float(motion.lyapunov_error),
                }
            )
    return pd.DataFrame(rows)


def chaos(datasets) -> pd.DataFrame:
    """Return the chaotic motions that are violent, with their mean lives.

    A motion is violent if it has contacts and its max |Z1| exceeds half of max |Z1| on the
    resonance branch without damper at the same W.
    """
    rows = []
    for name, data in extract.damped(datasets, "response").items():
        try:
            high = high_motions(data, exact_orbits.free_of(datasets, data))
        except Missing:
            continue
        chosen = (high & extract.is_outcome(data, "chaotic")).transpose("frequency", "motion")
        for k, j in np.argwhere(chosen.values):
            motion = data.isel(frequency=k, motion=j)
            ends = int(motion.life_ends)
            rows.append(
                {"data": name}
                | parameter_columns(data, "damping", *DAMPER)
                | {
                    "W": float(motion.frequency),
                    "max |Z1|": float(motion.maximum_displacement),
                    "starts": int(motion.motion_starts),
                    "Lyapunov exponent": float(motion.lyapunov_exponent),
                    "runs that end": ends,
                    "of": extract.parameter(data, "life_runs"),
                    "mean life, periods": float(motion.mean_life),
                    "at least": float(motion.mean_life_lower),
                    "at most": float(motion.mean_life_upper),
                }
            )
    return pd.DataFrame(rows)


def _in_words(motion):
    """Return the period of a periodic motion, or the outcome of another one, as text."""
    period = f"period {motion.period}" if motion.outcome == "settled" else ""
    return period or motion.outcome.replace("_", " ")
