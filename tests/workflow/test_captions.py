"""Parameters as words in captions."""

from dataclasses import fields

from impact_damper.system.parameters import Damper, Oscillator
from impact_damper.workflow.captions import in_words


def test_numbers_ranges_lists_and_the_rule_are_told_in_the_order_of_the_fields():
    values = {"frequency": {"first": 1.0, "last": 3.0}, "clearance": "rule", "damping": 0.215}
    assert in_words(values) == "h = 0.215, d0 by (19), W from 1.0 to 3.0"
    assert in_words({"restitution": [0.5, 1], "oscillator": "h215"}) == "e = 0.5, 1"


def test_every_parameter_is_told():
    names = [field.name for part in (Oscillator, Damper) for field in fields(part)]
    assert in_words(dict.fromkeys(names, 0.5)).count("= 0.5") == len(names)
