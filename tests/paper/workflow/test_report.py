"""Every figure has a caption that can be rendered and read."""

import pytest
from helpers import configurations

from chatterjee1995.workflow import selection

CONFIG = configurations.paper()


@pytest.mark.parametrize("name", sorted(CONFIG.figures))
def test_caption_of_a_figure(name):
    text = selection.figure_values(CONFIG, name)["caption"]
    assert text.startswith(CONFIG.figures[name].title)
    # In reStructuredText a text between bars is the name of a substitution.
    assert "|" not in text.replace(r"\|", "")


@pytest.mark.parametrize("name", sorted(CONFIG.figures))
def test_caption_is_short_enough_to_be_read(name):
    """Only the text on the kind of figure and the remark count, without title and parameters."""
    figure = CONFIG.figures[name]
    text = CONFIG.captions.figures[figure.kind]
    assert len(f"{text} {figure.remark}".split()) <= 90
    # This sentence belongs to all figures and stands once, in workflow/report/workflow.rst.
    assert "no such figure" not in text
