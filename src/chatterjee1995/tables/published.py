"""Table of numbers computed by this package (ours), published numbers and closed forms."""

import numpy as np
import pandas as pd

from chatterjee1995.claims import extract
from impact_damper.data.datasets import parameters_of

SOURCES = {
    "masri caughey": "Masri and Caughey, J. Appl. Mech. 33(3), 586, 1966",
    "slow manifold": "Gendelman, J. Sound Vib. 331(21), 4599, 2012; Gourc, Michon, Seguy and "
    "Berlioz, J. Vib. Acoust. 137(3), 031008, 2015",
    "den hartog": "Den Hartog, Mechanical Vibrations, 4th ed., section 3.3, 1956",
    "nishihara asami": "Nishihara and Asami, J. Vib. Acoust. 124(4), 576, 2002",
    "habib": "Habib, Detroux, Viguie and Kerschen, Mech. Syst. Signal Process. 52-53, 17, 2015",
    "bstab": "Stender and Hoffmann, Nonlinear Dyn. 107, 1451, 2022; shares by pybasin",
    "brennan": "Brennan, Kovacic, Carrella and Waters, J. Sound Vib. 318(4-5), 1250, 2008",
    "hertz": "Johnson, Contact Mechanics, section 11.4, 1985",
}
# For each reason why the two numbers differ: which one is right, and the evidence.
REASONS = {
    "contact stiffness": "Both are right: their walls are rigid, ours have r1 = {stiffness:g}. The "
    "difference falls as r1^{order:.2f}; ours extrapolated to rigid walls differs by {limit:.0e}.",
    "mass ratio": "The exact motion is right: the closed form is of first order in rm, and the "
    "difference falls as rm^{order:.2f}.",
    "first mass ratio": "The exact motion is right: the closed form is of first order in rm. This "
    "row has the largest rm of the comparison.",
    "fixed points": "The computed peak is right: the closed form is the height of the two points "
    "that the response passes for any damping, and peaks are higher.",
    "direct search": "The closed form is right: a direct search comes as close to it as its "
    "tolerance.",
    "first order": "The computed peaks are right, since motions integrated by SciPy have the same "
    "peaks; the closed form makes them equal to first order in the cubic force only.",
    "random starts": "Both are right: they are shares of two random samples and differ by "
    "{sigma:+.1f} standard errors. 95 % confidence interval of ours: {low:.4f} to {high:.4f}.",
    "one harmonic": "The fold of the branch of exact orbits is right: the closed form keeps one "
    "harmonic, and its formula for the jump from the small to the large motion neglects damping.",
    "linear contact": "Hertz is right for elastic bodies: our contact is the linear spring that "
    "stores the same energy at the same compression, with 4/5 of the force and 6.7 % more time.",
}


# Columns of the Markdown tables with their heads; the CSV files have all columns.
SHOWN = {
    "published": {
        "source": "source",
        "quantity": "quantity",
        "published or closed form": "published or closed form",
        "ours": "ours",
        "difference": "relative difference",
        "explanation": "explanation",
    },
}


def published(datasets) -> pd.DataFrame:
    """Return for each comparison both numbers, their difference and its explanation."""
    rows = []
    for data in datasets.get("published", {}).values():
        for k in range(data.sizes["comparison"]):
            rows.append(_row(data.isel(comparison=k), parameters_of(data)["settings"]))
    return pd.DataFrame(rows)


def _row(each, settings):
    """Return the row of one comparison; `settings` are the settings of all comparisons."""
    theirs, ours = float(each.published_value), float(each.our_value)
    return {
        "source": SOURCES[extract.meaning("publication", int(each.publication))],
        "quantity": str(each.comparison.values),
        "published or closed form": theirs,
        "ours": ours,
        "difference": ours / theirs - 1,
        "explanation": _explanation(each, theirs, ours, settings),
    }


def _explanation(each, theirs, ours, settings):
    """Return the sentence of REASONS on why two numbers differ, with its numbers filled in."""
    reason = extract.meaning("difference_reason", int(each.difference_reason))
    order, error = float(each.difference_order), float(each.difference_error)
    words = {"order": order}
    if reason == "contact stiffness":
        words["stiffness"] = settings["rigid_walls"]["stiffnesses"][-1]
        words["limit"] = float(each.limit_value) / theirs - 1
    elif reason == "mass ratio" and np.isnan(order):
        reason = "first mass ratio"
    elif reason == "random starts":
        half = 1.96 * np.sqrt(ours * (1 - ours) / settings["basin_shares"]["starts"])
        words |= {"sigma": (ours - theirs) / error, "low": ours - half, "high": ours + half}
    return REASONS[reason].format(**words)
