"""Tables that compare integrators and models: accuracy, missed contacts and largest steps."""

import numpy as np
import pandas as pd

from chatterjee1995.methods.integrators import integrators, runs_of_accuracy
from chatterjee1995.methods.labels import MODELS, method_in_words
from chatterjee1995.reading import datasets as reading
from impact_damper.data.datasets import decode, parameters_of

# Quantity -> words for the required accuracy. `{:g}` is replaced by the allowed error.
WORDS = {
    "amplitude": "max |Z1|, relative error {:g}",
    "state": "state, error {:g}",
    "contact_time": "contact times, error {:g}",
    "contacts": "number of contacts, error {:g}",
    "contact_rate": "contacts a cycle, relative error {:g}",
    "displacement": "mean max |Z1|, relative error {:g}",
    "exponent": "Lyapunov exponent, relative error {:g}",
}


def models(datasets) -> pd.DataFrame:
    """Return a table with one run of each method on each scene.

    The run is the cheapest with the required accuracy; without such a run, the most accurate.
    """
    rows = []
    for name, data in datasets.get("accuracy", {}).items():
        asked = parameters_of(data)["accuracy"]
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
            choice = "cheapest that is accurate enough" if k == best else ""
            if k == integrator != best:
                choice = "cheapest integrator"
            of = data.isel(run=k)
            errors = _averages(data, of) if "average" in data else _errors(of)
            rows.append(
                {
                    "scene": name,
                    "required accuracy": WORDS[asked["quantity"]].format(asked["within"]),
                    "method": method_in_words(method),
                    "tolerance or highest harmonic": float(of.setting),
                    "work [floating-point operations]": float(of.operations) or np.nan,
                    "meets the required accuracy": reading.meaning(of.meets_accuracy),
                    "choice": choice,
                    "error of max |Z1|": np.nan,
                    "contacts a cycle": np.nan,
                    "status": reading.meaning(of.run_status),
                }
                | errors
            )
    return pd.DataFrame(rows)


def cheapest(data, labels):
    """Return the index of the cheapest run with the required accuracy, or None if there is none.

    Only runs of the methods `labels` count.
    """
    meets = decode(data["meets_accuracy"]).values == "yes"
    meets &= np.isin(data["method"].values, labels)
    work = np.where(meets, data["operations"].values, np.inf)
    return int(np.argmin(work)) if meets.any() else None


def _most_accurate(data, method):
    runs = np.flatnonzero(data["method"].values == method)
    if not len(runs):
        return None
    if "average" in data:
        away = data["average"].values[runs, 0] / data["reference_average"].values[0] - 1
    else:
        away = data["amplitude_error"].values[runs]
    return runs[np.argmin(np.where(np.isnan(away), np.inf, np.abs(away)))]


def _errors(of):
    return {
        "error of max |Z1|": float(of.amplitude_error),
        "error of the state": float(of.state_error),
        "error of contact times": float(of.contact_time_error),
        "error of their number": float(of.contact_excess),
    }


def _averages(data, of):
    row = {}
    heads = {"contact_rate": "contacts a cycle", "displacement": "mean max |Z1|"}
    for key, head in (heads | {"exponent": "Lyapunov exponent"}).items():
        row[head] = float(of.average.sel(statistic=key))
        row[f"{head}, standard error"] = float(of.average_error.sel(statistic=key))
        row[f"{head}, reference"] = float(data.reference_average.sel(statistic=key))
    return row


def missed_contacts(datasets) -> pd.DataFrame:
    """Return a table: how many shallow contacts an integrator finds, and how many it misses."""
    rows = []
    for name, data in datasets.get("missed_contacts", {}).items():
        contacts = int(reading.parameter(data, "passages")) * data.sizes["depth"]
        for method in data.integrator.values:
            fixed = integrators()[method].fixed
            for i, tolerance in enumerate(data.method_tolerance.values):
                of = data.sel(integrator=method).isel(method_tolerance=i)
                counts = of.passage_count.sum("depth")
                deep = data.depth.values[of.contacts_missed.values >= 0.5]
                rows.append(
                    {
                        "data": name,
                        "method": method_in_words(method),
                        "tolerance": np.nan if fixed else tolerance,
                        "fixed steps a cycle": int(data.fixed_steps[i]) if fixed else np.nan,
                        "contacts near grazing": contacts,
                        "found": int(counts.sel(contact_outcome="found")),
                        "passed unseen": int(counts.sel(contact_outcome="unseen")),
                        "not reached": int(counts.sel(contact_outcome="not_reached")),
                        "spurious": int(of.spurious_count.sum()),
                        "failed": int(counts.sel(contact_outcome="failed")),
                        "half missed to depth": deep.max() if len(deep) else np.nan,
                        "median error of |Z2|": float(of.motion_error),
                    }
                )
    return pd.DataFrame(rows)


def stable_steps(datasets) -> pd.DataFrame:
    """Return a table of the largest accurate time step, for each method and contact stiffness."""
    rows = []
    for name, data in datasets.get("stable_steps", {}).items():
        cycle = 2 * np.pi / reading.parameter(data, "frequency")
        dims = ("fixed_method", "accuracy", "contact_stiffness")
        for place in np.ndindex(*(data.sizes[dim] for dim in dims)):
            of = data.isel(dict(zip(dims, place, strict=True)))
            step = float(of.stable_step)
            rows.append(
                {
                    "data": name,
                    "method": method_in_words(str(of.fixed_method.values)),
                    "allowed relative error of max |Z1|": float(of.accuracy),
                    "contact stiffness r1": float(of.contact_stiffness),
                    "largest step h": step,
                    "steps a cycle": cycle / step,
                    "h ωc, ωc the contact frequency": float(of.stable_step * of.contact_frequency),
                    "slope of log 1/h over log r1": float(of.step_slope),
                    "standard error of the slope": float(of.step_slope_error),
                    "linear limit of h ωc": float(of.linear_limit),
                }
            )
    return pd.DataFrame(rows)
