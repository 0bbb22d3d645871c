"""Tables on failures of integrators: missed contacts, largest steps, verdicts on motions.

A verdict is right if the motion that an integrator computes is the motion that exists in truth. The
contact frequency omega_c is the natural frequency of the two masses on the contact spring.
"""

import numpy as np
import pandas as pd

from chatterjee1995.claims import extract
from chatterjee1995.methods.methods import COMPARED, METHODS, name_and_mode, title_with_mode
from chatterjee1995.methods.words import CASES, method_in_words
from impact_damper.data.datasets import flag
from impact_damper.data.shares import missed_share
from impact_damper.data.table_files import in_words


def _setting(label):
    """Return the name of a method's setting; `label` is the method with its mode of use."""
    return "steps a cycle" if METHODS[name_and_mode(label)[0]].fixed else "tolerance"


# Number of integrators, the first of `COMPARED`, that the Markdown table `method_verdicts` shows.
SHOWN_METHODS = 8
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
    "method_verdicts": {"scene": "scene"}
    | {
        label: f"{title_with_mode(label)} [{_setting(label)}]"
        for label in COMPARED["method_verdicts"][:SHOWN_METHODS]
    },
}
# Column -> function that turns the text of a cell of the CSV file into the text shown in Markdown.
# In columns without a function, underscores become spaces.
CELLS = {"method": method_in_words, "scene": lambda cell: CASES.get(cell, in_words(cell))}


def missed_contacts(datasets) -> pd.DataFrame:
    """Return the contacts that each method finds and misses near grazing, summed over all depths.

    The depth of a contact is the distance by which the motion would pass the wall if there were no
    wall. "Unseen" contacts were stepped over. "Not reached" means that the computed motion, because
    of its error, turns back before the wall. "Spurious" contacts do not exist in truth.
    """
    rows = []
    for name, data in datasets.get("missed_contacts", {}).items():
        contacts = data.passages * data.sizes["depth"]
        for method in data.integrator.values:
            for i, tolerance in enumerate(data.method_tolerance.values):
                of = data.sel(integrator=method).isel(method_tolerance=i)
                counts = of.passage_count.sum("depth")
                missed = missed_share(of)
                deep = data.depth.values[missed.values >= 0.5]
                fixed = METHODS[method].fixed
                rows.append(
                    {
                        "data": name,
                        "method": method,
                        "tolerance": np.nan if fixed else tolerance,
                        "fixed steps": int(data.fixed_steps[i]) if fixed else np.nan,
                        "mean steps a period": float(of.mean_steps),
                        "median error of |Z2|": float(of.motion_error),
                        "contacts": int(contacts.sel(integrator=method)),
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
                            "largest h omega_c that keeps the accuracy": float(
                                here.largest_holding_step * here.contact_frequency
                            ),
                            "slope of 1/h in r1": float(of.step_slope),
                            "its error": float(of.step_slope_error),
                        }
                    )
    return pd.DataFrame(rows)


def method_verdicts(datasets) -> pd.DataFrame:
    """Return the loosest tolerance, or fewest steps, from which on each method's verdict is right.

    The table has one row for each test case (scene): a motion near an orbit of known stability. If
    a method has no such tolerance, the cell says why: the method was not run on the scene, was
    never right, or was right, but not at the strictest tolerance.
    """
    rows = []
    for data in datasets.get("method_verdicts", {}).values():
        for scene in data.scene.values:
            of = data.sel(scene=scene)
            rows.append(
                {
                    "scene": str(scene),
                    "W": float(of.scene_frequency),
                    "period": int(of.scene_period),
                    "multiplier": float(of.scene_multiplier),
                    "truth": extract.meaning("scene_truth", of.scene_truth),
                    "comes to period": int(of.landing_period),
                    "periods run": int(of.scene_periods),
                }
                | {
                    str(method): _right_from(of.sel(verdict_method=method))
                    for method in data.verdict_method.values
                }
            )
    return pd.DataFrame(rows)


def _right_from(data):
    """Return the entry of `method_verdicts` for one method on one scene."""
    if np.isfinite(data.right_from):
        return float(data.right_from)
    if (data.verdict == flag("verdict", "not_run")).all():
        return "not run"
    right = (data.verdict == flag("verdict", "right")).any()
    return "not at the strictest" if right else "never right"
