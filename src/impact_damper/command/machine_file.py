"""Checks of the description of a machine, in the configuration or in a file of its own."""

import re
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Annotated, Any, ClassVar

import yaml
from pydantic import ValidationError, create_model
from pydantic_core import core_schema

from impact_damper.command import section
from impact_damper.command.section import Allowed, count, number, points_of, starts_of
from impact_damper.model.bounds import RESTITUTION_RANGE, range_words
from impact_damper.model.hertz import HertzContact
from impact_damper.model.machine import ANGLES, FRICTIONS, MOUNT, Machine, TunedAbsorber
from impact_damper.model.units import QUANTITIES, absolute_value, check_si, si_value


class AllowedQuantity(Allowed):
    """Allowed values of a physical quantity. The check leaves a value as the user wrote it."""

    def __init__(self, quantity, bounds, meaning, absolute=()):
        unit = QUANTITIES[quantity].unit
        allowed = range_words(**bounds)
        kind = f'a number in {unit}, or text such as "2 {unit}"' if unit else "a number"
        if absolute:
            allowed.append(f"or text in a unit such as {QUANTITIES[absolute[0]].label}")
        super().__init__(", ".join([kind, *allowed]), meaning, bounds.get("why", ""))
        self.quantity, self.bounds, self.absolute = quantity, bounds, absolute

    def __get_pydantic_core_schema__(self, source, handler):
        return core_schema.with_info_plain_validator_function(self._quantity)

    def _quantity(self, value, info):
        # If `context` is true, the value was checked before. Returning here avoids a slow import.
        if info.context:
            return value
        if any((absolute_value(value, each) or -1) > 0 for each in self.absolute):
            return value
        try:
            check_si("", value, self.quantity, **self.bounds)
        except (TypeError, ValueError) as error:
            remark = re.search(r" \([^)]* unit\)$| \(.* converted to .*\)$", str(error))
            raise self._error(remark[0] if remark else "") from None
        return value


def quantity_of(quantity, meaning="", absolute=(), **bounds):
    """Return the pydantic type of a physical quantity within bounds.

    If `absolute` lists other quantities, text with a unit of one of these is allowed too.
    """
    return Annotated[Any, AllowedQuantity(quantity, bounds, meaning, absolute)]


def fields_of(part, *, optional=False):
    """Return {name: pydantic field} of a dataclass. If `optional`, no field is required."""
    found = {}
    for each in fields(part):
        facts = each.metadata
        kind = quantity_of(facts["quantity"], facts["meaning"], **facts["bounds"])
        needed = each.default is MISSING and not optional
        found[each.name] = kind if needed else (kind, None)
    return found


class Given(section.Section):
    """Base of sections. Keys are the arguments of a dataclass, values are in SI units."""

    def values(self) -> dict:
        """Return {key: value} for the keys that the user has given."""
        return {key: value for key, value in self if value is not None}


class Span(section.Section):
    """Evenly spaced values of a physical quantity; the first value is less than the last."""

    def contradictions(self, path, config):
        quantity = type(self).model_fields["first"].metadata[-1].quantity
        first, last = (si_value("", end, quantity) for end in (self.first, self.last))
        if first >= last:
            reason = f"must be less than last = {self.last!r} (a range ascends)"
            yield section.problem((*path, "first"), self.first, reason)


def span_of(quantity, meaning):
    """Return a subclass of `Span` for a physical quantity."""
    end = quantity_of(quantity, meaning, above=0)
    points = points_of("points of the grid")
    return create_model("Span", __base__=Span, first=end, last=end, points=points)


class Damper(Given):
    """The loose mass and the walls of a damper. The design finds the gap."""

    mass: quantity_of("mass", "loose mass, at most the mass of the machine", above=0)
    restitution: quantity_of("number", "coefficient of restitution", **RESTITUTION_RANGE)
    contact_stiffness: quantity_of(
        "stiffness",
        "stiffness of the contact (without it computed from `contact` after Hertz)",
        above=0,
    ) = None
    inclination: quantity_of(
        "angle",
        "angle between the gap and the horizontal; left out, the gap is horizontal",
        **ANGLES,
    ) = None
    friction_coefficient: quantity_of(
        "number", "friction of the loose mass on its floor", **FRICTIONS
    ) = None
    normal_force: quantity_of(
        "force", "force between loose mass and floor; by default its weight", least=0, most=1e9
    ) = None


Body = create_model("Body", __base__=Given, **fields_of(Machine))


def deviation_of(what, *absolute):
    """Return a field: tolerance of `what`, as a fraction or as a quantity named in `absolute`."""
    meaning = f"largest relative deviation of {what}"
    return quantity_of("number", meaning, absolute, least=0, most=0.9), None


