"""Sections on the contact model, rigid walls, and methods compared on test cases (scenes)."""

from typing import ClassVar

from chatterjee1995.methods.labels import ERRORS, START_HARMONICS, STATISTICS, TOLERANCE_KEYS
from chatterjee1995.sections import system
from chatterjee1995.sections.records import Kind, Table, stage
from impact_damper.command.section import (
    Section,
    choice,
    count,
    increasing,
    number,
    points_of,
    problem,
    several,
)
from impact_damper.model import bounds

GEOMETRIC = system.range_of(number("end of a geometric grid", least=1e-14, most=1e9), points=True)
TOLERANCE = number("tolerance of a method", **bounds.METHOD_TOLERANCE_RANGE)
DECREASING = several(TOLERANCE, "decreasing tolerances", least=1)
COMPONENT = number("component of a state", least=-bounds.FARTHEST, most=bounds.FARTHEST)
ORDER = count("order of the series", least=6, most=60)


class ContactCells(Section):
    """Numbers of cells in the map of contacts, one key for each axis."""

    restitutions: points_of("cells of the map along restitution")
    loads: points_of("cells of the map along load")


class ContactModel(
    system.keys_of(system.DAMPER, needed=system.NEEDED, without=["restitution", system.COMMON]),
    system.WithOscillator,
):
    """A map of contacts over restitution and load, and contacts in simulated motions."""

    restitutions: several(system.RESTITUTION, "increasing restitutions of the motions", least=2)
    frequencies: several(system.FREQUENCY, "increasing frequencies of the motions", least=1)
    periods: count("forcing cycles over which contacts are logged", **bounds.PERIODS_RANGE)
    cells: ContactCells
    smallest_restitution: number(
        "smallest e of the map", **system.BOUNDS["restitution"] | {"most": 0.99}
    )
    largest_load: number(
        "largest load: acceleration divided by natural frequency and approach speed",
        above=0.0,
        most=1e3,
    )

    counts: ClassVar = ("cells.restitutions", "cells.loads")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        for key in ("restitutions", "frequencies"):
            yield from increasing((*path, key), getattr(self, key), "motions are run in order")

    @stage(
        "chatterjee1995.stages.contact_model:contact_model",
        "Contact model and contacts of motions, {name}",
    )
    def contact_model(self, config) -> dict:
        cells = self.cells
        values = {
            "frequencies": self.frequencies,
            "restitutions": {"linspace": [self.smallest_restitution, 1, cells.restitutions]},
            "loads": {"loads": [self.largest_load, cells.loads]},
            "used": self.restitutions,
            "starts": config.search.scan_starts,
            "periods": self.periods,
            "seed": config.seed,
        }
        damper = {"damper": {"Damper": system.damper_values(self, config)}}
        return self.system(config) | damper | values | config.settling.job()


class RigidCells(Section):
    """Numbers of cells in the map of errors for rigid walls, one key for each axis."""

    frequencies: points_of("cells of the map along frequency")
    stiffnesses: points_of("cells of the map along contact stiffness")


class RigidLimit(system.WithDamper):
    """The quiet motion with rigid walls, compared with the quiet motion with compliant walls."""

    frequency: system.FREQUENCY
    frequencies: system.FREQUENCIES
    stiffnesses: system.range_of(system.CONTACT_STIFFNESS)
    cells: RigidCells

    counts: ClassVar = ("cells.frequencies", "cells.stiffnesses")

    @stage(
        "chatterjee1995.stages.rigid_limit:rigid_limit",
        "Rigid impacts against compliant contact",
        together=True,
    )
    def rigid_limit(self, config) -> dict:
        values = {
            "frequency": self.frequency,
            "frequencies": self.frequencies.even(self.cells.frequencies),
            "stiffnesses": self.stiffnesses.geometric(self.cells.stiffnesses),
            "starts": config.search.scan_starts,
            "seed": config.seed,
        }
        return self.system(config) | values | config.settling.job()


