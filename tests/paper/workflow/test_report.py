"""Every kind of figure and every table has a caption that can be rendered."""

from importlib import import_module

import pytest
from helpers import configurations

from chatterjee1995.workflow import selection
from chatterjee1995.workflow.captions import caption
from chatterjee1995.workflow.registry import KINDS, TABLES

CONFIG = configurations.read()


@pytest.mark.parametrize("name", CONFIG["figures"])
def test_caption_of_a_figure(name):
    figure = selection.figure_values(CONFIG, name)
    module = import_module(KINDS[figure["kind"]].source)
    text = caption(figure, module.CAPTION)
    assert text.startswith(figure["title"])
    # In reStructuredText a text between bars is the name of a substitution.
    assert "|" not in text.replace(r"\|", "")


@pytest.mark.parametrize("name", CONFIG["figures"])
def test_caption_is_short_enough_to_be_read(name):
    """Only the text on the kind of figure and the remark count, without title and parameters."""
    figure = CONFIG["figures"][name]
    text = import_module(KINDS[figure["kind"]].source).CAPTION
    assert len(f"{text} {figure['remark']}".split()) <= 90
    # This sentence belongs to all figures and stands once, in workflow/report/workflow.rst.
    assert "no such figure" not in text


def test_each_table_has_a_caption():
    assert all(table.caption.endswith(".") for table in TABLES.values())
