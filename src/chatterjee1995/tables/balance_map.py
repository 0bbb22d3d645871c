"""Table of the maps that compare harmonic balance with the exact motions, cell by cell.

A cell is a pair of forcing frequency and another parameter. A quiet motion is small, a high motion
not small compared with the resonance without damper. The quiet solution is the small solution of
harmonic balance. Wp is the peak frequency of the oscillator without damper.
"""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as extract
from chatterjee1995.stages.balance_map import NEAR
from chatterjee1995.variables.balance_map import BALANCE_VERDICT
from impact_damper.data.datasets import flag, parameters_of
from impact_damper.data.shares import wilson
from impact_damper.data.variables import VARIABLES

# What is asked about each cell, and the variable of the dataset that holds the answer as a flag: an
# integer for each meaning.
QUESTIONS = {
    "quiet motion": "quiet_verdict",
    "start at the quiet solution": "quiet_run_motion",
    "high motion": "high_verdict",
}
# Sizes of the exact quiet orbit with which the amplitude |a| of harmonic balance is compared.
AMPLITUDES = {
    "max |Z1|": "quiet_orbit_displacement",
    "its first harmonic": "quiet_orbit_harmonic",
}


# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "balance_map": {
        "map": "map",
        "question": "question",
        "balance": "harmonic balance says",
        "truth": "exact motions",
        "cells": "map cells",
        "of": "of cells",
        "share": "share",
        "lower": "lower end of its 95 % interval",
        "upper": "upper end of its 95 % interval",
    },
}
# Text shown in Markdown for cells of the column `truth`.
TRUTHS = {
    "high": "violent",
    "high chaotic": "violent and chaotic",
    "low": "small",
    "low chaotic": "small and chaotic",
    "other low": "another small motion",
    "near": "violent, max |Z1| within 20 % of |a|",
    "far": "violent, max |Z1| more than 20 % from |a|",
}
# Column -> function that turns the text of a cell of the CSV file into the text shown in Markdown.
# In columns without a function, underscores become spaces.
CELLS = {
    "question": lambda cell: cell.replace("high motion", "violent motion"),
    "truth": lambda cell: TRUTHS.get(cell, cell),
}


def balance_map(datasets) -> pd.DataFrame:
    """Return the numbers of map cells with each verdict, with chaos, and with accurate amplitudes.

    A verdict compares the answer of harmonic balance with the exact motion. The 95 % intervals of
    the shares of cells treat the cells of the grid as a random sample.
    """
    rows = []
    for name, data in datasets.get("balance_map", {}).items():
        head = {"map": name, "over": f"W/Wp and {parameters_of(data)['parameter']}"}
        for question, variable in QUESTIONS.items():
            values = data[variable].values
            for value in VARIABLES[variable].flags.values():
                count = int(np.sum(values == value))
                if count:
                    words = _words(variable, value)
                    rows.append(head | {"question": question} | words | _share(count, values.size))
        rows += [head | row for row in _summary(data)]
    return pd.DataFrame(rows)


def _words(variable, value):
    """Return the two parts of a flag's meaning: verdict of harmonic balance, exact result."""
    words = extract.meaning(variable, value)
    balance, _, truth = words.partition(" ")
    if balance in BALANCE_VERDICT and truth:
        return {"balance": balance, "truth": truth}
    return {"balance": "", "truth": words}


def _share(count, total):
    """Return the columns with a count, its total, the share and its Wilson interval."""
    share, lower, upper = wilson(count, total)
    return {"cells": count, "of": total, "share": share, "lower": lower, "upper": upper}


def _summary(data):
    """Yield rows on chaos among the high motions, and on the cells with a stable quiet orbit."""
    kinds = data["high_run_motion"].values
    chaotic = np.sum(kinds == flag("high_run_motion", "high_chaotic"))
    settled = np.sum(kinds == flag("high_run_motion", "high"))
    yield _row("high motions found", "chaotic", chaotic, chaotic + settled)
    long = data["high_long_outcome"].values
    still = np.sum(long == flag("high_long_outcome", "chaotic"))
    ran = np.sum(long != flag("high_long_outcome", "absent"))
    yield _row("chaotic ones run ten times as long", "still chaotic", still, ran)
    agreed = data["quiet_verdict"].values == flag("quiet_verdict", "stable_stable")
    landed = data["quiet_run_motion"].values[agreed] == flag("quiet_run_motion", "quiet")
    question = "balance stable, orbit stable"
    yield _row(question, "reached from the balance's solution", landed.sum(), len(landed))
    size = data["balance_quiet_amplitude"].values[agreed]
    for words, variable in AMPLITUDES.items():
        near = np.abs(size / data[variable].values[agreed] - 1) <= NEAR
        yield _row(question, f"|a| within 20 % of {words}", near.sum(), len(near))


def _row(question, truth, count, total):
    return {"question": question, "balance": "", "truth": truth} | _share(int(count), int(total))
