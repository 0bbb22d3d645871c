"""The integrators that are compared: their names, and the stages that compare them.

A stage is a step of the workflow. Figures, tables and the check of the configuration read this
module. Importing it must be fast, so only the function `integrators` imports compiled functions. To
add an integrator, write a subclass of `runs.Integrator` in a module of this subpackage, describe it
in `METHODS`, create an instance in `integrators`, and name it in `COMPARED`.
"""

from typing import NamedTuple

from impact_damper.model.bounds import PERIODS_RANGE


class Method(NamedTuple):
    """An integrator as figures, tables and settings refer to it.

    Attributes
    ----------
    title : str
    tolerances : str
        Key in the section `comparison` of the configuration. Its value is the list of tolerances
        with which the stage `accuracy` runs the integrator.
    fixed : bool
        Whether the stages set the number of steps in a forcing cycle in place of a tolerance.
    slow : bool
        Whether runs stop after a number of evaluations of the rate (the time derivative of the
        state). A slow integrator is run with fewer tolerances and, for chaotic motions, over fewer
        cycles.
    implicit : bool
        Whether the integrator is an implicit one. Because such an integrator is slow, the stage
        `missed_contacts` runs it only on the first `implicit_passages` of its test cases, which are
        random flights without contact (`passages`).
    """

    title: str
    tolerances: str = ""
    fixed: bool = False
    slow: bool = False
    implicit: bool = False


METHODS = {
    "taylor": Method("Taylor series", "taylor"),
    "heun": Method("Heun", fixed=True),
    "verlet": Method("velocity Verlet", fixed=True),
    "runge_kutta_4": Method("Runge-Kutta 4", fixed=True),
    "merson": Method("Merson", "merson"),
    "RK45": Method("RK45", slow=True),
    "DOP853": Method("DOP853", "scipy", slow=True),
    "LSODA": Method("LSODA", "scipy", slow=True),
    "Radau": Method("Radau", "scipy", slow=True, implicit=True),
}

# Labels of the integrators in the datasets of each stage, in their order. `name_and_mode` explains
# the labels. All integrators of the stage `stable_steps` take fixed steps.
COMPARED = {
    "accuracy": (
        "taylor",
        "merson_kink",
        "merson_located",
        "DOP853_kink",
        "DOP853_located",
        "LSODA_kink",
        "LSODA_located",
        "Radau_kink",
        "Radau_located",
    ),
    "missed_contacts": ("taylor", "runge_kutta_4", "merson", "RK45", "DOP853", "LSODA", "Radau"),
    "stable_steps": ("heun", "verlet", "runge_kutta_4", "merson"),
    "method_verdicts": (
        "taylor",
        "heun",
        "verlet",
        "runge_kutta_4",
        "merson",
        "merson_located",
        "LSODA",
        "DOP853_located",
    ),
}

# The stage `method_verdicts` determines the period of a run from the states at the ends of its last
# forcing cycles.
# LAST: number of states at the end that must equal the states a period before.
# LONGEST_PERIOD: longest period that is tested, in forcing cycles.
# VERDICT_PERIODS_RANGE: allowed numbers of forcing cycles of a run; the least is what the test
#     needs.
LAST, LONGEST_PERIOD = 6, 6
VERDICT_PERIODS_RANGE = PERIODS_RANGE | {"least": LAST + LONGEST_PERIOD}

# The stage `accuracy` compares the errors of the quantities ERRORS for a motion that is not
# chaotic, and the averages STATISTICS for a chaotic motion.
ERRORS = ("amplitude", "state", "contact_time", "contacts")
STATISTICS = ("contact_rate", "displacement", "exponent")

# Models of a steady motion (`orbit_models`), which the stage `accuracy` compares with the
# integrators.
ORBIT_MODELS = (
    "rigid",
    "rigid_mended",
    "rigid_balance",
    "full_balance",
    "many_harmonics",
    "shooting",
)

# The first guess of the models "shooting", "rigid" and "rigid_mended" is the solution of the
# harmonic balance with this highest harmonic.
START_HARMONICS = 15

# Keys in the section `comparison` of the configuration.
# TOLERANCE_KEYS: keys whose values are lists of tolerances.
# LIMITED: keys of its entry `evaluations`, which holds the largest number of evaluations in a run
#     of each of these integrators.
TOLERANCE_KEYS = tuple(
    dict.fromkeys(each.tolerances for each in METHODS.values() if each.tolerances)
)
LIMITED = tuple(name for name, each in METHODS.items() if each.tolerances and each.slow)


def name_and_mode(label):
    """Return the name in `METHODS` that a label contains, and whether contacts are located.

    A label is a name followed by "_located" if the integrator locates the beginnings and ends of
    contacts. It is a name alone, or followed by "_kink", if the integrator does not locate them and
    steps across the kinks of the force. The Taylor series always locates contacts.
    """
    name = label.removesuffix("_located").removesuffix("_kink")
    return name, label.endswith("_located") or name == "taylor"


def colour_of(name):
    """Return the colour of matplotlib's colour cycle for a name that `accuracy` compares."""
    names = list(dict.fromkeys(name_and_mode(label)[0] for label in COMPARED["accuracy"]))
    return f"C{names.index(name)}"


def title_with_mode(label):
    """Return the title for a label, with the treatment of contacts, such as "Merson, located".

    The treatment is left out for integrators that have only one.
    """
    name, located = name_and_mode(label)
    method = METHODS[name]
    if method.fixed or name == "taylor":
        return method.title
    return f"{method.title}, {'located' if located else 'kink'}"


def integrators():
    """Return a dictionary from the names in `METHODS` to instances of `runs.Integrator`."""
    from chatterjee1995.methods.fixed_step import FixedStep
    from chatterjee1995.methods.merson import Merson
    from chatterjee1995.methods.scipy_methods import SciPy
    from chatterjee1995.methods.taylor_runs import Taylor

    return {
        "taylor": Taylor(),
        "heun": FixedStep("heun"),
        "verlet": FixedStep("verlet"),
        "runge_kutta_4": FixedStep("runge_kutta_4"),
        "merson": Merson(),
        "RK45": SciPy("RK45"),
        "DOP853": SciPy("DOP853"),
        "LSODA": SciPy("LSODA"),
        "Radau": SciPy("Radau"),
    }
