"""Tables of the accuracy of methods on test cases (scenes), and of the accuracy of design models.

A scene is one motion with a required accuracy: a quantity and its largest allowed error. Methods
are integrators and models that compute a periodic orbit directly. Their work is
counted in floating-point operations. Equation numbers in brackets are those of the paper: (7)
is harmonic balance with one harmonic, (18) its rule for the clearance d0.
"""

import numpy as np
import pandas as pd

from chatterjee1995.methods.integrators import runs_of_accuracy
from chatterjee1995.methods.labels import MODELS, method_in_words
from chatterjee1995.reading import datasets as extract
from impact_damper.data.datasets import flag, parameters_of

# Text of a required accuracy for each quantity; `{:g}` takes the largest error allowed.
WORDS = {
    "amplitude": "max |Z1|, relative error {:g}",
    "state": "state, error {:g}",
    "contact_time": "contact times, error {:g}",
    "contacts": "number of contacts, error {:g}",
    "contact_rate": "contacts a cycle, relative error {:g}",
    "displacement": "mean max |Z1|, relative error {:g}",
    "exponent": "Lyapunov exponent, relative error {:g}",
}


# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "models": {
        "scene": "scene",
        "asks": "required accuracy",
        "method": "method",
        "setting": "tolerance or highest harmonic",
        "operations": "work [floating-point operations]",
        "meets it": "meets the required accuracy",
        "choice": "choice",
        "of max |Z1|": "error of max |Z1|",
        "contacts a period": "contacts a cycle",
    },
}
# Column -> function that turns the text of a cell of the CSV file into the text shown in Markdown.
# In columns without a function, underscores become spaces.
CELLS = {"method": method_in_words}


def models(datasets) -> pd.DataFrame:
    """Return a row for each method and scene.

    A row holds the setting of the method (tolerance or highest harmonic) that meets the required
    accuracy with the least work. If no setting does, the row holds the setting with the least
    error. The column `choice` marks the method with the least work; if this method is a model of
    orbits, the column also marks the integrator with the least work. Taylor series of other orders
    than the package uses are listed, but never marked.
    """
    rows = []
    for name, data in datasets.get("accuracy", {}).items():
        made = parameters_of(data)
        asked = WORDS[made["accuracy"]["quantity"]].format(made["accuracy"]["within"])
        runs = list(runs_of_accuracy())
        labels = [*runs, *MODELS]
        best, integrator = cheapest(data, labels), cheapest(data, runs)
        others = sorted(set(data["method"].values) - set(labels))
        for method in [*labels, *others]:
            k = cheapest(data, (method,))
            if k is None:
                k = _most_accurate(data, method)
            if k is None:
                continue
            of = data.isel(run=k)
            words = "cheapest that is accurate enough" if k == best else ""
            if k == integrator != best:
                words = "cheapest integrator"
            row = {
                "scene": name,
                "asks": asked,
                "method": method,
                "setting": float(of.setting),
                "status": extract.meaning("run_status", of.run_status),
                "operations": float(of.operations) or np.nan,
                "meets it": extract.meaning("meets_accuracy", of.meets_accuracy),
                "choice": words,
            }
            rows.append(row | (_averages(data, of) if "average" in data else _errors(of)))
    return pd.DataFrame(rows)


def cheapest(data, labels):
    """Return the index of the run with the least work that meets the accuracy, None if none does.

    Parameters
    ----------
    data : xarray.Dataset
        Dataset returned by `stages.accuracy.error_against_work`.
    labels : sequence of str
        Methods to choose from.
    """
    meets = data["meets_accuracy"].values == flag("meets_accuracy", "yes")
    meets &= np.isin(data["method"].values, labels)
    work = np.where(meets, data["operations"].values, np.inf)
    return int(np.argmin(work)) if meets.any() else None


def _most_accurate(data, method):
    """Return the index of the run of a method with the least error of max |Z1|.

    For a chaotic motion, return the run with the least error of the contacts per cycle. If no
    error is known, return the first run; if the method was not run, None.
    """
    runs = np.flatnonzero(data["method"].values == method)
    if not len(runs):
        return None
    if "average" in data:
        away = data["average"].values[runs, 0] / data["reference_average"].values[0] - 1
    else:
        away = data["amplitude_error"].values[runs]
    return runs[np.argmin(np.where(np.isnan(away), np.inf, np.abs(away)))]


def _errors(of):
    """Return the columns with the errors of a run on a scene with one motion."""
    return {
        "error of the state": float(of.state_error),
        "of contact times": float(of.contact_time_error),
        "of their number": float(of.contact_excess),
        "of max |Z1|": float(of.amplitude_error),
    }


def _averages(data, of):
    """Return the columns with the averages of a run on a chaotic scene, and their references."""
    row = {}
    names = {"contact_rate": "contacts a period", "displacement": "mean max |Z1|"}
    for key, words in (names | {"exponent": "Lyapunov exponent"}).items():
        row[words] = float(of.average.sel(statistic=key))
        row[f"{words}, standard error"] = float(of.average_error.sel(statistic=key))
        row[f"{words}, reference"] = float(data.reference_average.sel(statistic=key))
    return row


def _reading(name, quantity, model, value, least, most):
    """Return a row: the value of a model, and the exact value between `least` and `most`."""
    nearest = np.clip(value, least, most)
    return {
        "data": name,
        "quantity": quantity,
        "model": model,
        "by the model": value,
        "by the motions": least,
        "or up to": most if most != least else np.nan,
        "relative error": value / nearest - 1,
    }
