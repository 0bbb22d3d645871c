"""Configuration keys for the paper's parameters of oscillator and damper, with bounds."""

import math
from typing import ClassVar

from pydantic import create_model

from impact_damper.command.section import (
    Section,
    count,
    missing,
    number,
    number_or_word,
    one_of,
    points_of,
    problem,
    text,
)
from impact_damper.model.bounds import FREQUENCY_RANGE, MOST_RUNS, PERIODS_RANGE, RADIUS_RANGE
from impact_damper.model.parameters import Damper, Oscillator, parameters_in
from impact_damper.theory.design_rule import rule_clearance

BOUNDS, MEANINGS = (
    {each.name: each.metadata[key] for part in (Oscillator, Damper) for each in parameters_in(part)}
    for key in ("bounds", "meaning")
)
BOUNDS["frequency"], MEANINGS["frequency"] = FREQUENCY_RANGE, "W, forcing frequency"
BEYOND = ("base", "gravity", "friction")
OSCILLATOR, DAMPER = (
    [each.name for each in parameters_in(part) if each.name not in BEYOND]
    for part in (Oscillator, Damper)
)
PARAMETERS = {name: number(MEANINGS[name], **BOUNDS[name]) for name in BOUNDS}

MASS_RATIO, CLEARANCE, RESTITUTION, CONTACT_STIFFNESS, FREQUENCY = (
    PARAMETERS[name]
    for name in ("mass_ratio", "clearance", "restitution", "contact_stiffness", "frequency")
)
RADIUS = number("radius of the ball from which random starts are drawn", **RADIUS_RANGE)
RUN_PERIODS = count("forcing cycles of a run", **PERIODS_RANGE)
CLEARANCE_OR_RULE = number_or_word(
    "rule",
    f"{MEANINGS['clearance']}, or the word `rule` for the clearance by equation (19) of the paper",
    **BOUNDS["clearance"],
)
COMMON = "contact_stiffness"  # key at the top of the configuration: all dampers share its value
NEEDED = ("mass_ratio", "clearance", "restitution")  # parameters that a damper must have


def keys_of(names, *, needed=(), without=()):
    """Return a class with the keys `names` except `without`. Only keys in `needed` are required."""
    types = {
        name: PARAMETERS[name] if name in needed else (PARAMETERS[name], None)
        for name in names
        if name not in without
    }
    return create_model("Parameters", __base__=Section, **types)


def given(section, names) -> dict:
    """Return the values that a section gives for the keys `names`, as a dict."""
    found = {name: getattr(section, name, None) for name in names}
    return {name: value for name, value in found.items() if value is not None}


class Range(Section):
    """A range whose first value is less than its last."""

    def contradictions(self, path, config):
        if self.first >= self.last:
            reason = f"must be less than last = {self.last!r} (a range ascends)"
            yield problem((*path, "first"), self.first, reason)

    def even(self, points=None) -> dict:
        return {"linspace": [self.first, self.last, points or self.points]}

    def geometric(self, points=None) -> dict:
        return {"geomspace": [self.first, self.last, points or self.points]}


def range_of(kind, *, points=False):
    """Return a class for a range of values of the type `kind`. Its keys are `first` and `last`.

    If `points` is true, the class also has the key `points`, the number of values in the range.
    """
    types = {"first": kind, "last": kind} | (
        {"points": points_of("points of the grid")} if points else {}
    )
    return create_model("Range", __base__=Range, **types)


FREQUENCIES = range_of(FREQUENCY)


class Oscillators(keys_of(OSCILLATOR, needed=("damping", "linear_frequency"))):
    """Free oscillators, and the range of forcing frequencies over which responses are computed."""

    frequencies: FREQUENCIES

    def values(self) -> dict:
        return given(self, OSCILLATOR)


class WithOscillator(Section):
    """An entry of the configuration that names an oscillator."""

    oscillator: text("name of an entry of `oscillators`")

    # Each of these keys holds a number n, or a list with n values. The product of all n must not
    # exceed MOST_RUNS.
    counts: ClassVar = ()

    def contradictions(self, path, config):
        yield from too_many(path, self, self.counts)
        if self.oscillator not in config.oscillators:
            reason = one_of(self.oscillator, config.oscillators)
            yield problem((*path, "oscillator"), self.oscillator, reason)

    def system(self, config) -> dict:
        """Return a dict from which a job makes the oscillator."""
        return {"system": {"Oscillator": config.oscillators[self.oscillator].values()}}


class WithDamper(keys_of(DAMPER, needed=NEEDED, without=[COMMON]), WithOscillator):
    """An entry with an oscillator and a damper."""

    def system(self, config) -> dict:
        return super().system(config) | {"damper": {"Damper": damper_values(self, config)}}


class MaybeWithDamper(keys_of(DAMPER, without=[COMMON]), WithOscillator):
    """An entry with an oscillator, and with or without a damper."""

    # Keys of the damper. An entry must give all of these keys or none of them.
    whole: ClassVar = NEEDED

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        found = given(self, self.whole)
        if found:
            reason = f"needed with {', '.join(found)} (a damper is whole or absent)"
            for key in sorted(set(self.whole) - set(found)):
                yield missing((*path, key), reason)

    def has_damper(self) -> bool:
        return bool(given(self, self.whole))

    def system(self, config) -> dict:
        damper = {"Damper": damper_values(self, config)} if self.has_damper() else None
        return super().system(config) | {"damper": damper}


def damper_values(entry, config) -> dict:
    """Return the arguments of `Damper`. A clearance given as "rule" is computed by rule (19)."""
    values = {COMMON: config.contact_stiffness} | given(entry, DAMPER)
    if values.get("clearance") == "rule":
        oscillator = Oscillator(**config.oscillators[entry.oscillator].values())
        values["clearance"] = rule_clearance(oscillator, entry.mass_ratio)
    return values


def too_many(path, section, keys):
    """Yield an error line if the numbers at `keys`, multiplied together, exceed MOST_RUNS.

    A list counts as its length. `path` is the place of `section` in the configuration.
    """
    counts = []
    for key in keys:
        value = section
        for name in key.split("."):
            value = getattr(value, name)
        counts.append(len(value) if isinstance(value, list) else value)
    if math.prod(counts) > MOST_RUNS:
        largest = counts.index(max(counts))
        others = [f"{k} ({n})" for k, n in zip(keys, counts, strict=True) if k != keys[largest]]
        reason = f"with {' and '.join(others)} makes {math.prod(counts)}: must be at most "
        reason += f"{MOST_RUNS} in all (a job keeps them in memory)"
        yield problem((*path, *keys[largest].split(".")), counts[largest], reason)
