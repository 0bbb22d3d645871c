"""Tables of the contact model, and of the errors made if walls are taken as rigid."""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as reading
from chatterjee1995.tables.files import parameter_columns
from impact_damper.data.datasets import decode

EXITS = {
    "zero_penetration": "at zero penetration, as in appendix B",
    "no_tension": "at zero force, without pull",
}


def _count(values, meaning):
    return int(np.sum(decode(values) == meaning))


def contact_model(datasets) -> pd.DataFrame:
    """Return a table of given and realised restitution, for two rules that end a contact.

    By the first rule a contact ends at zero depth, by the second rule at zero force. Further
    columns count map cells with small errors of the restitution, and with large errors.
    """
    rows = []
    for name, data in datasets.get("contact_model", {}).items():
        for rule in data.exit_rule.values:
            cells = data.sel(exit_rule=rule)
            values = cells.contact_verdict
            counts = {
                "map cells": values.size,
                "cells within 1 % of e": _count(values, "close"),
                "cells within 1 % to 5 %": _count(values, "fair"),
                "cells beyond 5 %": _count(values, "off"),
                "cells that fall back": _count(values, "falls_back"),
                "cells without release": _count(values, "no_release"),
            }
            for i in range(data.sizes["used"]):
                head = {"case": name, "exit rule": EXITS[str(rule)]}
                rows.append(head | _unloaded(cells.isel(used=i)) | counts)
    return pd.DataFrame(rows)


def _unloaded(data):
    realised = float(data.unloaded_restitution)
    return {
        "restitution e, given": float(data.used),
        "restitution e, realised": realised,
        "fraction of energy lost": 1 - realised**2,
        "time in contact": float(data.unloaded_duration),
        "share of contact with pull": float(data.unloaded_pull_time),
    }


def rigid_limit(datasets) -> pd.DataFrame:
    """Return a table of dampers: the error of max |Z1| that is made if walls are taken as rigid."""
    rows = []
    for name, data in datasets.get("rigid_limit", {}).items():
        own = data.sel(frequency=reading.parameter(data, "frequency"), method="nearest")
        verdict = data.rigid_verdict
        rows.append(
            {"case": name}
            | parameter_columns(data, "mass_ratio", "restitution")
            | {
                "displacement max |Z1|": float(data.own_displacement),
                "relative error of rigid walls": float(data.own_error),
                "relative error, corrected": float(data.own_mended_error),
                "exponent n, error ~ r1^-n": float(own.rigid_order),
                "exponent, corrected": float(own.mended_order),
            }
            | _needed(own)
            | {
                f"map cells in which {words}": _count(verdict, meaning)
                for meaning, words in VERDICTS.items()
            }
            | {"map cells": verdict.size}
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
    columns = {}
    for k, level in enumerate(own.threshold.values):
        value = float(own.needed_stiffness[k])
        why = reading.meaning(own.needed_status[k])
        columns[f"stiffness r1 for {100 * level:g} %"] = why if np.isnan(value) else value
    return columns
