"""Captions of figures, and the parameters in them as text."""

from types import SimpleNamespace

import pytest
from helpers import configurations

from chatterjee1995.sections import selection
from chatterjee1995.sections.selection import caption, cases_in_words, in_words

CONFIG = configurations.paper()


def test_numbers_ranges_lists_and_the_rule_are_told_in_the_order_of_the_fields():
    span = SimpleNamespace(first=1.0, last=3.0)
    values = {"frequency": span, "clearance": "rule", "damping": 0.215}
    assert list(in_words(values).items()) == [
        ("h", "= 0.215"), ("d0", "by (19)"), ("W", "from 1 to 3")
    ]  # fmt: skip
    assert in_words({"restitution": [0.5, 1], "oscillator": "h215"}) == {"e": "= 0.5, 1"}
    assert in_words({"contact_stiffness": [1e6, 1, 2, 3, 4, 5]}) == {"r1": "from 1 to 1e6"}
    assert in_words({"linear_frequency": 0, "damping": 0.1}) == {"h": "= 0.1"}


def test_shared_parameters_are_told_once():
    light, heavy = {"h": "= 0.2", "rm": "= 0.1"}, {"h": "= 0.2", "rm": "= 0.4"}
    assert cases_in_words({"a": light}) == "h = 0.2, rm = 0.1"
    assert cases_in_words({"a": light, "b": heavy}) == "h = 0.2; rm = 0.1, 0.4"
    assert cases_in_words({"a": light, "b": {"h": "= 0.2"}}) == "h = 0.2; rm = 0.1"
    other = {"h": "= 0.3", "rm": "= 0.4"}
    assert cases_in_words({"a": light, "b": other}) == "h = 0.2, rm = 0.1; h = 0.3, rm = 0.4"
    named = cases_in_words({"a_c": light, "b": heavy}, named=True)
    assert named == "h = 0.2; a c: rm = 0.1; b: rm = 0.4"
    assert cases_in_words({"elastic_model": {}}) == ""


def test_captions_use_the_symbol_of_the_axes():
    words = caption("Response", "h = 0.2, W from 1 to 3", "Against W²; |Z1|.", "At W = 2, Wp = 3.")
    assert words == "Response: h = 0.2, Ω from 1 to 3.\nAgainst Ω²; \\|Z1\\|.\nAt Ω = 2, Ωp = 3."


@pytest.mark.parametrize("name", sorted(CONFIG.figures))
def test_the_caption_of_a_figure_can_be_rendered_and_read(name):
    """Title and parameters do not count among the 90 words."""
    figure, text = CONFIG.figures[name], selection.figure_values(CONFIG, name)["caption"]
    assert text.startswith(figure.title)
    # In reStructuredText a text between bars is the name of a substitution.
    assert "|" not in text.replace(r"\|", "")
    assert len(f"{CONFIG.captions.figures[figure.kind]} {figure.remark}".split()) <= 90