Tolerances = create_model(
    "Tolerances",
    __base__=Given,
    gap=deviation_of("the gap", "displacement"),
    restitution=deviation_of("the restitution"),
    contact_stiffness=deviation_of("the contact stiffness", "stiffness"),
    gravity=deviation_of("gravity along the gap"),
    friction=deviation_of("the friction of the loose mass"),
    stiffness=deviation_of("both stiffnesses of the spring", "stiffness"),
    damping=deviation_of("the damping of the machine", "damping"),
    force=deviation_of("the excitation", "force", "displacement", "acceleration", "unbalance"),
)
Ball = create_model("Ball", __base__=Given, **fields_of(HertzContact, optional=True))
Rival = create_model("Rival", __base__=Given, **fields_of(TunedAbsorber, optional=True))


class MachineEntry(section.Section):
    """A machine for which a damper is designed. Values are in SI units, or texts with units."""

    machine: Body
    damper: Damper
    contact: Ball = Ball()
    absorber: Rival = Rival()
    band: span_of("frequency", "end of the band of forcing frequencies")
    candidates: count("gaps that are compared", least=4, most=1000)
    starts: starts_of("at each gap and frequency")
    share: number(
        "share of the starts for which the displacement is promised", least=0.5, most=0.999
    )
    tolerances: Tolerances
    displacement_limit: (
        quantity_of("displacement", "displacement with which the promised one is compared", above=0)
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
            yield f"{section.dotted((*path, 'machine'))}.{error}"
            return
        try:
            if not lacking:
                from impact_damper.design.task import Task

                Task(machine=machine, **design_arguments(self.model_dump(exclude_none=True)))
        except (TypeError, ValueError) as error:
            yield f"{section.dotted(path)}: {error}" if path else str(error)

    def _lacking(self, path):
        rival, ball = self.absorber.values(), self.contact.values()
        for key in Rival.model_fields:
            if rival and key not in rival:
                yield section.missing((*path, "absorber", key), "needed for a tuned absorber")
        for key in ("radius", "youngs_modulus", "poissons_ratio"):
            if ball and key not in ball:
                yield section.missing((*path, "contact", key), "needed for a contact after Hertz")
        stiffness = self.damper.contact_stiffness
        if ball and stiffness is not None:
            reason = "must be left out: it is computed from the keys of contact"
            yield section.problem((*path, "damper", "contact_stiffness"), stiffness, reason)
        if not ball and stiffness is None:
            reason = "needed here, or radius and material of a ball under contact in its place"
            yield section.missing((*path, "damper", "contact_stiffness"), reason)


def design_arguments(content, workers=1) -> dict:
    """Return the arguments of `design_damper`, except the machine, from the content of a file."""
    from impact_damper.design.task import Effort  # here, because the module loads SciPy

    damper, ball, band = content["damper"], content.get("contact"), content["band"]
    effort = {key: content[key] for key in ("candidates", "starts")}
    return {
        "mass": damper["mass"],
        "restitution": damper["restitution"],
        "mount": {key: damper[key] for key in MOUNT if key in damper},
        "contact": HertzContact(**ball) if ball else damper.get("contact_stiffness"),
        "band": (band["first"], band["last"]),
        "share": content["share"],
        "tolerances": content["tolerances"],
        "absorber": content.get("absorber") or None,
        "displacement_limit": content.get("displacement_limit"),
        "effort": Effort(frequencies=band["points"], workers=workers, **effort),
    }


class _Loader(section.LOADER):
    """YAML loader that reads 2e5 as a number; by YAML 1.1, 2e5 is text."""


FLOAT = re.compile(f"(?:{section.SCIENTIFIC.pattern})$")
_Loader.add_implicit_resolver("tag:yaml.org,2002:float", FLOAT, list("-+.0123456789"))
DEFAULTS = {"candidates": 8, "starts": 73, "share": 0.95, "tolerances": {"gap": 0.2}}
POINTS = 9  # number of frequencies in the band


def read_machine_file(path) -> dict:
    """Check a machine's file, and return the content of the file with defaults for missing keys.

    In a file (not in the configuration) `band` may be a list of the first and the last frequency,
    and the key `frequencies` may give the number of frequencies in the band.
    """
    section.check_file(path)
    given = yaml.load(Path(path).read_bytes(), _Loader)
    if not isinstance(given, dict):
        words = "must have keys with values, such as machine:"
        raise section.ConfigurationError(f"{Path(path).name}: {words}")
    content = DEFAULTS | given
    band, points = content.get("band"), content.pop("frequencies", POINTS)
    if isinstance(band, list):
        if len(band) != 2:
            words = "must be least and greatest frequency; `frequencies` is their number"
            raise section.ConfigurationError(section.problem(("band",), band, words))
        content["band"] = {"first": band[0], "last": band[1]}
    if isinstance(content.get("band"), dict):
        content["band"] = {"points": points} | content["band"]
        if "frequencies" in given and content["band"]["points"] != points:
            words = "must be left out with band.points, which means the same"
            raise section.ConfigurationError(section.problem(("frequencies",), points, words))
    try:
        entry = MachineEntry.model_validate(content)
    except ValidationError as error:
        raise section.ConfigurationError("\n".join(section.problems_of(error))) from None
    problems = list(entry.contradictions((), None))
    if problems:
        raise section.ConfigurationError("\n".join(problems))
    return content
