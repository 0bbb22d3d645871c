"""Tables on failures of integrators: missed contacts and largest steps.

The contact frequency omega_c is the natural frequency of the two masses on the contact spring.
"""

import numpy as np
import pandas as pd

from chatterjee1995.methods.integrators import integrators
from chatterjee1995.methods.labels import method_in_words
from chatterjee1995.reading import datasets as extract

# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "missed_contacts": {
        "data": "data",
        "method": "method",
        "tolerance": "tolerance",
        "fixed steps": "fixed steps a cycle",
        "contacts": "contacts near grazing",
        "found": "found",
        "unseen": "passed unseen",
        "not reached": "not reached",
        "spurious": "spurious",
    },
    "stable_steps": {
        "data": "data",
        "method": "method",
        "within": "allowed relative error of max |Z1|",
        "r1": "contact stiffness r1",
        "h": "largest step h",
        "steps a period": "steps a cycle",
        "h omega_c": "h ωc, ωc the contact frequency",
        "slope of 1/h in r1": "slope of log 1/h over log r1",
        "its error": "standard error of the slope",
    },
}
# Column -> function that turns the text of a cell of the CSV file into the text shown in Markdown.
# In columns without a function, underscores become spaces.
CELLS = {"method": method_in_words}


def missed_contacts(datasets) -> pd.DataFrame:
    """Return the contacts that each method finds and misses near grazing, summed over all depths.

    The depth of a contact is the distance by which the motion would pass the wall if there were no
    wall. "Unseen" contacts were stepped over. "Not reached" means that the computed motion, because
    of its error, turns back before the wall. "Spurious" contacts do not exist in truth.
    """
    rows = []
    for name, data in datasets.get("missed_contacts", {}).items():
        contacts = int(extract.parameter(data, "passages")) * data.sizes["depth"]
        for method in data.integrator.values:
            for i, tolerance in enumerate(data.method_tolerance.values):
                of = data.sel(integrator=method).isel(method_tolerance=i)
                counts = of.passage_count.sum("depth")
                deep = data.depth.values[of.contacts_missed.values >= 0.5]
                fixed = integrators()[method].fixed
                rows.append(
                    {
                        "data": name,
                        "method": method,
                        "tolerance": np.nan if fixed else tolerance,
                        "fixed steps": int(data.fixed_steps[i]) if fixed else np.nan,
                        "median error of |Z2|": float(of.motion_error),
                        "contacts": contacts,
                        "found": int(counts.sel(contact_outcome="found")),
                        "unseen": int(counts.sel(contact_outcome="unseen")),
                        "not reached": int(counts.sel(contact_outcome="not_reached")),
                        "failed": int(counts.sel(contact_outcome="failed")),
                        "spurious": int(of.spurious_count.sum()),
                        "half missed to depth": deep.max() if len(deep) else np.nan,
                    }
                )
    return pd.DataFrame(rows)


def stable_steps(datasets) -> pd.DataFrame:
    """Return the largest step h of fixed-step methods for each accuracy and stiffness r1.

    With h and all smaller steps tested, the method keeps the accuracy.
    """
    rows = []
    for name, data in datasets.get("stable_steps", {}).items():
        for method in data.fixed_method.values:
            for accuracy in data.accuracy.values:
                of = data.sel(fixed_method=method, accuracy=accuracy)
                for r1 in data.contact_stiffness.values:
                    here = of.sel(contact_stiffness=r1)
                    scaled = float(here.stable_step * here.contact_frequency)
                    rows.append(
                        {
                            "data": name,
                            "method": method,
                            "within": accuracy,
                            "r1": r1,
                            "h": float(here.stable_step),
                            "steps a period": 2
                            * np.pi
                            / extract.parameter(data, "frequency")
                            / float(here.stable_step),
                            "h omega_c": scaled,
                            "linear limit of it": float(of.linear_limit),
                            "slope of 1/h in r1": float(of.step_slope),
                            "its error": float(of.step_slope_error),
                        }
                    )
    return pd.DataFrame(rows)
