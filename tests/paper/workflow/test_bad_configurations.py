"""A wrong configuration is refused with a line: the key, its value, and what is allowed."""

import re
import reprlib

from helpers import configurations
from helpers.configurations import changed, problems
from hypothesis import given, settings
from hypothesis import strategies as st

from impact_damper.command.section import dotted

SMALL = configurations.small()
ALLOWED = re.compile(r"(: must |: name must be |: unknown key; known: \w|: missing; needed )")
# Keys of numbers that may be zero.
ZERO_ALLOWED = {"seed", "linear_frequency", "highest_cold", "within", "life_runs", "further"}
# Keys of machines whose numbers are not physical quantities. All other numbers may have units.
NO_QUANTITIES = {"points", "starts", "candidates", "share"}


def places(value, path=()):
    """Yield every path of keys and list positions, with the value there."""
    yield path, value
    if isinstance(value, (dict, list)):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from places(part, (*path, key))


PLACES = dict(places(SMALL))
# Sections with entries that have names.
SECTIONS = {path for path in PLACES if len(path) == 2 and isinstance(PLACES[path], dict)}
SECTIONS = {path[:1] for path in SECTIONS if path[0] != "captions"}


def faults():
    """Yield wrong values with their paths, and what the message must begin with."""
    for path, value in PLACES.items():
        key = dotted(path)
        wrong = []
        if path[::2] == ("release_policies", "dampers") and len(path) == 3 or path in SECTIONS:
            entry = next(iter(value.values()))
            for name in ("", "a b", "../a", "a/b", "é", "a\n", 64 * "a" + "b", 3, None):
                yield path, value | {name: entry}, f"{dotted((*path, name))}: name must be "
        elif isinstance(value, dict) and path[:1] != ("captions",):
            yield (*path, "unknown_key"), 1, f"{dotted((*path, 'unknown_key'))} = 1: unknown key"
        if isinstance(value, dict) and {"first", "last"} <= value.keys():
            last = value["last"]
            told = f"{key}.first = {last!r}: must be less"
            yield path, value | {"first": last, "last": value["first"]}, told
        if isinstance(value, list) and path != ("comparison", "orders"):
            wrong = [[], [*value, value[0]]]
        if isinstance(value, str) and path[-1] != "remark" and path[0] != "captions":
            wrong = [""]
        if path[-1:] == ("oscillator",) or path[-2:-1] == ("data",):
            wrong = ["", "nobody", "yes"]
        if isinstance(value, (int, float)):
            wrong = ["nan", f"{value} cd", False]
            wrong += [-1, -1e-9] if isinstance(path[-1], str) else []
            if path[0] != "machines" or path[-1] in NO_QUANTITIES:
                wrong += [10**20, 1e300, f"{value}"]
                wrong += [0] if isinstance(path[-1], str) and path[-1] not in ZERO_ALLOWED else []
        yield from ((path, each, f"{key} = {reprlib.repr(each)}: ") for each in wrong)


FAULTS = list(faults())


@settings(max_examples=200)
@given(st.sampled_from(FAULTS))
def test_what_is_wrong_is_told(fault):
    path, value, told = fault
    lines = problems(changed(SMALL, path, value))
    assert all(line.isprintable() and ALLOWED.search(line) for line in lines), lines
    assert any(line.startswith(told) for line in lines), (told, lines)
