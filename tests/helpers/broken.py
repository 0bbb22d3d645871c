"""Wrong configurations with one known fault each, drawn at random by hypothesis."""

import copy
from typing import NamedTuple

from hypothesis import strategies as st
from snakemake.utils import update_config

from chatterjee1995.sections.clearance import AXES as STUDY_AXES
from chatterjee1995.sections.configuration import without_left_out
from helpers import configurations
from helpers.running import ROOT

GONE = object()
# Keys with whole numbers, in sections that also have other values.
WHOLE = {"starts", "sweep_starts", "scan_starts", "study_starts", "chunks", "longest_hold"}
WHOLE |= {"highest_cold", "period"}
WHOLE |= {"lifetime", "highest", "candidates", "periods", "passages", "points", "most_steps"}
# Keys of numbers that may be zero.
ZERO_ALLOWED = {"seed", "linear_frequency", "highest_cold", "within"}


def small_configuration():
    """Return the configuration of the smoke run, which has one or two entries in each section."""
    config = configurations.read()
    update_config(config, configurations.read(ROOT / "config/smoke.yaml"))
    return without_left_out(config)


SMALL = small_configuration()


class Broken(NamedTuple):
    """A change that makes the small configuration wrong: a value at a path of keys.

    The message must name the path `told` and the value `shown`. As a value GONE removes the key; as
    `shown` it says that the message names no value.
    """

    place: tuple
    value: object
    told: tuple
    shown: object

    def config(self):
        """Return the wrong configuration."""
        config = parent = copy.copy(SMALL)
        for key in self.place[:-1]:
            parent[key] = parent = copy.copy(parent[key])
        if self.value is GONE:
            del parent[self.place[-1]]
        else:
            parent[self.place[-1]] = self.value
        return config


def places(value, path=()):
    """Yield every path of keys and list positions, with the value there."""
    yield path, value
    if isinstance(value, (dict, list)):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from places(part, (*path, key))


def is_named(path):
    """Return whether the keys at a path are names of entries, which the user chooses."""
    if len(path) == 3 and path[::2] == ("release_policies", "dampers"):
        return True
    return len(path) == 1 and isinstance(next(iter(SMALL[path[0]].values())), dict)


def is_number(value):
    return isinstance(value, (int, float))


def at(path):
    """Return the value of the small configuration at a path."""
    place = SMALL
    for key in path:
        place = place[key]
    return place


MAPPINGS = [path for path, value in places(SMALL) if isinstance(value, dict)]
FIXED = [path for path in MAPPINGS if not is_named(path)]
NAMED = [path for path in MAPPINGS if is_named(path)]
# Keys that take a number or a range.
AXES = [("studies", name, key) for name in SMALL["studies"] for key in STUDY_AXES]
# Numbers of machines that are not physical quantities; all others may also be texts with units.
NO_QUANTITIES = ("points", "starts", "candidates", "share")
QUANTITIES = [
    path
    for path, value in places(SMALL)
    if path[:1] == ("machines",) and is_number(value) and path[-1] not in NO_QUANTITIES
]
NUMBERS = [path for path, value in places(SMALL) if is_number(value) and path not in QUANTITIES]
TEXTS = [path for path, value in places(SMALL) if isinstance(value, str)]
# Lists that must not be empty; `comparison.orders` may be.
LISTS = [
    path
    for path, value in places(SMALL)
    if isinstance(value, list) and path != ("comparison", "orders")
]
RANGES = [path for path in FIXED if {"first", "last"} <= at(path).keys()]
COUNTS = [
    path
    for path in NUMBERS
    if path[0] in ("points", "settling", "controller", "comparison")
    and isinstance(at(path), int)
    or "cells" in path
    or path[-1] in WHOLE
]
REFERENCES = [p for p in TEXTS if p[-1] == "oscillator" or p[-2:-1] == ("data",)]

