"""Counts of where harmonic balance fails, by map and class."""

import numpy as np
import pandas as pd

from impact_damper.claims import extract
from impact_damper.datasets import flag, parameters_of
from impact_damper.survival import wilson
from impact_damper.variables import VARIABLES

QUESTIONS = {
    "quiet motion": "quiet_verdict",
    "start at the quiet solution": "quiet_run_motion",
    "high motion": "high_verdict",
}


def balance_map(datasets) -> pd.DataFrame:
    """Cells of each map by class, the share of chaos, and how far amplitudes are off.

    A share has the 95 % interval that it would have for cells drawn at random.
    """
    rows = []
    for name, data in datasets.get("balance_map", {}).items():
        head = {"map": name, "over": f"W/Wp and {parameters_of(data)['parameter']}"}
        for question, variable in QUESTIONS.items():
            values = data[variable].values
            for value in VARIABLES[variable].flags.values():
                count = int(np.sum(values == value))
                if count:
                    words = {"question": question, "class": extract.meaning(variable, value)}
                    rows.append(head | words | _share(count, values.size))
        rows += [head | row for row in _summary(data)]
    return pd.DataFrame(rows)


def _share(count, total):
    share, lower, upper = wilson(count, total)
    return {"cells": count, "of": total, "share": share, "lower": lower, "upper": upper}


def _summary(data):
    """Chaos among high motions, captures of what should be stable, and amplitudes."""
    kinds = data["high_run_motion"].values
    chaotic = int(np.sum(kinds == flag("high_run_motion", "high_chaotic")))
    settled = int(np.sum(kinds == flag("high_run_motion", "high")))
    yield {"question": "high motions found", "class": "chaotic"} | _share(
        chaotic, chaotic + settled
    )
    agreed = data["quiet_verdict"].values == flag("quiet_verdict", "stable_stable")
    reached = agreed & (data["quiet_run_motion"].values == flag("quiet_run_motion", "quiet"))
    words = {"question": "stable quiet orbits", "class": "reached from the quiet solution"}
    yield words | _share(int(reached.sum()), int(agreed.sum()))
    size = data["balance_quiet_amplitude"].values[agreed]
    for name, true in {
        "max |Z1|": "quiet_orbit_displacement",
        "its first harmonic": "quiet_orbit_harmonic",
    }.items():
        near = np.abs(size / data[true].values[agreed] - 1) <= 0.2
        words = {"question": "stable quiet orbits", "class": f"|a| within 20 % of {name}"}
        yield words | _share(int(near.sum()), len(near))
