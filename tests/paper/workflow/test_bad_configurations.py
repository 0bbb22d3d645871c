"""A wrong configuration is refused with a line that names the key, its value and what is allowed.

Each fault is known from the way in which the configuration was made (`helpers.broken`), not from
the models that check the configuration.
"""

import re
import reprlib

import pytest
from helpers.broken import GONE, SMALL, at, broken, changed, junk, places
from hypothesis import given, settings
from hypothesis import strategies as st

from chatterjee1995.sections.configuration import configuration
from impact_damper.command.section import ConfigurationError, check_file, dotted

ALLOWED = re.compile(r"(: must |: name must be |: unknown key; known: \w|: missing; needed )")


def problems(config):
    """Return the lines with which a configuration is refused."""
    with pytest.raises(ConfigurationError) as caught:
        configuration(config)
    return str(caught.value).split("\n")


def test_the_small_configuration_is_accepted():
    configuration(SMALL)


@settings(max_examples=100)
@given(broken)
def test_what_is_broken_is_told(made):
    lines = problems(made.config())
    assert all(line.isprintable() and ALLOWED.search(line) for line in lines), lines
    key = dotted(made.told)
    if made.shown is GONE:
        assert any(line.startswith((f"{key}: ", f"{key}.")) for line in lines), lines
    else:
        told = f"{key} = {reprlib.repr(made.shown)}: "
        assert any(line.startswith(told) for line in lines), (told, lines)


@settings(max_examples=100)
@given(st.sampled_from([path for path, _ in places(SMALL) if path]), junk)
def test_nothing_at_any_place_is_worse_than_rejected(path, value):
    """A random value is refused, or it is accepted and has the type of the valid value."""
    try:
        configuration(changed(path, value).config())
    except ConfigurationError as error:
        assert all(ALLOWED.search(line) for line in str(error).split("\n"))
    else:
        assert type(value) is type(at(path)) or {type(value), type(at(path))} == {int, float}


@settings(max_examples=200)
@given(st.binary(max_size=200) | st.text(max_size=200).map(str.encode))
def test_no_file_is_worse_than_rejected(tmp_path_factory, content):
    file = tmp_path_factory.mktemp("file") / "mine.yaml"
    file.write_bytes(content)
    try:
        check_file(file)
    except ConfigurationError as error:
        assert all(line.startswith("mine.yaml") for line in str(error).split("\n"))
