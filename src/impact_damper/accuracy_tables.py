"""Table of scenes and models: error, work, and the cheapest model that is good enough."""

import numpy as np
import pandas as pd

from impact_damper.choice import METHODS, choice
from impact_damper.claims import extract
from impact_damper.datasets import parameters_of

ORBITS = ("rigid", "rigid_mended", "rigid_balance", "full_balance", "many_harmonics", "shooting")
INTEGRATORS = tuple(name for name in METHODS if name not in ORBITS)
WORDS = {
    "amplitude": "max |Z1| to {:g} of it",
    "state": "state to {:g}",
    "contact_time": "contact times to {:g}",
    "contacts": "number of contacts to {:g}",
    "contact_rate": "contacts a period to {:g} of them",
    "displacement": "mean max |Z1| to {:g} of it",
    "exponent": "Lyapunov exponent to {:g} of it",
}


def models(datasets) -> pd.DataFrame:
    """Each method on each scene, at the setting with the least work that meets the accuracy.

    Where none does, the setting with the least error. The choice is the one with the least work
    of all, and the cheapest that runs from any state where it is a model of orbits.
    """
    rows = []
    for name, data in datasets.get("accuracy", {}).items():
        made = parameters_of(data)
        asked = [WORDS[key].format(value) for key, value in made["accuracy"].items()]
        best, integrator = choice(data), choice(data, INTEGRATORS)
        for method in METHODS:
            k = choice(data, (method,))
            if k is None:
                k = _most_accurate(data, method)
            if k is None:
                continue
            of = data.isel(run=k)
            words = "cheapest that meets it" if k == best else ""
            if k == integrator != best:
                words = "cheapest integrator"
            used = made["tolerance"] if method == "taylor" else None
            row = {
                "scene": name,
                "asks": ", ".join(asked),
                "method": method,
                "setting": float(of.setting),
                "status": extract.meaning("run_status", of.run_status),
                "operations": float(of.operations) or np.nan,
                "meets it": extract.meaning("meets_accuracy", of.meets_accuracy),
                "choice": words,
                "tolerance in use": np.nan if used is None else used,
            }
            rows.append(row | (_averages(data, of) if "average" in data else _errors(of)))
    return pd.DataFrame(rows)


def _most_accurate(data, method):
    """Number of the run of a method with the least error, the first if none has one."""
    runs = np.flatnonzero(data["method"].values == method)
    if not len(runs):
        return None
    if "average" in data:
        away = data["average"].values[runs, 1] / data["reference_average"].values[1] - 1
    else:
        away = data["amplitude_error"].values[runs]
    return runs[np.argmin(np.where(np.isnan(away), np.inf, np.abs(away)))]


def _errors(of):
    return {
        "error of the state": float(of.state_error),
        "of contact times": float(of.contact_time_error),
        "of their number": float(of.contact_excess),
        "of max |Z1|": float(of.amplitude_error),
    }


def _averages(data, of):
    row = {}
    names = {"contact_rate": "contacts a period", "displacement": "mean max |Z1|"}
    for key, words in (names | {"exponent": "Lyapunov exponent"}).items():
        row[words] = float(of.average.sel(statistic=key))
        row[f"{words}, standard error"] = float(of.average_error.sel(statistic=key))
        row[f"{words}, reference"] = float(data.reference_average.sel(statistic=key))
    return row
