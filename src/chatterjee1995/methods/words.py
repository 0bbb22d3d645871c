"""Titles of test cases, models and integrators, for figures and tables."""

from chatterjee1995.methods.methods import METHODS, name_and_mode, title_with_mode

# Test cases of the stage `method_verdicts`. A case that the user adds keeps its name.
CASES = {
    "quiet": "quiet motion, elastic",
    "quiet_inelastic": "quiet motion, inelastic",
    "quiet_fold_before": "quiet motion near its end",
    "quiet_fold_after": "beyond the quiet motion's end",
    "symmetry_breaking_before": "before a loss of symmetry",
    "symmetry_breaking_after": "beyond a loss of symmetry",
    "basin_resonance": "free, attracted to resonance",
    "basin_not_non_resonance": "free, not to the small motion",
    "free_fold_before": "free resonance near its end",
    "free_fold_after": "beyond the resonance's end",
    "subharmonic": "free one-third subharmonic",
}
# Models that solve for a periodic motion directly (`methods.ORBIT_MODELS`).
MODELS = {
    "rigid": "rigid impacts",
    "rigid_mended": "rigid, corrected",
    "rigid_balance": "one term, (14)",
    "full_balance": "one term, (7)",
    "many_harmonics": "many harmonics",
    "shooting": "shooting",
}


def method_in_words(label) -> str:
    """Return the title of a model or of an integrator; an unknown label is returned unchanged.

    If the label of an integrator contains the treatment of contacts ("_located", "_kink") or the
    orders of the Taylor series, the title does too.
    """
    if label in MODELS:
        return MODELS[label]
    name, *orders = label.split("_") if label.startswith("taylor_") else (label,)
    if orders:
        return "Taylor, orders {} and {}".format(*orders)
    if label in METHODS:
        return METHODS[label].title
    return title_with_mode(label) if name_and_mode(label)[0] in METHODS else label
