"""The integrators that are compared: what they are called, and which stage compares which.

Figures, tables and the check of the configuration read this module, so its top imports no kernels;
`integrators` does. To add an integrator, write it in a module of this room (a subclass of
`runs.Integrator`), describe it in `METHODS`, make it in `integrators`, and name it in `COMPARED`.
"""

from typing import NamedTuple

from impact_damper.system.bounds import PERIODS_RANGE


class Method(NamedTuple):
    """An integrator as figures, tables and settings refer to it.

    Attributes
    ----------
    title : str
    colour : str
        Colour of matplotlib's cycle, if the stage `accuracy` compares the integrator.
    tolerances : str
        Key, in the section `comparison` of the configuration, of the tolerances with which the
        stage `accuracy` runs the integrator.
    fixed : bool
        Whether the stages set the number of steps in a forcing period in place of a tolerance.
    slow : bool
        Whether runs are given up after a number of evaluations of the rate, and fewer tolerances
        and, for chaotic motions, fewer periods are run.
    implicit : bool
        Whether the stage `missed_contacts` runs only the first `implicit_passages` passages.
    """

    title: str
    colour: str = ""
    tolerances: str = ""
    fixed: bool = False
    slow: bool = False
    implicit: bool = False


METHODS = {
    "taylor": Method("Taylor series", "C0", "taylor"),
    "heun": Method("Heun", fixed=True),
    "verlet": Method("velocity Verlet", fixed=True),
    "runge_kutta_4": Method("Runge-Kutta 4", fixed=True),
    "merson": Method("Merson", "C1", "merson"),
    "RK45": Method("RK45", slow=True),
    "DOP853": Method("DOP853", "C2", "scipy", slow=True),
    "LSODA": Method("LSODA", "C3", "scipy", slow=True),
    "Radau": Method("Radau", "C4", "scipy", slow=True, implicit=True),
}

# Labels of the datasets of each stage, in their order (see `name_and_mode`). All integrators in
# `stable_steps` take fixed steps.
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

# Stage `method_verdicts` looks for the period of a run. LAST: how many of the last states, one for
# each forcing period, must repeat. LONGEST_PERIOD: longest period looked for.
# VERDICT_PERIODS_RANGE: forcing periods of a run, enough for this.
LAST, LONGEST_PERIOD = 6, 6
VERDICT_PERIODS_RANGE = PERIODS_RANGE | {"least": LAST + LONGEST_PERIOD}

# Stage `accuracy`: quantities whose errors are compared for a motion that integrators can follow to
# its end, and averages that are compared for a chaotic motion.
ERRORS = ("amplitude", "state", "contact_time", "contacts")
STATISTICS = ("contact_rate", "displacement", "exponent")

# Models of a steady motion, which the stage `accuracy` compares with the integrators.
ORBIT_MODELS = (
    "rigid",
    "rigid_mended",
    "rigid_balance",
    "full_balance",
    "many_harmonics",
    "shooting",
)

# Highest harmonic of the harmonic balance whose solution is the first guess of the models
# "shooting", "rigid" and "rigid_mended".
START_HARMONICS = 15

# Keys in the section `comparison` of the configuration. TOLERANCE_KEYS: of lists of tolerances.
# LIMITED: of `evaluations`, the number of evaluations after which a run of each is given up.
TOLERANCE_KEYS = tuple(
    dict.fromkeys(each.tolerances for each in METHODS.values() if each.tolerances)
)
LIMITED = tuple(name for name, each in METHODS.items() if each.tolerances and each.slow)


def name_and_mode(label):
    """Return the name in `METHODS` that a label contains, and whether contacts are located.

    A label is a name followed by "_located" if the integrator locates the beginnings and ends of
    contacts. If it does not, but integrates through the kinks of the force, the name is followed by
    "_kink" or by nothing. The Taylor series always locates contacts.
    """
    name = label.removesuffix("_located").removesuffix("_kink")
    return name, label.endswith("_located") or name == "taylor"


def title_with_mode(label):
    """Return the title for a label, with its treatment of contacts: "Merson, located"."""
    name, located = name_and_mode(label)
    method = METHODS[name]
    if method.fixed or name == "taylor":
        return method.title
    return f"{method.title}, {'located' if located else 'kink'}"


def integrators():
    """Return a dictionary from the names in `METHODS` to instances of `runs.Integrator`."""
    from impact_damper.rivals.fixed_step import FixedStep
    from impact_damper.rivals.merson import Merson
    from impact_damper.rivals.scipy_methods import SciPy
    from impact_damper.rivals.taylor_runs import Taylor

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
