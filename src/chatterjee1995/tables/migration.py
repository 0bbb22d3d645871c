"""Tables of migration control: the cases of the paper, and scans of releases by frequency.

Migration takes the oscillator without damper from its resonance to its small motion (the
non-resonance): the damper is switched on, and off again. Switching it off is called a release; the
free oscillator (without damper) then settles on one of its motions. A controller run switches the
damper until the free oscillator arrives at the small motion. A damped motion is one with damper.
"""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as extract
from chatterjee1995.tables.columns import parameter_columns
from impact_damper.data.datasets import flag
from impact_damper.data.sweeps import runs_of_true

# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "migration": {
        "case": "case",
        "W": "forcing frequency Ω",
        "released from": "released from",
        "to non-resonance": "share to the non-resonance",
        "to resonance": "share to the resonance",
        "to subharmonic": "share to the subharmonic",
        "to unresolved": "share unresolved",
        "within 350 cycles": "share of control runs within 350 cycles",
        "median cycles, all runs": "median time [cycles]",
    },
    "release_scan": {
        "scan": "scan",
        "released from": "released from",
        "period": "period of the damped motion [cycles]",
        "leads to": "leads to",
        "at W": "at Ω",
        "frequencies": "frequencies",
        "to non-resonance": "share to the non-resonance",
        "to resonance": "share to the resonance",
        "to subharmonic": "share to the subharmonic",
    },
}


def migration(datasets) -> pd.DataFrame:
    """Return the shares of releases that lead to each free motion, and results of controller runs.

    The table has one row for each case and each damped motion from which the oscillator is
    released.
    """
    rows = []
    for name, case in datasets.get("migration", {}).items():
        reached = case.trial_outcome == flag("trial_outcome", "reached")
        runs = {
            "runs that arrive": float(reached.mean()),
            "within 350 cycles": float(case.within_share.sel(bound="share")),
            "median switchings of runs that arrive": float(case.switchings.where(reached).median()),
            "median cycles, damper on, all runs": float(case.damper_time.median()),
            "median cycles, all runs": float(case.total_time.median()),
            "most cycles, all runs": float(case.total_time.max()),
            "long damped runs that settle on the quiet motion": float(
                (case.landed_on == flag("landed_on", "quiet")).mean()
            ),
            "rate of settling per cycle": float(case.escape_rate.sel(bound="share")),
        }
        for k in range(case.sizes["damped"]):
            shares = case.release_share.isel(damped=k)
            rows.append(
                {"case": name}
                | parameter_columns(case, "frequency")
                | {
                    "released from": extract.meaning("damped_kind", case.damped_kind[k])
                    + (", without contact" if case.damped_contacts[k] == 0 else ""),
                    "period": int(case.damped_period[k]),
                    "max |Z1|": float(case.damped_displacement[k]),
                }
                | {
                    f"to {end}".replace("_", "-"): float(shares.sel(free_motion=end, bound="share"))
                    for end in case.free_motion.values
                }
                | {
                    "to non-resonance at least": float(
                        shares.sel(free_motion="non_resonance", bound="lower")
                    ),
                    "to non-resonance at most": float(
                        shares.sel(free_motion="non_resonance", bound="upper")
                    ),
                }
                | runs
            )
    return pd.DataFrame(rows)


def release_scan(datasets) -> pd.DataFrame:
    """Return the frequencies at which releases from each damped motion lead to each free motion.

    The table has one row for each scan, damped motion and set of free motions. The row lists the
    frequencies at which releases lead to each free motion of the set and to no other.
    """
    rows = []
    for name, scan in datasets.get("release_scan", {}).items():
        shares = scan.release_share.sel(bound="share", drop=True).to_series().unstack().dropna()
        shares["kind"] = scan.damped_kind.to_series()
        shares["period"] = scan.damped_period.to_series()
        shares = shares.groupby(["kind", "period", "frequency"])[list(scan.free_motion.values)]
        for (kind, period), motion in shares.mean().groupby(level=["kind", "period"]):
            motion = motion.droplevel(["kind", "period"])
            ends = motion.apply(lambda row: ", ".join(row.index[row > 0]), axis=1)
            for destinations, part in motion.groupby(ends, sort=False):
                rows.append(
                    {"scan": name}
                    | parameter_columns(scan, "damping", "mass_ratio", "clearance", "restitution")
                    | {
                        "released from": extract.meaning("damped_kind", kind),
                        "period": int(period),
                        "leads to": destinations.replace("_", "-"),
                        "at W": _ranges(scan.frequency.values, part.index),
                        "frequencies": len(part),
                    }
                    | {f"to {end}".replace("_", "-"): part[end].mean() for end in part}
                )
    return pd.DataFrame(rows)


def _ranges(grid, chosen):
    """Return the chosen values of a grid as text; neighbouring values are joined to a range."""
    runs = runs_of_true(np.isin(grid, chosen))
    ends = [dict.fromkeys([f"{grid[first]:.5g}", f"{grid[last - 1]:.5g}"]) for first, last in runs]
    return ", ".join(" to ".join(pair) for pair in ends)
