"""Tables of the optimum clearance: simulated optima, and the accuracy of design rules.

The optimum clearance d0 gives the smallest quiet motion. (7), (18) and (19) are equations of the
paper: harmonic balance, and its rules for d0 at the frequency W and at the peak frequency Wp.
"""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as extract
from chatterjee1995.tables.columns import parameter_columns
from impact_damper.data.datasets import damper_of, flag, oscillator_of, parameters_of
from impact_damper.theory.optimum_clearance import RULES, rule_ratios

WITHIN = (1, 2, 5, 10)  # errors in per cent; the table counts the optima predicted within each
# Text for each rule: the value of rm W^2 d0 that it gives, or the model from which it follows.
RULE_NAMES = {
    "balance": "(18): 1",
    "gap_harmonic": "pi^2/8",
    "straight_flight": "straight flight between rigid walls",
    "elastic": "explicit, elastic contact",
    "flight": "flight with corrections",
}
SWEEPS = "clearance sweeps of figures 6, 7 and 11"
CRITERIA = {"displacement": "max |Z1|", "first_harmonic": "first harmonic of Z1"}


# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "optimum": {
        "sweep": "sweep",
        "h": "damping h",
        "W": "forcing frequency Ω",
        "rm": "mass ratio rm",
        "e": "restitution e",
        "optimum d0": "optimum clearance d0, simulated",
        "optimum d0 of (7)": "optimum d0 by equations (7)",
        "d0 of (18) at W": "d0 by rule (18)",
        "least max |Z1|": "least displacement max |Z1|",
    },
    "design_rules": {
        "group": "designs",
        "criterion": "quantity that is smallest",
        "rule": "rule for rm Ω^2 d0",
        "optima predicted": "optima predicted",
        "within 1 %": "optima within 1 %",
        "within 10 %": "optima within 10 %",
        "median error, %": "median error of d0 [%]",
        "largest error, %": "largest error of d0 [%]",
        "median excess of max |Z1|, %": "median excess of max |Z1| [%]",
    },
}


def optimum(datasets) -> pd.DataFrame:
    """Return the optimum clearance of each sweep by simulation, (7), rules and straight flight."""
    rows = []
    for name, data in datasets.get("optimum", {}).items():
        best, rule = float(data.optimum_clearance), float(data.rule_clearance)
        lower, upper = data.near_clearance.values
        rows.append(
            {"sweep": name}
            | parameter_columns(data, "damping", "frequency", "mass_ratio", "restitution")
            | {
                "d0 of (18) at W": rule,
                "d0 of (19) at Wp": float(data.peak_rule_clearance),
                "optimum d0 of (7)": float(data.analytical_optimum),
                "optimum d0": best,
                "least max |Z1|": float(data.optimum_displacement),
                "kind": extract.meaning("optimum_kind", data.optimum_kind),
                "within 10 % from d0": lower,
                "to d0": upper,
                "excess over (18)": best / rule - 1,
                "rm W^2 d0": float(data.optimum_ratio),
                "rm W^2 d0 of straight flight": float(data.straight_flight_ratio),
            }
        )
    return pd.DataFrame(rows)


def design_rules(datasets) -> pd.DataFrame:
    """Return the numbers of optima that each rule predicts within 1, 2, 5 and 10 %.

    The table has one row for each group of designs, criterion and rule. A design is a damper at a
    frequency: a cell of a grid. The groups are each grid, the clearance sweeps of the paper's
    figures, and the cells of all grids with elastic and with inelastic contact. The criterion is
    the quantity that the optimum makes smallest. Optima with stable and with unstable motions both
    count. The excess is the fraction by which max |Z1| at the rule's clearance exceeds the smallest
    max |Z1|.
    """
    cells = pd.concat([*_grids(datasets), *_sweeps(datasets)], ignore_index=True)
    grids = cells[cells.group != SWEEPS]
    elastic = np.where(grids.restitution == 1, "all grids, e = 1", "all grids, e < 1")
    cells = pd.concat([cells, grids.assign(group=elastic)], ignore_index=True)
    keys = ["group", "criterion", "rule"]
    groups = cells.groupby(keys, sort=False)
    return pd.DataFrame([dict(zip(keys, name, strict=True)) | _row(each) for name, each in groups])


def _grids(datasets):
    """Yield a frame for each grid, with one row for each design, criterion and rule."""
    for name, data in datasets.get("design_rules", {}).items():
        cells = data.to_dataframe().reset_index()
        cells["group"] = name
        cells["found"] = cells.best_kind != flag("best_kind", "not_found")
        cells["stable"] = cells.best_stability == flag("best_stability", "stable")
        cells["rule_excess"] = cells.rule_excess.where(cells.criterion == "displacement")
        yield cells.replace({"rule": RULE_NAMES, "criterion": CRITERIA})


def _sweeps(datasets):
    """Yield a frame with the columns of `_grids` for each clearance sweep.

    Simulation finds stable motions only, so all these optima are stable.
    """
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
                "stable": np.isfinite(best),
            }
        )


def _row(cells):
    """Return the columns of one row: a group of cells with one criterion and one rule."""
    error = 100 * (cells.rule_ratio / cells.best_ratio - 1).abs()
    excess = 100 * cells.rule_excess
    lost = cells.found & cells.rule_ratio.notna() & excess.isna()
    return {
        "designs": len(cells),
        "optima found": int(cells.found.sum()),
        "optima with a stable motion": int(cells.stable.sum()),
        "optima predicted": int(error.notna().sum()),
        **{f"within {most} %": int((error <= most).sum()) for most in WITHIN},
        "median error, %": error.median(),
        "largest error, %": error.max(),
        "no quiet motion at the clearance of the rule": int(lost.sum())
        if excess.notna().any()
        else np.nan,
        "median excess of max |Z1|, %": excess.median(),
        "largest excess, %": excess.max(),
    }
