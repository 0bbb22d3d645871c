"""Names of methods and of errors in datasets, and titles of the methods."""

from chatterjee1995.methods.integrators import integrators, runs_of_accuracy

# Quantities whose errors the stage `accuracy` computes. STATISTICS are for chaotic motions.
ERRORS = ("amplitude", "state", "contact_time", "contacts")
STATISTICS = ("contact_rate", "displacement", "exponent")

MODELS = {
    "rigid": "rigid impacts",
    "rigid_mended": "rigid, corrected",
    "rigid_balance": "one term, (14)",
    "full_balance": "one term, (7)",
    "many_harmonics": "many harmonics",
    "shooting": "shooting",
}
START_HARMONICS = 15  # shooting and rigid impacts start from the balance with this highest harmonic

# Names of the lists of tolerances in the section `comparison` of the configuration.
TOLERANCE_KEYS = ("taylor", "merson", "scipy")


def method_in_words(label) -> str:
    """Return the title of the method with this label, or the label if it has no title."""
    if label in MODELS:
        return MODELS[label]
    if label in integrators():
        return integrators()[label].title
    if label in runs_of_accuracy():
        integrator, located = runs_of_accuracy()[label]
        return f"{integrator.title}, {'located' if located else 'kink'}"
    name, *orders = label.split("_")
    if name == "taylor" and len(orders) == 2:
        return "Taylor, orders {} and {}".format(*orders)
    return label


def colour_of(name) -> str:
    """Return the colour (C0, C1, ...) in which figures draw an integrator."""
    return f"C{list(integrators('accuracy')).index(name)}"
