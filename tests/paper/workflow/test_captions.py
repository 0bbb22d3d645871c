"""Captions of figures, and the parameters in them as text."""

from types import SimpleNamespace

import pytest
from helpers import configurations

from chatterjee1995.sections import selection
from chatterjee1995.sections.selection import caption, cases_in_words, in_words

CONFIG = configurations.paper()


def test_numbers_ranges_lists_and_the_rule_in_the_order_of_the_fields():
    span = SimpleNamespace(first=1.0, last=3.0)
    values = {"frequency": span, "clearance": "rule", "damping": 0.215, "linear_frequency": 0}
    assert in_words(values) == ["h = 0.215", "d0 by (19)", "W from 1 to 3"]
    assert in_words({"restitution": [0.5, 1], "oscillator": "h215"}) == ["e = 0.5, 1"]
    assert in_words({"contact_stiffness": [1e6, 1, 2, 3, 4, 5]}) == ["r1 from 1 to 1e6"]


def test_shared_parameters_stand_once():
    light, heavy = ["h = 0.2", "rm = 0.1"], ["h = 0.2", "rm = 0.4"]
    assert cases_in_words({"a": light}) == "h = 0.2, rm = 0.1"
    assert cases_in_words({"a_c": light, "b": heavy}) == (
        "h = 0.2; a c with rm = 0.1; b with rm = 0.4"
    )
    assert cases_in_words({"elastic_model": []}) == ""


@pytest.mark.parametrize("name", sorted(CONFIG.figures))
def test_the_caption_of_a_figure_can_be_rendered_and_read(name):
    """Title and parameters do not count among the 90 words; Ω stands for W, as on the axes."""
    figure, text = CONFIG.figures[name], selection.figure_values(CONFIG, name)["caption"]
    assert text.startswith(caption(figure.title, "", "", "").rstrip("."))
    # In reStructuredText a text between bars is the name of a substitution.
    assert "|" not in text.replace(r"\|", "")
    assert "W" not in text.split()
    assert len(f"{CONFIG.captions.figures[figure.kind]} {figure.remark}".split()) <= 90
