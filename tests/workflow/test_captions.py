"""Parameters as words in captions."""

from dataclasses import fields
from importlib import import_module

from impact_damper.system.parameters import Damper, Oscillator
from impact_damper.workflow.captions import caption, in_words
from impact_damper.workflow.registry import KINDS


def test_numbers_ranges_lists_and_the_rule_are_told_in_the_order_of_the_fields():
    values = {"frequency": {"first": 1.0, "last": 3.0}, "clearance": "rule", "damping": 0.215}
    assert in_words(values) == "h = 0.215, d0 by (19), W from 1.0 to 3.0"
    assert in_words({"restitution": [0.5, 1], "oscillator": "h215"}) == "e = 0.5, 1"


def test_every_parameter_is_told():
    names = [field.name for part in (Oscillator, Damper) for field in fields(part)]
    assert in_words(dict.fromkeys(names, 0.5)).count("= 0.5") == len(names)


# Captions that may be longer, and why.
LONGER = {
    "branches": "says where and why each kind of branch is not followed further",
    "basins": "says how cells are decided, without and with a damper",
}


def test_captions_are_short_enough_to_be_read():
    for kind in KINDS.values():
        module = import_module(f"impact_damper.{kind.module or f'figures.{kind.name}'}")
        if kind.name not in LONGER and hasattr(module, "CAPTION"):
            assert len(module.CAPTION.split()) <= 90, kind.name


def test_captions_use_the_symbol_of_the_axes():
    figure = {"title": "Response", "cases": "h = 0.2, W from 1 to 3", "remark": "At W = 2, Wp = 3."}
    words = caption(figure, "Against W.")
    assert words == "Response: h = 0.2, Ω from 1 to 3.\nAgainst Ω.\nAt Ω = 2, Ωp = 3."
