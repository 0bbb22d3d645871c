"""Tables for people: a title, at most nine columns with words as heads; the CSV has the others."""

from importlib import import_module

import pytest
from helpers.made_up import world
from helpers.made_up_design import made_up_design

from impact_damper.workflow.chapter import make_table
from impact_damper.workflow.registry import TABLES

# The table of claims has a layout of its own.
NAMES = [name for name, table in TABLES.items() if table.module != "claims.verdicts"]
# Tables that the invented datasets have all variables of; the columns of others are tested with the
# stages that make their data.
INVENTED = (
    "harmonic_balance",
    "bands",
    "subharmonic",
    "optimum",
    "design_rules",
    "migration",
    "release_scan",
    "readings",
    "machines",
)
MOST = 9


@pytest.fixture(scope="module")
def data():
    return world() | {"machines": {"made_up": made_up_design()}}


def heads(name):
    return import_module(f"impact_damper.{TABLES[name].module}").SHOWN[name]


@pytest.mark.parametrize("name", NAMES)
def test_at_most_nine_columns_with_different_heads(name):
    shown = heads(name)
    assert 0 < len(shown) <= MOST
    assert len(set(shown.values())) == len(shown)
    assert not any("_" in head for head in shown.values())


def test_every_list_of_columns_belongs_to_a_table():
    modules = {TABLES[name].module for name in NAMES}
    listed = [name for path in modules for name in import_module(f"impact_damper.{path}").SHOWN]
    assert sorted(listed) == sorted(NAMES)


@pytest.mark.parametrize("name", INVENTED)
def test_markdown_is_a_title_a_note_and_the_chosen_columns_of_the_csv(name, data, tmp_path):
    make_table(name, data, tmp_path / name)
    lines = (tmp_path / f"{name}.md").read_text().splitlines()
    assert lines[0] == "# " + TABLES[name].caption.removesuffix(".")
    assert f"`{name}.csv`" in lines[2]
    found = [head.strip() for head in lines[4].replace(r"\|", "/").strip("|").split("|")]
    assert found == [head.replace("|", "/") for head in heads(name).values()]


def test_a_table_without_data_says_so(tmp_path):
    make_table("bands", {}, tmp_path / "bands")
    lines = (tmp_path / "bands.md").read_text().splitlines()
    assert lines[4:] == ["The configuration has no data for this table."]
