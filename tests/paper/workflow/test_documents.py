"""Documents name only files that exist; the environment of jobs is complete."""

import re
import tomllib

import yaml
from helpers.running import ROOT


def test_the_walk_throughs_name_files_that_exist():  # or would, in two of the examples
    text = (ROOT / "CONTRIBUTING.md").read_text()
    named = re.findall(r"`((?:src|tests|workflow|config)/[\w/]+\.\w+)`", text)
    assert len(named) > 10
    named = [name for name in named if "quintic" not in name and "contact_times" not in name]
    assert not [name for name in named if not (ROOT / name).exists()]


def bounds(lines):
    """Return the lower bound of each package, by its name in lower case."""
    found = dict(re.match(r"([\w-]+) *>=(.*)", line).groups() for line in lines)
    return {name.lower().replace("-", "_"): bound for name, bound in found.items()}


def test_the_environment_of_jobs_has_the_packages_of_the_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    listed = project["dependencies"] + project["optional-dependencies"]["workflow"]
    wanted = bounds(listed) | {"python": project["requires-python"].removeprefix(">=")}
    given = yaml.safe_load((ROOT / "workflow/envs/impact-damper.yaml").read_text())
    del wanted["snakemake"]  # Snakemake is no part of the environment of the jobs
    assert bounds(given["dependencies"]) == wanted
