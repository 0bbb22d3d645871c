"""Tables of the contact model and of the rigid limit, with counts of the cells of their maps."""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as reading
from chatterjee1995.tables.columns import parameter_columns
from impact_damper.data.variables import VARIABLES

EXITS = {
    "zero_penetration": "at zero penetration, as in appendix B",
    "no_tension": "at zero force, without pull",
}


def _count(name, values, meaning):
    """Return the number of values of a flag with one meaning."""
    return int(np.sum(values == VARIABLES[name].flags[meaning]))


def contact_model(datasets) -> pd.DataFrame:
    """Return for each exit rule the numbers of map cells by verdict, and contacts without load."""
    rows = []
    for name, data in datasets.get("contact_model", {}).items():
        for rule in data.exit_rule.values:
            cells = data.sel(exit_rule=rule)
            head = {"case": name, "exit rule": EXITS[str(rule)]}
            head |= dict.fromkeys(
                ("restitution e, given", "restitution e, realised", "fraction of energy lost"),
                np.nan,
            )
            values = cells.contact_verdict.values
            rows.append(
                head
                | {
                    "map cells": values.size,
                    "cells within 1 % of e": _count("contact_verdict", values, "close"),
                    "cells within 1 % to 5 %": _count("contact_verdict", values, "fair"),
                    "cells beyond 5 %": _count("contact_verdict", values, "off"),
                    "cells that fall back": _count("contact_verdict", values, "falls_back"),
                    "cells without release": _count("contact_verdict", values, "no_release"),
                }
            )
            for i in range(data.sizes["used"]):
                one = cells.isel(used=i)
                rows.append(head | _unloaded(one, pulls=rule == "zero_penetration"))
    return pd.DataFrame(rows)


def _unloaded(data, pulls):
    """Return the columns of a contact without load; with `pulls` also on the pull of the wall."""
    realised = float(data.unloaded_restitution)
    row = {
        "restitution e, given": float(data.used),
        "restitution e, realised": realised,
        "fraction of energy lost": 1 - realised**2,
        "damping ratio": float(data.unloaded_damping),
        "time in contact": float(data.unloaded_duration),
    }
    if pulls:
        row |= {
            "share of contact with pull": float(data.unloaded_pull_time),
            "impulse of pull over push": float(data.unloaded_pull_impulse),
            "largest pull over push": float(data.unloaded_pull_peak),
        }
    return row


def rigid_limit(datasets) -> pd.DataFrame:
    """Return the errors of rigid walls against contact with the damper's r1, and counts of cells.

    The order is the exponent n with which the error falls as r1^-n.
    """
    rows = []
    for name, data in datasets.get("rigid_limit", {}).items():
        own = data.sel(frequency=reading.parameter(data, "frequency"), method="nearest")
        verdict, error = data.rigid_verdict.values, np.abs(data.rigid_error.values)
        needed, *others = _needed(own).items()
        rows.append(
            {"case": name}
            | parameter_columns(data, "mass_ratio", "restitution")
            | {
                "displacement max |Z1|": float(data.own_displacement),
                "relative error of rigid walls": float(data.own_error),
                "relative error, corrected": float(data.own_mended_error),
                "exponent n, error ~ r1^-n": float(own.rigid_order),
            }
            | dict([needed])
            | {
                f"map cells in which {words}": _count("rigid_verdict", verdict, meaning)
                for meaning, words in VERDICTS.items()
            }
            | dict(others)
            | _errors(error, data.threshold.values)
            | {
                "map cells": error.size,
                "exponent, corrected": float(own.mended_order),
                "error of the multiplier": float(data.own_decay_error),
            }
            | {
                f"compliant orbit {meaning.replace('_', ' ')}": _count(
                    "compliant_status", data.compliant_status.values, meaning
                )
                for meaning in VARIABLES["compliant_status"].flags
                if meaning != "found"
            }
            | parameter_columns(data, "damping", "clearance", "frequency", "contact_stiffness")
        )
    return pd.DataFrame(rows)


VERDICTS = {
    "stability_differs": "stability differs",
    "both_stable": "both are stable",
    "both_unstable": "both are unstable",
    "rigid_only": "only the rigid orbit exists",
    "compliant_only": "only the compliant orbit exists",
    "neither": "neither exists",
}


def _needed(own):
    """Return the stiffness from which on rigid walls are accurate, or why it is not known."""
    columns = {}
    for k, level in enumerate(own.threshold.values):
        value = float(own.needed_stiffness[k])
        why = reading.meaning("needed_status", int(own.needed_status[k]))
        columns[f"stiffness r1 for {100 * level:g} %"] = why if np.isnan(value) else value
    return columns


def _errors(error, thresholds):
    """Return the numbers of map cells with an error between two thresholds."""
    edges = [0.0, *thresholds, np.inf]
    columns = {}
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        ends = f"{100 * low:g} % to {100 * high:g} %" if high < np.inf else f"over {100 * low:g} %"
        columns[f"map cells with an error {ends}"] = int(np.sum((error >= low) & (error < high)))
    return columns
