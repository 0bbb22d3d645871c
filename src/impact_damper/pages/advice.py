"""The head of a page: advice in a few words, with reasons."""

import json

from impact_damper.tables.machines import named

ADVICE = {
    "robust": "Build it",
    "needs_tolerance": "Build it, and hold the gap more closely than your tolerance",
    "least_worst": "Do not build it for this band",
}


def advice(data) -> str:
    """Return the advice on whether to build the damper."""
    if named(data, "promise") == "broken":
        return "Do not build it: the check failed"
    choice = named(data, "design_choice")
    if choice == "robust" and named(data, "promise") == "nominal_kept":
        return "Build it, and hold all values more closely than your tolerances"
    larger = float(data["reached_displacement"].max()) > float(data["displacement_limit"])
    if choice != "least_worst" and larger:
        return f"{ADVICE[choice]}, and beware of a large motion beside the quiet one"
    return ADVICE[choice]


def reasons(data) -> list[str]:
    """Return the conclusion of the design."""
    return json.loads(data.attrs["conclusion"])
