"""Pages of tables: a title, a note and the first nine columns, in words."""

import re
from importlib import import_module

import pytest
from helpers import configurations
from helpers.made_up import world
from helpers.made_up_design import made_up_design

from chatterjee1995.methods.labels import method_in_words
from chatterjee1995.sections import selection
from chatterjee1995.sections.registry import TABLES
from chatterjee1995.tables.files import SHOWN, in_words
from chatterjee1995.workflow.chapter import make_table

CONFIG = configurations.paper()
# Tables for which the invented datasets have all variables. Tests of stages make the other tables.
INVENTED = ("harmonic_balance", "subharmonic", "optimum", "migration", "release_scan", "machines")


@pytest.fixture(scope="module")
def data():
    return world() | {"machines": {"made_up": made_up_design()}}


@pytest.mark.parametrize("name", INVENTED)
def test_a_page_shows_the_first_columns_of_the_csv_in_words(name, data, tmp_path):
    make_table(name, selection.table_values(CONFIG, name), data, tmp_path / name)
    lines = (tmp_path / f"{name}.md").read_text().splitlines()
    assert lines[0] == "# " + CONFIG.captions.tables[name].removesuffix(".")
    assert f"`{name}.csv`" in lines[2]
    heads = [head.strip() for head in lines[4].replace(r"\|", "/").strip("|").split("|")]
    frame = getattr(import_module(TABLES[name].source), name)(data)
    assert heads == [head.replace("|", "/") for head in frame.columns[:SHOWN]]
    assert len(set(frame.columns)) == frame.shape[1] >= SHOWN
    assert [row for row in lines[4:] if re.search(r"\w_\w", row)] == []


def test_cells_in_words():
    assert in_words("figure_05a") == "figure 5 (a)"
    assert in_words("figure_03c_rule") == "figure 3 (c), rule"
    assert in_words("figure_10") == "figure 10"
    assert in_words("over_mass_ratio") == "over mass ratio"
    assert in_words("inf") == "∞"
    assert method_in_words("merson_kink") == "Merson, kink"
    assert method_in_words("taylor_12_15") == "Taylor, orders 12 and 15"
    assert method_in_words("rigid_mended") == "rigid, corrected"


def test_a_table_without_data_says_so(tmp_path):
    make_table("optimum", selection.table_values(CONFIG, "optimum"), {}, tmp_path / "optimum")
    lines = (tmp_path / "optimum.md").read_text().splitlines()
    assert lines[4:] == ["The configuration has no data for this table."]


def test_claims_show_the_figures_that_the_run_draws(tmp_path):
    given = selection.table_values(CONFIG, "claims")
    assert "figure_05a" in given["drawn"] and "machines" not in given["drawn"]
    make_table("claims", given | {"drawn": ["figure_06"]}, {}, tmp_path / "claims")
    shown = re.findall(r"figures/(\w+)\.png", (tmp_path / "claims.md").read_text())
    assert set(shown) == {"figure_06"}
