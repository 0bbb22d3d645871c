"""Tables in Markdown have a title and at most nine columns with words as heads.

The CSV files have all columns.
"""

import re
from importlib import import_module

import pandas as pd
import pytest
from helpers import configurations
from helpers.made_up import world
from helpers.made_up_design import made_up_design

from chatterjee1995.methods.labels import method_in_words
from chatterjee1995.sections import selection
from chatterjee1995.sections.registry import TABLES
from chatterjee1995.workflow.chapter import make_table
from impact_damper.data.table_files import for_people, in_words

# The table of claims has its own layout and is not tested here.
NAMES = [name for name, table in TABLES.items() if not table.pictures]
CONFIG = configurations.paper()
# Tables for which the invented datasets have all variables. The columns of other tables are tested
# together with the stages that make their data.
INVENTED = (
    "harmonic_balance",
    "subharmonic",
    "optimum",
    "design_rules",
    "migration",
    "release_scan",
    "machines",
)
MOST = 9


@pytest.fixture(scope="module")
def data():
    return world() | {"machines": {"made_up": made_up_design()}}


def heads(name):
    return import_module(TABLES[name].source).SHOWN[name]


@pytest.mark.parametrize("name", NAMES)
def test_at_most_nine_columns_with_different_heads(name):
    shown = heads(name)
    assert 0 < len(shown) <= MOST
    assert len(set(shown.values())) == len(shown)
    assert not any("_" in head for head in shown.values())


def test_every_list_of_columns_belongs_to_a_table():
    modules = {TABLES[name].source for name in NAMES}
    listed = [name for path in modules for name in import_module(path).SHOWN]
    assert sorted(listed) == sorted(NAMES)


@pytest.mark.parametrize("name", INVENTED)
def test_markdown_is_a_title_a_note_and_the_chosen_columns_of_the_csv(name, data, tmp_path):
    make_table(name, selection.table_values(CONFIG, name), data, tmp_path / name)
    lines = (tmp_path / f"{name}.md").read_text().splitlines()
    assert lines[0] == "# " + CONFIG.captions.tables[name].removesuffix(".")
    assert f"`{name}.csv`" in lines[2]
    found = [head.strip() for head in lines[4].replace(r"\|", "/").strip("|").split("|")]
    assert found == [head.replace("|", "/") for head in heads(name).values()]


@pytest.mark.parametrize("name", INVENTED)
def test_cells_for_people_have_no_internal_names(name, data, tmp_path):
    """Words with an underscore are internal names, which only the CSV file may have."""
    make_table(name, selection.table_values(CONFIG, name), data, tmp_path / name)
    rows = [line for line in (tmp_path / f"{name}.md").read_text().splitlines() if line[0:1] == "|"]
    assert [row for row in rows if re.search(r"\w_\w", row)] == []


def test_cells_in_words():
    assert in_words("figure_05a") == "figure 5 (a)"
    assert in_words("figure_03c_rule") == "figure 3 (c), rule"
    assert in_words("figure_10") == "figure 10"
    assert in_words("over_mass_ratio") == "over mass ratio"
    assert in_words("inf") == "∞"
    assert in_words("1.5") == "1.5"
    assert method_in_words("merson") == "Merson"
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


def test_a_table_for_people_shows_the_chosen_rows_and_counts_all():
    frame = pd.DataFrame({"W": ["1", "2", "3"], "stable": ["yes", "no", "yes"]})
    text = for_people(frame, "Events", {"W": "Ω"}, "e.csv", rows=("stable", "yes"))
    assert "`e.csv` has all 2 columns and 3 rows." in text
    cells = [line.strip("| ") for line in text.splitlines() if line.startswith("|")]
    assert cells[2:] == ["1", "3"]
