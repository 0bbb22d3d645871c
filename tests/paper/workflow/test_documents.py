"""Documents name only files that exist."""

import re

from helpers.running import ROOT


def test_the_walk_throughs_name_files_that_exist():  # or would, in two of the examples
    text = (ROOT / "CONTRIBUTING.md").read_text()
    named = re.findall(r"`((?:src|tests|workflow|config)/[\w/]+\.\w+)`", text)
    assert len(named) > 10
    named = [name for name in named if "quintic" not in name and "contact_times" not in name]
    assert not [name for name in named if not (ROOT / name).exists()]
