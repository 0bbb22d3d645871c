"""Tables of the contact model and of the rigid limit, with counts of the cells of their maps.

The contact force is a spring (stiffness r1) and a damper chosen for a restitution e. An exit rule
says where a contact ends: at zero penetration, as in the paper, or already at zero force. By the
paper's rule the wall therefore pulls at the end of a contact. The load is the relative acceleration
that all forces except the contact force cause (`contact.contact_law`).

The rigid limit compares this model with instantaneous impacts on rigid walls. "Mended" means that
the walls are corrected for the penetration at finite r1.
"""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as extract
from chatterjee1995.tables.columns import parameter_columns
from impact_damper.data.variables import VARIABLES

# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "contact_model": {
        "case": "case",
        "exit": "exit rule",
        "e": "restitution e, given",
        "realised e": "restitution e, realised",
        "energy lost": "fraction of energy lost",
        "cells": "map cells",
        "close": "cells within 1 % of e",
        "fair": "cells within 1 % to 5 %",
        "off": "cells beyond 5 %",
    },
    "rigid_limit": {
        "case": "case",
        "rm": "mass ratio rm",
        "e": "restitution e",
        "max |Z1|": "displacement max |Z1|",
        "rigid error": "relative error of rigid walls",
        "mended error": "relative error, corrected",
        "order": "exponent n, error ~ r1^-n",
        "r1 for 1%": "stiffness r1 for 1 %",
        "stability differs": "map cells in which stability differs",
    },
}


def _counts(name, values):
    """Return the number of cells with each value of a flag, keyed by the meaning of the value.

    A flag is a variable whose integers have a meaning each.
    """
    flags = VARIABLES[name].flags
    return {meaning.replace("_", " "): int(np.sum(values == flags[meaning])) for meaning in flags}


# Text shown in Markdown for each exit rule.
EXITS = {
    "zero_penetration": "at zero penetration, as in appendix B",
    "no_tension": "at zero force, without pull",
}
# Column -> function that turns the text of a cell of the CSV file into the text shown in Markdown.
# In columns without a function, underscores become spaces.
CELLS = {"exit": lambda cell: EXITS.get(cell, cell)}


def contact_model(datasets) -> pd.DataFrame:
    """Return for each exit rule the numbers of map cells by verdict, and contacts without load."""
    rows = []
    for name, data in datasets.get("contact_model", {}).items():
        for rule in data.exit_rule.values:
            cells = data.sel(exit_rule=rule)
            counts = _counts("contact_verdict", cells.contact_verdict.values)
            rows.append({"case": name, "exit": rule, "cells": cells.contact_verdict.size} | counts)
            for i, restitution in enumerate(data.used.values):
                rows.append(
                    {"case": name, "exit": rule, "e": restitution}
                    | _unloaded(cells.isel(used=i), rule == "zero_penetration")
                )
    return pd.DataFrame(rows)


def _unloaded(data, pulls):
    """Return the columns of a contact without load; with `pulls` also on the pull of the wall."""
    realised = float(data.unloaded_restitution)
    row = {
        "damping ratio": float(data.unloaded_damping),
        "realised e": realised,
        "energy lost": 1 - realised**2,
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
        own = data.sel(frequency=extract.parameter(data, "frequency"), method="nearest")
        needed = own.needed_stiffness.values
        where = [extract.meaning("needed_status", value) for value in own.needed_status.values]
        error = np.abs(data.rigid_error.values)
        both = np.isfinite(error)
        edges = [0.0, *data.threshold.values, np.inf]
        rows.append(
            {"case": name}
            | parameter_columns(
                data, "damping", "mass_ratio", "clearance", "restitution", "frequency"
            )
            | {
                "r1": extract.parameter(data, "contact_stiffness"),
                "max |Z1|": float(data.own_displacement),
                "rigid error": float(data.own_error),
                "mended error": float(data.own_mended_error),
                "error of multiplier": float(data.own_decay_error),
                "order": float(own.rigid_order),
                "mended order": float(own.mended_order),
            }
            | {
                f"r1 for {level:.0%}": where[i].replace("_", " ") if np.isnan(r1) else float(r1)
                for i, (level, r1) in enumerate(zip(data.threshold.values, needed, strict=True))
            }
            | {"cells": error.size}
            | _counts("rigid_verdict", data.rigid_verdict.values)
            | {
                f"error {low:.0%} to {high:.0%}" if high < np.inf else f"error over {low:.0%}": int(
                    np.sum(both & (error >= low) & (error < high))
                )
                for low, high in zip(edges[:-1], edges[1:], strict=True)
            }
            | {
                f"compliant {words}": count
                for words, count in _counts(
                    "compliant_status", data.compliant_status.values
                ).items()
                if words != "found"
            }
        )
    return pd.DataFrame(rows)