junk_text = st.text(max_size=20) | st.sampled_from(["nan", "1e-9", "2 000", "0,5", "yes", "\n"])
junk = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | junk_text
    | st.dates()
    | st.binary(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(junk_text | st.integers() | st.none(), inner, max_size=4)
    ),
    max_leaves=8,
)


def changed(path, value):
    """Return the change that sets or removes one value of the small configuration."""
    return Broken(path, value, path, value)


@st.composite
def unknown_key(draw):
    path = draw(st.sampled_from(FIXED))
    known = {key for place in FIXED for key in at(place)}
    key = draw((junk_text | st.integers() | st.none()).filter(lambda key: key not in known))
    return changed((*path, key), draw(junk))


@st.composite
def text_for_a_number(draw):
    path = draw(st.sampled_from(NUMBERS))
    form = draw(st.sampled_from(["{}", "{} ", "+{}", "{}e0", "{} Hz", "{!r}", "0x{}"]))
    return changed(path, form.format(at(path)))


@st.composite
def wrong_unit(draw):
    path = draw(st.sampled_from(QUANTITIES))
    form = draw(st.sampled_from(["{} cd", "{} kg^2", "{} units", "{}; 1", "-{} s^9", "nan"]))
    return changed(path, form.format(at(path)))


@st.composite
def negative_or_zero(draw):
    path = draw(st.sampled_from([path for path in NUMBERS if isinstance(path[-1], str)]))
    below = st.integers(-(10**12), -1) | st.floats(-1e12, -1e-12)
    if path[-1] not in ZERO_ALLOWED:
        below |= st.sampled_from([0, 0.0, -0.0])
    return changed(path, draw(below))


@st.composite
def too_large(draw):
    path = draw(st.sampled_from(NUMBERS))
    above = st.integers(10**10, 10**40) if path in COUNTS else st.floats(1e10, 1e300)
    return changed(path, draw(above))


@st.composite
def endless_grid(draw):
    return changed(draw(st.sampled_from(COUNTS)), draw(st.integers(10**9, 10**12)))


@st.composite
def empty(draw):
    named = [path for path in NAMED if len(path) == 1]
    texts = [path for path in TEXTS if path[-1] != "remark"]
    path = draw(st.sampled_from(LISTS + FIXED[1:] + named + texts))
    made = changed(path, type(at(path))())
    # For a mapping the message names the missing keys, not the value.
    return made._replace(shown=GONE) if path in FIXED else made


@st.composite
def reversed_range(draw):
    path = draw(st.sampled_from(RANGES))
    span = at(path)
    first, last = draw(
        st.sampled_from([(span["last"], span["first"]), (span["last"],) * 2, (span["first"],) * 2])
    )
    made = changed(path, span | {"first": first, "last": last})
    return made._replace(told=(*path, "first"), shown=first)


@st.composite
def repeated(draw):
    path = draw(st.sampled_from(LISTS))
    values = at(path)
    return changed(path, [*values, draw(st.sampled_from(values))])


@st.composite
def bad_name(draw):
    path = draw(st.sampled_from(NAMED))
    entry = next(iter(at(path).values()))
    name = draw(
        st.sampled_from(["", "a b", "../a", "a/b", "a.nc", "_a", "é", "a\n", "{x}", "<results>"])
        | st.text("abc", min_size=65, max_size=300)
        | st.integers()
        | st.none()
    )
    made = changed(path, at(path) | {name: entry})
    return made._replace(told=(*path, name), shown=GONE)


@st.composite
def unknown_reference(draw):
    path = draw(st.sampled_from(REFERENCES))
    return changed(path, draw(junk_text.filter(lambda name: name != at(path))))


broken = st.one_of(
    unknown_key(),
    text_for_a_number(),
    wrong_unit(),
    negative_or_zero(),
    too_large(),
    endless_grid(),
    empty(),
    reversed_range(),
    repeated(),
    bad_name(),
    unknown_reference(),
)
