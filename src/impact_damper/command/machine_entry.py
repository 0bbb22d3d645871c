"""Machines for which a damper is designed.

Quantities are numbers in SI units, or texts with a unit such as "12 kg".
"""

from dataclasses import MISSING, fields
from typing import Annotated, Any, ClassVar

from pydantic import create_model
from pydantic_core import core_schema

from impact_damper.command.messages import dotted, missing, problem
from impact_damper.command.section import Section
from impact_damper.command.values import Allowed, count, number, points_of, starts_of
from impact_damper.model.bounds import RESTITUTION_RANGE
from impact_damper.model.hertz import HertzContact
from impact_damper.model.machine import Machine
from impact_damper.model.text import plain
from impact_damper.model.units import QUANTITIES, check_si, si_value, wrong_unit


class AllowedQuantity(Allowed):
    """The allowed values of a physical quantity; the value stays as the user wrote it.

    Parameters
    ----------
    quantity : str
        A key of `machine.units.QUANTITIES`.
    bounds : dict
        Keywords of `check_si`: `above`, `least`, `most`, `why`; in SI units.
    meaning : str
        Description of the value.
    """

    def __init__(self, quantity, bounds, meaning):
        unit = QUANTITIES[quantity].unit
        words = {"above": "greater than", "least": "at least", "most": "at most"}
        allowed = [f"{words[end]} {plain(bounds[end])}" for end in words if end in bounds]
        kind = f'a number in {unit}, or text such as "2 {unit}"' if unit else "a number"
        super().__init__(", ".join([kind, *allowed]), meaning, bounds.get("why", ""))
        self.quantity, self.bounds = quantity, bounds

    def __get_pydantic_core_schema__(self, source, handler):
        return core_schema.with_info_plain_validator_function(self._quantity)

    def _quantity(self, value, info):
        # Reading units takes a third of a second, which a job of a checked configuration can save.
        if info.context:
            return value
        try:
            check_si("", value, self.quantity, **self.bounds)
        except (TypeError, ValueError):
            raise self._error(wrong_unit(value, self.quantity)) from None
        return value


def quantity_of(quantity, meaning="", **bounds):
    """Return the type of a physical quantity within bounds in SI units."""
    return Annotated[Any, AllowedQuantity(quantity, bounds, meaning)]


def fields_of(part, *, optional=False, **meanings):
    """Return the fields of a model for a dataclass with quantities in SI units.

    `meanings` holds the description of each field. A field with a default, or any with `optional`,
    may be left out.
    """
    found = {}
    for each in fields(part):
        if "quantity" in each.metadata:
            kind = quantity_of(
                each.metadata["quantity"], meanings.get(each.name, ""), **each.metadata["bounds"]
            )
            needed = each.default is MISSING and not optional
            found[each.name] = kind if needed else (kind, None)
    return found


class Given(Section):
    """Base of the models whose keys are the arguments of a dataclass in SI units."""

    def values(self) -> dict:
        """Return the values that are given."""
        return {key: value for key, value in self if value is not None}


class Span(Section):
    """Evenly spaced values of a physical quantity; the first value is less than the last."""

    def contradictions(self, path, config):
        quantity = type(self).model_fields["first"].metadata[-1].quantity
        first, last = (si_value("", end, quantity) for end in (self.first, self.last))
        if first >= last:
            reason = f"must be less than last = {self.last!r} (a range ascends)"
            yield problem((*path, "first"), self.first, reason)


def span_of(quantity, meaning):
    """Return the model of evenly spaced values of a physical quantity."""
    end = quantity_of(quantity, meaning, above=0)
    return create_model(
        "Span", __base__=Span, first=end, last=end, points=points_of("points of the grid")
    )


