"""Tables of the optimum clearance d0, at which the machine moves least, and of rules for d0."""

import numpy as np
import pandas as pd

from chatterjee1995.methods.quiet_orbits import RULES, rule_ratios
from chatterjee1995.reading import datasets as reading
from chatterjee1995.tables.files import parameter_columns
from impact_damper.data.datasets import damper_of, decode, oscillator_of, parameters_of

WITHIN = (1, 10)  # the table counts the optima predicted within these errors, in per cent
# Rule for the clearance -> name: a constant value of rm W^2 d0, or the model behind the rule.
RULE_NAMES = {
    "balance": "(18): 1",
    "gap_harmonic": "pi^2/8",
    "straight_flight": "straight flight between rigid walls",
    "elastic": "explicit, elastic contact",
    "flight": "flight with corrections",
}
SWEEPS = "clearance sweeps of figures 6, 7 and 11"
CRITERIA = {"displacement": "max |Z1|", "first_harmonic": "first harmonic of Z1"}


def optimum(datasets) -> pd.DataFrame:
    """Return a table of clearance sweeps: optimum d0 by simulation, equation (7) and each rule."""
    rows = []
    for name, data in datasets.get("optimum", {}).items():
        best, rule = float(data.optimum_clearance), float(data.rule_clearance)
        lower, upper = data.near_clearance.values
        rows.append(
            {"sweep": name}
            | parameter_columns(data, "damping", "frequency", "mass_ratio", "restitution")
            | {
                "optimum clearance d0, simulated": best,
                "optimum d0 by equations (7)": float(data.analytical_optimum),
                "d0 by rule (18)": rule,
                "least displacement max |Z1|": float(data.optimum_displacement),
                "kind of optimum": reading.meaning(data.optimum_kind),
                "at most 10 % more max |Z1| from d0": lower,
                "to d0": upper,
                "excess over (18)": best / rule - 1,
                "rm Ω^2 d0": float(data.optimum_ratio),
                "rm Ω^2 d0 of straight flight": float(data.straight_flight_ratio),
                "d0 by rule (19)": float(data.peak_rule_clearance),
            }
        )
    return pd.DataFrame(rows)


def design_rules(datasets) -> pd.DataFrame:
    """Return a table of rules: how many optimum clearances a rule predicts within 1 % and 10 %."""
    cells = pd.concat([*_grids(datasets), *_sweeps(datasets)], ignore_index=True)
    grids = cells[cells.group != SWEEPS]
    elastic = np.where(grids.restitution == 1, "all grids, e = 1", "all grids, e < 1")
    cells = pd.concat([cells, grids.assign(group=elastic)], ignore_index=True)
    heads = ("designs", "quantity that is smallest", "rule for rm Ω^2 d0")
    groups = cells.groupby(["group", "criterion", "rule"], sort=False)
    return pd.DataFrame(
        dict(zip(heads, keys, strict=True)) | _agreement(part) for keys, part in groups
    )


def _grids(datasets):
    for name, data in datasets.get("design_rules", {}).items():
        named = {name: decode(data[name]) for name in ("best_kind", "best_stability")}
        cells = data.assign(named).to_dataframe().reset_index()
        cells["group"] = name
        cells["found"] = cells.best_kind != "not_found"
        cells["stable"] = cells.best_stability == "stable"
        cells["rule_excess"] = cells.rule_excess.where(cells.criterion == "displacement")
        yield cells.replace({"rule": RULE_NAMES, "criterion": CRITERIA})


def _sweeps(datasets):
    for data in datasets.get("optimum", {}).values():
        parameters = parameters_of(data)
        oscillator, damper = oscillator_of(data), damper_of(data, clearance=1.0)
        best = float(data.optimum_ratio)
        yield pd.DataFrame(
            {
                "group": SWEEPS,
                "criterion": CRITERIA["displacement"],
                "rule": [RULE_NAMES[rule] for rule in RULES],
                "restitution": parameters["restitution"],
                "best_ratio": best,
                "rule_ratio": rule_ratios(oscillator, damper, parameters["frequency"])[0],
                "rule_excess": np.nan,
                "found": np.isfinite(best),
                "stable": np.isfinite(best),  # simulations find only stable motions
            }
        )


def _agreement(cells):
    error = 100 * (cells.rule_ratio / cells.best_ratio - 1).abs()
    excess = 100 * cells.rule_excess
    return (
        {"optima predicted": int(error.notna().sum())}
        | {f"optima within {most} %": int((error <= most).sum()) for most in WITHIN}
        | {
            "median error of d0 [%]": error.median(),
            "largest error of d0 [%]": error.max(),
            "median excess of max |Z1| [%]": excess.median(),
            "largest excess of max |Z1| [%]": excess.max(),
            "number of designs": len(cells),
            "optima found": int(cells.found.sum()),
            "optima with a stable motion": int(cells.stable.sum()),
        }
    )
