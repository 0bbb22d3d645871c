"""Tables of the outcomes of starts, and of quasi-periodic, chaotic and subharmonic motions."""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits
from chatterjee1995.reading.bands import high_motions
from chatterjee1995.reading.datasets import Missing
from chatterjee1995.tables.files import DAMPER, parameter_columns
from impact_damper.data.motion_variables import OUTCOME

SWEPT = {
    "response": "frequency responses",
    "subharmonic": "starts on the free subharmonic",
    "optimum": "clearance sweeps",
}


def outcomes(datasets) -> pd.DataFrame:
    """Return a table that counts the starts with each outcome, one row for each dataset."""
    rows = []
    for stage, words in SWEPT.items():
        for name, data in reading.damped(datasets, stage).items():
            counts = {each: np.sum(data.run_outcome == OUTCOME[each]) for each in OUTCOME}
            rows.append(_outcomes(words, name, counts))
    for name, data in datasets.get("studies", {}).items():
        counts = data.outcome_count
        totals = counts.sum([dim for dim in counts.dims if dim != "counted_outcome"]).to_series()
        rows.append(_outcomes("planes of two parameters", name, totals))
    for name, data in datasets.get("balance_map", {}).items():
        counts = {each: np.sum(data.high_run_outcome == OUTCOME[each]) for each in OUTCOME}
        words = "starts at the largest solution of harmonic balance"
        rows.append(_outcomes(words, name, counts))
    return pd.DataFrame(rows)


def _outcomes(stage, name, counts):
    counts = {each: int(value) for each, value in dict(counts).items() if each != "absent"}
    starts = sum(counts.values())
    return {
        "stage": stage,
        "data": name,
        "settled": counts["settled"],
        "chaotic": counts["chaotic"],
        "quasi-periodic": counts["quasi_periodic"],
        "no contact": counts["non_colliding"],
        "no contact, still drifting": counts["drifting"],
        "unresolved": counts["unresolved"],
        "diverged, escaped or at rest": sum(
            counts.get(each, 0) for each in ("diverged", "escaped", "at_rest")
        ),
        "starts": starts,
        "unresolved of 2000 starts": 2000 * counts["unresolved"] / starts if starts else np.nan,
    }


def quasi_periodic(datasets) -> pd.DataFrame:
    """Return a table of quasi-periodic motions, one row for each motion of each curve."""
    rows = []
    for name, data in reading.damped(datasets, "response").items():
        for motion in _motions(data, reading.is_outcome(data, "quasi_periodic")):
            first, second = float(motion.first_frequency), float(motion.second_frequency)
            rows.append(
                {"curve": name}
                | parameter_columns(data, "mass_ratio", "clearance")
                | {
                    "forcing frequency Ω": float(motion.frequency),
                    "displacement max |Z1|": float(motion.maximum_displacement),
                    "random starts that lead to it": int(motion.motion_starts),
                    "second frequency": f"{second:.10f}",
                    "error of the second frequency": float(motion.frequency_error),
                    "rotation number": f"{second / first:.10f}",
                    "first frequency": f"{first:.10f}",
                    "closed curves": round(float(motion.frequency) / first),
                    "Lyapunov exponent": float(motion.lyapunov_exponent),
                    "its standard error": float(motion.lyapunov_error),
                }
                | parameter_columns(data, "damping", "restitution")
            )
    return pd.DataFrame(rows)


def chaos(datasets) -> pd.DataFrame:
    """Return a table of violent chaotic motions: after how many cycles, on average, chaos ends."""
    rows = []
    for name, data in reading.damped(datasets, "response").items():
        try:
            high = high_motions(data, orbits.free_of(datasets, data))
        except Missing:
            continue
        for motion in _motions(data, high & reading.is_outcome(data, "chaotic")):
            rows.append(
                {
                    "curve": name,
                    "forcing frequency Ω": float(motion.frequency),
                    "displacement max |Z1|": float(motion.maximum_displacement),
                    "Lyapunov exponent": float(motion.lyapunov_exponent),
                    "runs in which chaos ends": int(motion.life_ends),
                    "number of runs": reading.parameter(data, "life_runs"),
                    "mean life [cycles]": float(motion.mean_life),
                    "lower end of its 95 % interval": float(motion.mean_life_lower),
                    "upper end of its 95 % interval": float(motion.mean_life_upper),
                    "random starts that lead to it": int(motion.motion_starts),
                }
                | parameter_columns(data, "damping", *DAMPER)
            )
    return pd.DataFrame(rows)


def _motions(data, chosen):
    for k, j in np.argwhere(chosen.transpose("frequency", "motion").values):
        yield data.isel(frequency=k, motion=j)


def subharmonic(datasets) -> pd.DataFrame:
    """Return a table of the one-third subharmonic, without a damper and with each damper."""
    rows = []
    for name, free in reading.free(datasets, "branches").items():
        try:
            part = orbits.subharmonic(free)
            found = _stable_part(part[part.stable])
        except Missing:
            found = {"branch": "none"}
        rows.append(_subharmonic(name, "off", free) | found)
    for name, curve in datasets.get("subharmonic", {}).items():
        existing = curve.where(curve.free_subharmonic.notnull())
        rows.append(
            _subharmonic(name, "on", curve)
            | {
                "branch": "all",
                "largest displacement max |Z1|": float(existing.damped_subharmonic.max()),
                "largest ratio to free max |Z1|": float(existing.subharmonic_ratio.max()),
                "share of starts on the free one that lead to it": float(
                    existing.switched_share.mean()
                ),
            }
        )
        if name in datasets.get("branches", {}):
            part = orbits.stable_subharmonics(datasets["branches"][name])
            rows += [
                _subharmonic(name, "on", curve) | _stable_part(branch)
                for _, branch in part.groupby("branch")
            ]
    return pd.DataFrame(rows)


def _subharmonic(name, damper, data):
    columns = parameter_columns(data, "damping", "mass_ratio", "clearance")
    return (
        {"curve": name, "damper": damper}
        | dict.fromkeys(("damping h", "mass ratio rm", "clearance d0"), np.nan)
        | columns
        | {"branch": "", "stable from Ω": np.nan, "stable to Ω": np.nan}
        | {"largest displacement max |Z1|": np.nan, "period": np.nan}
        | parameter_columns(data, "linear_frequency")
    )


def _stable_part(part):
    return {
        "branch": f"{part.branch.iloc[0] + 1}",
        "period": part.period.iloc[0],
        "stable from Ω": part.lower.min(),
        "stable to Ω": part.upper.max(),
        "largest displacement max |Z1|": part["size"].max(),
    }
