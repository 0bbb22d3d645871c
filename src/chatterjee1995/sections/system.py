"""Keys for the parameters of oscillator, damper and forcing, and for ranges of them.

The keys are the fields of `Oscillator` and `Damper`, with their bounds and meanings. Only `shaker`
is not a key: linear machines on a shaker are entries of `machines`.
"""

import math
from typing import ClassVar

from pydantic import create_model

from impact_damper.command.messages import dotted, missing, one_of, problem
from impact_damper.command.section import Section
from impact_damper.command.values import count, number, number_or_word, points_of, text
from impact_damper.model.bounds import (
    FREQUENCY_RANGE,
    MOST_RADIUS,
    MOST_RUNS,
    MOST_STIFF,
    PERIODS_RANGE,
    RADIUS_RANGE,
)
from impact_damper.model.parameters import Damper, Oscillator, parameters_in
from impact_damper.theory.design_rule import rule_clearance

BOUNDS, MEANINGS = (
    {each.name: each.metadata[key] for part in (Oscillator, Damper) for each in parameters_in(part)}
    for key in ("bounds", "meaning")
)
BOUNDS["frequency"], MEANINGS["frequency"] = FREQUENCY_RANGE, "W, forcing frequency"
OSCILLATOR, DAMPER = (
    [each.name for each in parameters_in(part) if each.name != "shaker"]
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
# The contact stiffness is a key of the whole configuration, common to all dampers.
COMMON = "contact_stiffness"
# Parameters that a damper must have.
NEEDED = ("mass_ratio", "clearance", "restitution")


def keys_of(names, *, needed=(), without=()):
    """Return a base class with keys for parameters, of which only `needed` are required."""
    types = {
        name: PARAMETERS[name] if name in needed else (PARAMETERS[name], None)
        for name in names
        if name not in without
    }
    return create_model("Parameters", __base__=Section, **types)


def given(section, names) -> dict:
    """Return the values that a section has under some names; names without a value are left out."""
    found = {name: getattr(section, name, None) for name in names}
    return {name: value for name, value in found.items() if value is not None}


class Range(Section):
    """A range whose first value is less than its last."""

    def contradictions(self, path, config):
        if self.first >= self.last:
            reason = f"must be less than last = {self.last!r} (a range ascends)"
            yield problem((*path, "first"), self.first, reason)

    def even(self, points=None) -> dict:
        """Return evenly spaced values, as a parameter of a job."""
        return {"linspace": [self.first, self.last, points or self.points]}

    def geometric(self, points=None) -> dict:
        """Return values with a constant ratio, as a parameter of a job."""
        return {"geomspace": [self.first, self.last, points or self.points]}


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

    def values(self) -> dict:
        """Return the arguments of `Oscillator`."""
        return given(self, OSCILLATOR)


class Entry(Section):
    """An entry of a section; `counts` are the keys whose product is the number of its runs."""

    counts: ClassVar = ()

    def workload(self, path, config):
        """Yield a line for each reason why a job would run without end or out of memory."""
        yield from too_many(path, self, self.counts)
        yield from too_hard(path, self, config)


class WithOscillator(Entry):
    """An entry that names an oscillator."""

    oscillator: text("name of an entry of `oscillators`")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        if self.oscillator not in config.oscillators:
            reason = one_of(self.oscillator, config.oscillators)
            yield problem((*path, "oscillator"), self.oscillator, reason)

    def system(self, config) -> dict:
        """Return the oscillator, as a parameter of a job."""
        return {"system": {"Oscillator": config.oscillators[self.oscillator].values()}}


class WithDamper(keys_of(DAMPER, needed=NEEDED, without=[COMMON]), WithOscillator):
    """An entry with an oscillator and a damper."""

    def system(self, config) -> dict:
        """Return the oscillator and the damper, as parameters of a job."""
        return super().system(config) | {"damper": {"Damper": damper_values(self, config)}}


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
        """Return whether any parameter of the damper is given."""
        return bool(given(self, self.whole))

    def system(self, config) -> dict:
        """Return the oscillator and the damper or None, as parameters of a job."""
        damper = {"Damper": damper_values(self, config)} if self.has_damper() else None
        return super().system(config) | {"damper": damper}


def damper_values(entry, config) -> dict:
    """Return the arguments of `Damper` for an entry, with the number of the clearance `rule`."""
    values = {COMMON: config.contact_stiffness} | given(entry, DAMPER)
    if values.get("clearance") == "rule":
        oscillator = Oscillator(**config.oscillators[entry.oscillator].values())
        values["clearance"] = rule_clearance(oscillator, entry.mass_ratio)
    return values


def too_many(path, section, keys):
    """Yield a line if the product of the counts under some dotted keys is too large for a job."""
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


def too_hard(path, entry, config):
    """Yield the lines of `limits` for an entry, none if it has no mass ratio."""
    key, mass_ratio = _first(entry, "mass_ratios", "mass_ratio")
    if mass_ratio is None:
        return
    _, stiffness = _first(entry, "stiffnesses", "contact_stiffnesses", "contact_stiffness")
    _, frequency = _first(entry, "frequencies", "frequency")
    oscillator = getattr(entry, "oscillator", None)
    if frequency is None and oscillator:
        frequency = config.oscillators[oscillator].frequencies
    place, clearance = _first(entry, "clearances", "clearance")
    if clearance == "rule":
        try:
            clearance = damper_values(entry, config)["clearance"]
        except ValueError as error:
            yield f"{dotted(path)}: no clearance by `rule` with this oscillator: {error}"
            return
    yield from limits(
        path,
        (key, _ends(mass_ratio)[0]),
        _ends(stiffness or config.contact_stiffness)[1],
        _ends(frequency or 1.0)[0],
        (place, clearance and _ends(clearance)[0]),
        config,
    )


def limits(path, mass_ratio, stiffness, frequency, clearance, config):
    """Yield a line if contacts are too stiff for the forcing, or a gap too narrow or too wide.

    `mass_ratio` and `clearance` are pairs of key and smallest value.
    """
    ratio = math.sqrt(stiffness * (1 + 1 / mass_ratio[1])) / frequency
    if ratio > MOST_STIFF:
        reason = f"with r1 = {stiffness:g} and W = {frequency:g} must be so large that "
        reason += (
            f"sqrt(r1 (1 + 1/rm))/W = {ratio:g} is at most {MOST_STIFF:g} (steps of a contact)"
        )
        yield problem((*path, mass_ratio[0]), mass_ratio[1], reason)
    key, value = clearance
    least, most = config.search.radius / MOST_RADIUS, BOUNDS["clearance"]["most"]
    if value is not None and value < least:
        reason = f"must be at least search.radius/{MOST_RADIUS:g} = {least:g} "
        yield problem((*path, key), value, f"{reason}(hardly any start is within the gap)")
    if value is not None and value > most:
        reason = f"must be at most {most:g} (`rule` gives this clearance)"
        yield problem((*path, key), value, reason)


def _first(section, *keys):
    """Return the first of some keys with a value in a section, and the value; or None, None."""
    found = ((key, getattr(section, key, None)) for key in keys)
    return next(((key, value) for key, value in found if value is not None), (None, None))


def _ends(value):
    """Return the smallest and the largest value of a number, a list or a range."""
    if isinstance(value, Range):
        return value.first, value.last
    values = value if isinstance(value, list) else [value]
    return min(values), max(values)
