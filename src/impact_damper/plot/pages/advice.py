"""The head of the page of a machine: advice in a few words, with reasons.

A design chooses a gap and promises a share of starts (random initial states) that lead to quiet
motions, which are below a displacement limit. It tests the promise with new starts.
"""

import json

from impact_damper.data.datasets import named

# Advice for each kind of choice that the design makes.
ADVICE = {
    "robust": "Build it",
    "needs_tolerance": "Build it, and hold the gap more closely than your tolerance",
    "least_worst": "Do not build it for this band",
}


def advice(data) -> str:
    """Return the advice on whether to build the damper; `data` is the dataset of `design_damper`.

    The advice depends on the choice of the gap, on the promise (a share of starts that lead to
    quiet motions, tested with new starts), and on whether the largest motion exceeds the limit.
    """
    if named(data, "promise") == "broken":
        return "Do not build it: the check failed"
    choice = named(data, "design_choice")
    if choice == "robust" and named(data, "promise") == "nominal_kept":
        return "Build it, and hold all values more closely than your tolerances"
    larger = float(data["reached_displacement"].max()) > float(data["displacement_limit"])
    if choice != "least_worst" and larger:
        return f"{ADVICE[choice]}, and beware: a large motion exists in addition to the quiet one"
    return ADVICE[choice]


def reasons(data) -> list[str]:
    """Return the sentences of the conclusion that the design wrote into its dataset."""
    return json.loads(data.attrs["conclusion"])
