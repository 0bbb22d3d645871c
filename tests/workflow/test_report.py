"""Every kind of figure and every table has a caption that can be rendered."""

import jinja2
import pytest
import yaml
from helpers.running import ROOT

from impact_damper.workflow import selection
from impact_damper.workflow.registry import KINDS, TABLES

CONFIG = yaml.safe_load((ROOT / "config/config.yaml").read_text())
TEMPLATES = {path.stem: path for path in (ROOT / "workflow/report").glob("*.rst")}


def test_each_kind_of_figure_has_a_template():
    assert TEMPLATES.keys() == KINDS.keys() | {"workflow"}


@pytest.mark.parametrize("name", CONFIG["figures"])
def test_caption_of_a_figure(name):
    figure = selection.figure_values(CONFIG, name)
    template = TEMPLATES[figure["kind"]].read_text()
    caption = jinja2.Template(template, undefined=jinja2.StrictUndefined).render(figure=figure)
    assert caption.startswith(figure["title"])
    # Between bars reStructuredText expects the name of a substitution.
    assert "|" not in caption.replace(r"\|", "")


def test_each_table_has_a_caption():
    assert all(table.caption.endswith(".") for table in TABLES.values())
