"""Every caption of the report can be rendered, and every table has one."""

import ast
from pathlib import Path
from types import SimpleNamespace

import jinja2
import pytest
import yaml

ROOT = Path(__file__).parents[2]
TEMPLATES = sorted((ROOT / "workflow/report").glob("*.rst"))


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda path: path.stem)
def test_template_is_well_formed(path):
    jinja2.Environment().parse(path.read_text())


def test_every_table_has_a_caption():
    rules = (ROOT / "workflow/rules/jobs.smk").read_text()
    tables = ast.literal_eval(rules.split("TABLES = ")[1].split("\n}\n")[0] + "}")
    template = jinja2.Template((ROOT / "workflow/report/table.rst").read_text())
    for table in set(tables) - {"claims"}:
        wildcards = SimpleNamespace(table=table)
        assert template.render(snakemake=SimpleNamespace(wildcards=wildcards)).endswith(".")


def test_no_remark_holds_what_the_report_takes_for_markup():
    """Between bars reStructuredText wants the name of a text to put there."""
    figures = yaml.safe_load((ROOT / "config/config.yaml").read_text())["figures"]
    assert not [name for name, figure in figures.items() if "|" in figure.get("remark", "")]