Damper = create_model(
    "Damper",
    __base__=Given,
    mass=quantity_of("mass", "loose mass, at most the mass of the machine", above=0),
    restitution=quantity_of("number", "coefficient of restitution", **RESTITUTION_RANGE),
    contact_stiffness=(
        quantity_of(
            "stiffness",
            "stiffness of the contact (without it computed from `contact` after Hertz)",
            above=0,
        ),
        None,
    ),
)
Body = create_model(
    "Body",
    __base__=Given,
    **fields_of(
        Machine,
        mass="mass without the loose mass",
        linear_stiffness="linear stiffness of the spring",
        cubic_stiffness="cubic stiffness of the spring, negative if the spring softens",
        damping_ratio="damping divided by the critical damping (give this or `damping`)",
        damping="coefficient of the dashpot",
        force="amplitude of the force (give this or one of the next three keys)",
        base_displacement="amplitude with which the base moves",
        base_acceleration="amplitude of the base's acceleration",
        unbalance="mass times eccentricity of a rotating unbalance",
    ),
)


def share_of(what, meaning="largest relative deviation of"):
    """Return an optional field for a relative deviation."""
    return quantity_of("number", f"{meaning} {what}", least=0, most=0.9), None


Tolerances = create_model(
    "Tolerances",
    __base__=Given,
    gap=share_of("the gap"),
    restitution=share_of("the restitution"),
    contact_stiffness=share_of("the contact stiffness"),
    stiffness=share_of("both stiffnesses of the spring"),
    damping=share_of("the damping of the machine"),
    force=share_of("the excitation"),
)
Ball = create_model(
    "Ball",
    __base__=Given,
    **fields_of(
        HertzContact,
        optional=True,
        radius="radius of the loose mass where it touches (without it no pressure is computed)",
        youngs_modulus="Young's modulus of the loose mass",
        poissons_ratio="Poisson's ratio of the loose mass",
        yield_strength="yield strength in tension (without it yielding is not judged)",
        wall_youngs_modulus="Young's modulus of the walls, if they are of another material",
        wall_poissons_ratio="Poisson's ratio of the walls, if they are of another material",
        wall_yield_strength="yield strength of the walls, if they are of another material",
    ),
)


class MachineEntry(Section):
    """Machines for which a damper is designed, in SI units: numbers, or texts with units."""

    machine: Body
    damper: Damper
    contact: Ball = Ball()
    band: span_of("frequency", "end of the band of forcing frequencies")
    candidates: count("gaps that are compared", least=4, most=1000)
    starts: starts_of("at each gap and frequency")
    share: number(
        "least share of the starts that must lead to quiet motions", least=0.5, most=0.999
    )
    tolerances: Tolerances
    displacement_limit: (
        quantity_of(
            "displacement", "quiet limit, the largest displacement of a quiet motion", above=0
        )
        | None
    ) = None

    counts: ClassVar = ("band.points", "candidates", "starts")

    def contradictions(self, path, config):
        lacking = list(self._lacking(path))
        yield from lacking
        try:
            machine = Machine(**self.machine.values())
            machine.oscillator()
        except (TypeError, ValueError) as error:
            yield f"{dotted((*path, 'machine'))}.{error}"
            return
        try:
            if not lacking:
                self._task(machine)
        except (TypeError, ValueError) as error:
            yield f"{dotted(path)}: {error}" if path else str(error)

    def _lacking(self, path):
        """Yield a line for each missing key of the contact."""
        ball = self.contact.values()
        for key in ("radius", "youngs_modulus", "poissons_ratio"):
            if ball and key not in ball:
                yield missing((*path, "contact", key), "needed for a contact after Hertz")
        stiffness = self.damper.contact_stiffness
        if ball and stiffness is not None:
            reason = "must be left out: it is computed from the keys of contact"
            yield problem((*path, "damper", "contact_stiffness"), stiffness, reason)
        if not ball and stiffness is None:
            reason = "needed here, or radius and material of a ball under contact in its place"
            yield missing((*path, "damper", "contact_stiffness"), reason)

    def _task(self, machine):
        """Return the task of the design; its modules are imported here because they load SciPy."""
        from impact_damper.design.task import Effort, Task

        ball = self.contact.values()
        return Task(
            machine=machine,
            mass=self.damper.mass,
            restitution=self.damper.restitution,
            contact=HertzContact(**ball) if ball else self.damper.contact_stiffness,
            band=(self.band.first, self.band.last),
            share=self.share,
            tolerances=self.tolerances.values(),
            displacement_limit=self.displacement_limit,
            effort=Effort(
                frequencies=self.band.points, candidates=self.candidates, starts=self.starts
            ),
        )


SECTIONS = {"machines": MachineEntry}
