"""Table of how often each rule for the clearance comes how near to the optimum."""

import numpy as np
import pandas as pd

from impact_damper.data.datasets import flag, parameters_of
from impact_damper.stages.design_rules import RULES, rule_ratios
from impact_damper.system.parameters import Damper, Oscillator

WITHIN = (1, 2, 5, 10)
WORDS = {
    "balance": "(18): 1",
    "gap_harmonic": "pi^2/8",
    "straight_flight": "straight flight between rigid walls",
    "elastic": "explicit, elastic contact",
    "flight": "flight with corrections",
}
SWEEPS = "clearance sweeps of figures 6, 7 and 11"
CRITERIA = {"displacement": "max |Z1|", "first_harmonic": "first harmonic of Z1"}


def design_rules(datasets) -> pd.DataFrame:
    """Counts of optima that each rule predicts within 1, 2, 5 and 10 %, and what an error costs.

    A row for each group of designs, criterion and rule. Groups are the grids, the clearance
    sweeps of the paper's figures, and the cells of all grids with elastic and with inelastic
    contact. Errors are over all optima found, whether the motion there is stable or not.
    """
    cells = pd.concat([*_grids(datasets), *_sweeps(datasets)], ignore_index=True)
    grids = cells[cells.group != SWEEPS]
    elastic = np.where(grids.restitution == 1, "all grids, e = 1", "all grids, e < 1")
    cells = pd.concat([cells, grids.assign(group=elastic)], ignore_index=True)
    keys = ["group", "criterion", "rule"]
    groups = cells.groupby(keys, sort=False)
    return pd.DataFrame([dict(zip(keys, name, strict=True)) | _row(each) for name, each in groups])


def _grids(datasets):
    """Cells of each grid: a row for each design, criterion and rule."""
    for name, data in datasets.get("design_rules", {}).items():
        cells = data.to_dataframe().reset_index()
        cells["group"] = name
        cells["found"] = cells.best_kind != flag("best_kind", "not_found")
        cells["stable"] = cells.best_stability == flag("best_stability", "stable")
        cells["rule_excess"] = cells.rule_excess.where(cells.criterion == "displacement")
        yield cells.replace({"rule": WORDS, "criterion": CRITERIA})


def _sweeps(datasets):
    """The same for the paper's clearance sweeps, whose motions are stable as they are reached."""
    for data in datasets.get("optimum", {}).values():
        given = parameters_of(data)
        oscillator = Oscillator(given["damping"], given["linear_frequency"])
        names = "mass_ratio", "restitution", "contact_stiffness"
        damper = Damper(clearance=1.0, **{name: given[name] for name in names})
        best = float(data.optimum_ratio)
        yield pd.DataFrame(
            {
                "group": SWEEPS,
                "criterion": CRITERIA["displacement"],
                "rule": [WORDS[rule] for rule in RULES],
                "restitution": given["restitution"],
                "best_ratio": best,
                "rule_ratio": rule_ratios(oscillator, damper, given["frequency"])[0],
                "rule_excess": np.nan,
                "found": np.isfinite(best),
                "stable": np.isfinite(best),
            }
        )


def _row(cells):
    """What a table says of a group's cells for one criterion and one rule."""
    error = 100 * (cells.rule_ratio / cells.best_ratio - 1).abs()
    excess = 100 * cells.rule_excess
    lost = cells.found & cells.rule_ratio.notna() & excess.isna()
    return {
        "designs": len(cells),
        "optima found": int(cells.found.sum()),
        "with a stable motion": int(cells.stable.sum()),
        "predicted": int(error.notna().sum()),
        **{f"within {most} %": int((error <= most).sum()) for most in WITHIN},
        "median error, %": error.median(),
        "largest error, %": error.max(),
        "no quiet motion at the rule": int(lost.sum()) if excess.notna().any() else np.nan,
        "median excess of max |Z1|, %": excess.median(),
        "largest excess, %": excess.max(),
    }
