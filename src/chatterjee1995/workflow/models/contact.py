"""The contact: its model, the limit of rigid walls, and failures of integrators at contacts.

The load on a contact is the acceleration that all forces except the contact force cause.
"""

from typing import ClassVar

from chatterjee1995.workflow.models.settings import RADIUS
from chatterjee1995.workflow.models.system import (
    BOUNDS,
    COMMON,
    CONTACT_STIFFNESS,
    DAMPER,
    FREQUENCIES,
    FREQUENCY,
    NEEDED,
    RESTITUTION,
    RUN_PERIODS,
    WithDamper,
    WithOscillator,
    keys_of,
    points_of,
    range_of,
)
from impact_damper.command.messages import problem
from impact_damper.command.section import Section, increasing
from impact_damper.command.values import count, number, several
from impact_damper.model.bounds import (
    LOAD_RANGE,
    METHOD_TOLERANCE_RANGE,
    MOST_STEPS_RANGE,
    PERIODS_RANGE,
    RUNS_RANGE,
    STEPS_RANGE,
)

STEPS = range_of(count("steps in a forcing cycle", **STEPS_RANGE))
TOLERANCES = range_of(number("tolerance of a method", **METHOD_TOLERANCE_RANGE), points=True)
GEOMETRIC = range_of(number("end of a geometric grid", least=1e-14, most=1e9), points=True)


class ContactCells(Section):
    """Cells of the map along restitution and load."""

    restitutions: points_of("cells of the map along restitution")
    loads: points_of("cells of the map along load")


class ContactModel(keys_of(DAMPER, needed=NEEDED, without=["restitution", COMMON]), WithOscillator):
    """One contact in closed form over restitution and load, and contacts of simulated motions."""

    restitutions: several(RESTITUTION, "increasing restitutions of the motions", least=2)
    frequencies: several(FREQUENCY, "increasing frequencies of the motions", least=1)
    periods: count("forcing cycles over which contacts are logged", **PERIODS_RANGE)
    cells: ContactCells
    smallest_restitution: number("smallest e of the map", **BOUNDS["restitution"])
    largest_load: number(
        "largest load: acceleration divided by natural frequency and approach speed", **LOAD_RANGE
    )

    counts: ClassVar = ("cells.restitutions", "cells.loads")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        if self.smallest_restitution == 1:
            reason = "must be less than 1 (where the map ends)"
            yield problem((*path, "smallest_restitution"), 1, reason)
        for key in ("restitutions", "frequencies"):
            yield from increasing((*path, key), getattr(self, key), "motions are run in order")


class RigidCells(Section):
    """Cells of the map along frequency and contact stiffness."""

    frequencies: points_of("cells of the map along frequency")
    stiffnesses: points_of("cells of the map along contact stiffness")


class RigidLimit(WithDamper):
    """The quiet motion between rigid walls compared with the one between compliant walls."""

    frequency: FREQUENCY
    frequencies: FREQUENCIES
    stiffnesses: range_of(CONTACT_STIFFNESS)
    cells: RigidCells

    counts: ClassVar = ("cells.frequencies", "cells.stiffnesses")


class MissedContacts(WithOscillator):
    """Contacts that barely touch the wall (near grazing), found or missed by integrators."""

    frequency: FREQUENCY
    passages: count("random flights without contact, each over one forcing cycle", **RUNS_RANGE)
    radius: RADIUS
    depths: GEOMETRIC
    tolerances: TOLERANCES
    steps: STEPS

    counts: ClassVar = ("passages", "depths.points", "tolerances.points")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        yield from close_steps(path, self)


class StableSteps(WithDamper):
    """The quiet motion by fixed-step methods, over contact stiffness and step."""

    frequency: FREQUENCY
    stiffnesses: range_of(CONTACT_STIFFNESS, points=True)
    scaled_steps: GEOMETRIC
    most_steps: count(
        "largest number of steps in a forcing cycle; cells with more are not run",
        **MOST_STEPS_RANGE,
    )
    periods: RUN_PERIODS

    counts: ClassVar = ("stiffnesses.points", "scaled_steps.points")


def close_steps(path, entry):
    """Yield a line if the range `steps` holds fewer different whole numbers than tolerances.

    Methods with fixed steps are compared at as many numbers of steps as others at tolerances.
    """
    span, points = entry.steps, entry.tolerances.points
    ratio = span.last / span.first
    numbers = {round(span.first * ratio ** (k / (points - 1))) for k in range(points)}
    if len(numbers) < points:
        reason = f"must be so far from first = {span.first} that {points} whole numbers fit"
        yield problem(
            (*path, "steps", "last"), span.last, f"{reason} (as many as tolerances.points)"
        )


SECTIONS = {
    "contact_model": ContactModel,
    "rigid_limit": RigidLimit,
    "missed_contacts": MissedContacts,
    "stable_steps": StableSteps,
}
