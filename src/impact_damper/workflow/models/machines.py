"""Machines with dampers in SI units: each value a number, or text with units such as "12 kg"."""

from dataclasses import MISSING, fields
from typing import Annotated, Any, ClassVar

from pydantic import create_model
from pydantic_core import core_schema

from impact_damper.machine.dampers import MachineDamper
from impact_damper.machine.machine import Machine
from impact_damper.machine.units import QUANTITIES, check_si, si_value
from impact_damper.system.bounds import plain
from impact_damper.workflow.models.messages import dotted, problem
from impact_damper.workflow.models.section import Section
from impact_damper.workflow.models.settings import starts_of
from impact_damper.workflow.models.system import points_of
from impact_damper.workflow.models.values import Allowed


class AllowedQuantity(Allowed):
    """What a physical quantity may be; the value stays as the user wrote it.

    Parameters
    ----------
    quantity : str
        A key of `machine.units.QUANTITIES`.
    bounds : dict
        Of `check_si`.
    meaning : str
    """

    def __init__(self, quantity, bounds, meaning):
        unit = QUANTITIES[quantity].unit
        words = {"above": "greater than", "least": "at least", "most": "at most"}
        allowed = [f"{words[end]} {plain(bounds[end])}" for end in words if end in bounds]
        kind = f'a number in {unit}, or text such as "2 {unit}"' if unit else "a number"
        super().__init__(", ".join([kind, *allowed]), meaning, bounds.get("why", ""))
        self.quantity, self.bounds = quantity, bounds

    def __get_pydantic_core_schema__(self, source, handler):
        return core_schema.no_info_plain_validator_function(self._quantity)

    def _quantity(self, value):
        try:
            check_si("", value, self.quantity, **self.bounds)
        except (TypeError, ValueError):
            raise self._error() from None
        return value


def quantity_of(quantity, meaning="", **bounds):
    """Type of a physical quantity within bounds in SI units."""
    return Annotated[Any, AllowedQuantity(quantity, bounds, meaning)]


def fields_of(part, **meanings):
    """Fields of a model for those of a dataclass in SI units, with what each means."""
    found = {}
    for each in fields(part):
        if "quantity" in each.metadata:
            kind = quantity_of(
                each.metadata["quantity"], meanings.get(each.name, ""), **each.metadata["bounds"]
            )
            found[each.name] = kind if each.default is MISSING else (kind, None)
    return found


class Given(Section):
    """Base of models of a dataclass in SI units."""

    def values(self) -> dict:
        """Return the values that are given."""
        return {key: value for key, value in self if value is not None}


class Span(Section):
    """Even grid of a physical quantity; the first value is less than the last."""

    def contradictions(self, path, config):
        quantity = type(self).model_fields["first"].metadata[-1].quantity
        first, last = (si_value("", end, quantity) for end in (self.first, self.last))
        if first >= last:
            reason = f"must be less than last = {self.last!r} (a range ascends)"
            yield problem((*path, "first"), self.first, reason)


def span_of(quantity, meaning):
    """Model of an even grid of a physical quantity."""
    end = quantity_of(quantity, meaning, above=0)
    return create_model(
        "Span", __base__=Span, first=end, last=end, points=points_of("points of the grid")
    )


Damper = create_model(
    "Damper",
    __base__=Given,
    **fields_of(
        MachineDamper,
        mass="mass of the loose mass",
        gap="full play of the loose mass, from wall to wall",
        restitution="coefficient of restitution",
        contact_stiffness="stiffness of the contact",
    )
    | {"contact_stiffness": quantity_of("stiffness", "stiffness of the contact", above=0)},
)
Body = create_model(
    "Body",
    __base__=Given,
    **fields_of(
        Machine,
        mass="mass without the loose mass",
        linear_stiffness="of the spring",
        cubic_stiffness="of the spring, negative if it softens",
        damping_ratio="share of the critical damping; or damping in its place",
        damping="coefficient of the dashpot",
        force="amplitude of the force; or one of the next three in its place",
        base_displacement="amplitude with which the base moves",
        base_acceleration="amplitude of the base's acceleration",
        unbalance="mass times eccentricity of a rotating unbalance",
    ),
)


class MachineEntry(Section):
    """Machines with dampers, in SI units: numbers, or texts with units."""

    machine: Body
    damper: Damper
    frequencies: span_of("frequency", "forcing frequency of the response")
    frequency: quantity_of("frequency", "forcing frequency at which the gap is varied", above=0)
    gaps: span_of("clearance", "gap, the full play, that is varied")
    starts: starts_of("at each frequency and at each gap")

    counts: ClassVar = ("frequencies.points", "starts")

    def contradictions(self, path, config):
        try:
            where = (*path, "machine")
            machine = Machine(**self.machine.values())
            machine.oscillator()
            where = (*path, "damper")
            damper = self.damper.values()
            machine.damper(**damper)
            for end in ("first", "last"):
                where = (*path, "gaps", end)
                machine.damper(**damper | {"gap": getattr(self.gaps, end)})
                where = (*path, "frequencies")
                machine.check_frequency(end, getattr(self.frequencies, end))
            where = path
            machine.check_frequency("frequency", self.frequency)
        except (TypeError, ValueError) as error:
            yield f"{dotted(where)}.{error}"


SECTIONS = {"machines": MachineEntry}