class MissedContacts(system.WithOscillator):
    """Contacts that barely touch the wall (near grazing), found or missed by integrators."""

    frequency: system.FREQUENCY
    passages: count(
        "random flights without contact, each over one forcing cycle", **bounds.RUNS_RANGE
    )
    radius: system.RADIUS
    depths: GEOMETRIC
    tolerances: system.range_of(TOLERANCE, points=True)
    steps: system.range_of(count("steps in a forcing cycle", least=1, most=10**5))

    counts: ClassVar = ("passages", "depths.points", "tolerances.points")

    @stage(
        "chatterjee1995.methods.missed_contacts:missed_contacts",
        "Contacts near grazing that integrators miss, {name}",
        priority=1,
    )
    def missed_contacts(self, config) -> dict:
        values = system.given(self, ["frequency", "passages", "radius"]) | {
            "depths": self.depths.geometric(),
            "tolerances": self.tolerances.geometric(),
            "steps": {"counts": [self.steps.first, self.steps.last, self.tolerances.points]},
            "seed": config.seed,
        }
        return self.system(config) | values


class StableSteps(system.WithDamper):
    """The quiet motion computed by fixed-step methods, over contact stiffness and step."""

    frequency: system.FREQUENCY
    stiffnesses: system.range_of(system.CONTACT_STIFFNESS, points=True)
    scaled_steps: GEOMETRIC
    most_steps: count(
        "largest number of steps in a forcing cycle; cells with more are not run",
        least=1,
        most=10**7,
    )
    periods: system.RUN_PERIODS

    counts: ClassVar = ("stiffnesses.points", "scaled_steps.points")

    @stage(
        "chatterjee1995.methods.stable_steps:stable_steps",
        "Largest stable steps of fixed-step methods, {name}",
    )
    def stable_steps(self, config) -> dict:
        values = system.given(self, ["frequency", "most_steps", "periods"]) | {
            "stiffnesses": self.stiffnesses.geometric(),
            "scaled_steps": self.scaled_steps.geometric(),
        }
        return self.system(config) | values


class Accuracy(Section):
    """The accuracy required on a scene: a quantity, and its largest acceptable error."""

    quantity: choice("quantity whose error is judged", *ERRORS, *STATISTICS)
    within: number("largest error accepted, 0 for a number of contacts", least=0, most=1)


class Scene(system.MaybeWithDamper):
    """Motions for which the errors and the work of integrators and models are compared."""

    frequency: system.FREQUENCY
    state: several(COMPONENT, "Z1, Z1', Z2, Z2' at the start, W T = pi/2", least=4, most=4)
    periods: system.RUN_PERIODS
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

    @stage(
        "chatterjee1995.methods.accuracy:accuracy",
        "Errors of methods against counted work, {name}",
        name="accuracy",
        files={"references": "workflow/resources/references.json"},
        priority=1,
    )
    def job(self, config) -> dict:
        values = system.given(self, ["frequency", "state", "periods", "motion"])
        settings = {"settings": config.comparison.model_dump(), "accuracy": dict(self.accuracy)}
        return self.system(config) | values | settings


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
        **bounds.HARMONIC_RANGE | {"least": START_HARMONICS},
    )
    batch: count(
        "forcing cycles of a batch, a part of a chaotic run (errors follow from the scatter of the "
        "averages of batches)",
        least=1,
        most=100000,
    )
    scipy_periods: count(
        "forcing cycles of a chaotic run by SciPy's methods, at least two batches",
        **bounds.PERIODS_RANGE | {"least": 2},
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


SECTIONS = {
    "contact_model": ContactModel,
    "rigid_limit": RigidLimit,
    "missed_contacts": MissedContacts,
    "stable_steps": StableSteps,
    "scenes": Scene,
}
KINDS = (
    Kind("contact_model", "methods", "contact_model", ("contact_model",)),
    Kind("rigid_limit", "methods", "rigid_limit", ("rigid_limit",)),
    Kind("missed_contacts", "methods", "failures", ("missed_contacts",), most=1),
    Kind("stable_steps", "methods", "failures", ("stable_steps",)),
    Kind("accuracy", "methods", "accuracy", ("accuracy",)),
)
TABLES = (
    Table("contact_model", "methods", "contact", ("contact_model",)),
    Table("rigid_limit", "methods", "contact", ("rigid_limit",)),
    Table("missed_contacts", "methods", "methods", ("missed_contacts",)),
    Table("stable_steps", "methods", "methods", ("stable_steps",)),
    Table("models", "methods", "methods", ("accuracy",)),
)
