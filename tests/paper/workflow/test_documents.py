"""The documents name every stage, and only files that exist."""

import re

from helpers.running import ROOT

from chatterjee1995.sections.registry import STAGES


def test_the_table_of_stages_has_every_stage():
    table = "".join(re.findall(r"^\| (.*?) \|", (ROOT / "config/README.md").read_text(), re.M))
    lacking = STAGES.keys() - set(re.findall("`(.*?)`", table))
    assert not lacking, f"config/README.md: the table of stages lacks {lacking}"


def test_the_walk_throughs_name_files_that_exist():
    text = (ROOT / "CONTRIBUTING.md").read_text()
    named = re.findall(r"`((?:src|tests|workflow|config)/[\w/]+\.\w+)`", text)
    assert len(named) > 30
    assert [name for name in named if not (ROOT / name).exists()] == []
