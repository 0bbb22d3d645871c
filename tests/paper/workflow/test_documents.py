"""The documents name every stage, and only files that exist."""

import re

from helpers.running import ROOT

from chatterjee1995.sections.registry import STAGES


def test_the_table_of_stages_has_every_stage():
    table = "".join(re.findall(r"^\| (.*?) \|", (ROOT / "config/README.md").read_text(), re.M))
    named = set(re.findall("`(.*?)`", table))
    assert named >= STAGES.keys(), "config/README.md: the table of stages lacks some"


def test_the_walk_throughs_name_files_that_exist():
    text = (ROOT / "CONTRIBUTING.md").read_text()
    named = re.findall(r"`((?:src|tests|workflow|config)/[\w/]+\.\w+)`", text)
    assert len(named) > 10
    # `quintic` is an example of a parameter that does not exist.
    assert not [name for name in named if not (ROOT / name).exists() and "quintic" not in name]
