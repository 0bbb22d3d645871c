"""Methods compared on test cases (scenes) with references: scenes and settings."""

from chatterjee1995.methods.labels import ERRORS, START_HARMONICS, STATISTICS, TOLERANCE_KEYS
from chatterjee1995.workflow.models.system import (
    FREQUENCY,
    RUN_PERIODS,
    MaybeWithDamper,
)
from impact_damper.command.messages import problem
from impact_damper.command.section import Section
from impact_damper.command.values import choice, count, number, several
from impact_damper.model.bounds import (
    FARTHEST,
    HARMONIC_RANGE,
    METHOD_TOLERANCE_RANGE,
    PERIODS_RANGE,
)

COMPONENT = number("component of a state", least=-FARTHEST, most=FARTHEST)
DECREASING = several(
    number("tolerance of a method", **METHOD_TOLERANCE_RANGE), "decreasing tolerances", least=1
)
ORDER = count("order of the series", least=6, most=60)


def state(meaning):
    """Return the type of a state: displacement and velocity of Z1 and Z2."""
    return several(COMPONENT, f"Z1, Z1', Z2, Z2': {meaning}", least=4, most=4)


class Accuracy(Section):
    """The accuracy required on a scene: a quantity, and its largest acceptable error."""

    quantity: choice("quantity whose error is judged", *ERRORS, *STATISTICS)
    within: number("largest error accepted, 0 for a number of contacts", least=0, most=1)


class Scene(MaybeWithDamper):
    """Motions on which the errors and the work of methods and models are compared."""

    frequency: FREQUENCY
    state: state("first state, at W T = pi/2")
    periods: RUN_PERIODS
    motion: choice(
        "steady (a periodic orbit with the period of the forcing), transient or chaotic",
        "steady",
        "transient",
        "chaotic",
    )
    accuracy: Accuracy

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        chaotic, batch = self.motion == "chaotic", config.comparison.batch
        if chaotic and not self.has_damper():
            reason = "must have a damper (free motions are not chaotic here)"
            yield problem((*path, "motion"), self.motion, reason)
        if chaotic and self.periods < 2 * batch:
            reason = f"must be at least twice comparison.batch = {batch} (errors need two batches)"
            yield problem((*path, "periods"), self.periods, reason)
        if chaotic != (self.accuracy.quantity in STATISTICS):
            reason = f"must be another quantity (the motion is {self.motion})"
            yield problem((*path, "accuracy", "quantity"), self.accuracy.quantity, reason)


class Comparison(Section):
    """Settings of the methods that are compared on the scenes."""

    taylor: DECREASING
    merson: DECREASING
    scipy: DECREASING
    orders: several(
        several(ORDER, "in flight and in contact", least=2, most=2),
        "orders of the Taylor series in flight and in contact, compared with the package's own",
        distinct=True,
    )
    evaluations: count(
        "evaluations of the equations of motion per forcing cycle after which a run of SciPy's "
        "methods is given up",
        least=1,
        most=1000000,
    )
    harmonics: count(
        "highest harmonic (Newton's method for the exact orbit begins with "
        f"{START_HARMONICS} harmonics)",
        **HARMONIC_RANGE | {"least": START_HARMONICS},
    )
    batch: count(
        "forcing cycles of a batch, a part of a chaotic run (errors follow from the scatter of the "
        "averages of batches)",
        least=1,
        most=100000,
    )
    scipy_periods: count(
        "forcing cycles of a chaotic run by SciPy's methods, at least two batches",
        **PERIODS_RANGE | {"least": 2},
    )

    def contradictions(self, path, config):
        for key in TOLERANCE_KEYS:
            values = getattr(self, key)
            if sorted(set(values), reverse=True) != values:
                reason = "must decrease (each is run once, the loosest first)"
                yield problem((*path, key), values, reason)
        if self.scipy_periods < 2 * self.batch:
            reason = f"must be at least twice batch = {self.batch} (errors need two batches)"
            yield problem((*path, "scipy_periods"), self.scipy_periods, reason)


SECTIONS = {"scenes": Scene}
