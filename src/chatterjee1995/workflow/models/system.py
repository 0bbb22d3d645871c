"""Keys for the parameters of oscillator, damper and forcing, and for ranges of these parameters.

The keys of an oscillator and of a damper are the fields of `Oscillator` and `Damper`, which hold
their bounds and meanings. A new field becomes a new key of all sections with an oscillator or
damper. Only `shaker` is not a key: linear machines on a shaker are entries of `machines`.
"""

from dataclasses import fields
from typing import ClassVar

from pydantic import create_model

from impact_damper.command.messages import missing, one_of, problem
from impact_damper.command.section import Section
from impact_damper.command.values import count, number, number_or_word, points_of, text
from impact_damper.model.bounds import FREQUENCY_RANGE, PERIODS_RANGE
from impact_damper.model.parameters import Damper, Oscillator

BOUNDS, MEANINGS = (
    {each.name: each.metadata[key] for part in (Oscillator, Damper) for each in fields(part)}
    for key in ("bounds", "meaning")
)
BOUNDS["frequency"], MEANINGS["frequency"] = FREQUENCY_RANGE, "W, forcing frequency"
OSCILLATOR, DAMPER = (
    [each.name for each in fields(part) if each.name != "shaker"] for part in (Oscillator, Damper)
)
PARAMETERS = {name: number(MEANINGS[name], **BOUNDS[name]) for name in BOUNDS}

MASS_RATIO, CLEARANCE, RESTITUTION, CONTACT_STIFFNESS, FREQUENCY = (
    PARAMETERS[name]
    for name in ("mass_ratio", "clearance", "restitution", "contact_stiffness", "frequency")
)
RUN_PERIODS = count("forcing cycles of a run", **PERIODS_RANGE)
CLEARANCE_OR_RULE = number_or_word(
    "rule",
    f"{MEANINGS['clearance']}, or the word `rule` for the clearance by equation (19) of the paper",
    **BOUNDS["clearance"],
)


def keys_of(names, *, needed=(), without=()):
    """Return a base class of models with keys for parameters; only `needed` keys are required."""
    types = {
        name: PARAMETERS[name] if name in needed else (PARAMETERS[name], None)
        for name in names
        if name not in without
    }
    return create_model("Parameters", __base__=Section, **types)


class Range(Section):
    """A range whose first value is less than its last."""

    def contradictions(self, path, config):
        if self.first >= self.last:
            reason = f"must be less than last = {self.last!r} (a range ascends)"
            yield problem((*path, "first"), self.first, reason)


def range_of(kind, *, points=False):
    """Return the model of a range; `kind` is the type of its ends, `points` adds their number."""
    types = {"first": kind, "last": kind} | (
        {"points": points_of("points of the grid")} if points else {}
    )
    return create_model("Range", __base__=Range, **types)


FREQUENCIES = range_of(FREQUENCY)


class Oscillators(keys_of(OSCILLATOR, needed=("damping", "linear_frequency"))):
    """Free oscillators, and the range of forcing frequencies over which responses are computed."""

    frequencies: FREQUENCIES

    def built(self) -> Oscillator:
        """Return the oscillator as an object."""
        return Oscillator(**given(self, OSCILLATOR))


class WithOscillator(Section):
    """An entry that names an oscillator."""

    oscillator: text("name of an entry of `oscillators`")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        if self.oscillator not in config.oscillators:
            reason = one_of(self.oscillator, config.oscillators)
            yield problem((*path, "oscillator"), self.oscillator, reason)


# The contact stiffness is a key of the whole configuration, common to all dampers.
COMMON = "contact_stiffness"
# Parameters that a damper must have.
NEEDED = ("mass_ratio", "clearance", "restitution")


class WithDamper(keys_of(DAMPER, needed=NEEDED, without=[COMMON]), WithOscillator):
    """An entry with an oscillator and a damper."""


class MaybeWithDamper(keys_of(DAMPER, without=[COMMON]), WithOscillator):
    """An entry with an oscillator, and with a damper or without."""

    whole: ClassVar = NEEDED

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        found = given(self, self.whole)
        if found:
            reason = f"needed with {', '.join(found)} (a damper is whole or absent)"
            for key in sorted(set(self.whole) - set(found)):
                yield missing((*path, key), reason)

    def has_damper(self) -> bool:
        """Whether any parameter of the damper is given."""
        return bool(given(self, self.whole))


def given(section, names) -> dict:
    """Return the values that a section has under some names; names without a value are left out."""
    found = {name: getattr(section, name, None) for name in names}
    return {name: value for name, value in found.items() if value is not None}
