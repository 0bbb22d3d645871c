"""The environment file of jobs against pyproject.toml."""

import re
import tomllib
from pathlib import Path

import yaml

TOP = Path(__file__).parents[3]
# Snakemake runs the jobs, and is no part of their environment.
OUTSIDE = {"snakemake"}


def bounds(lines):
    """Return the lower bound of each package, by its name in lower case."""
    found = dict(re.match(r"([\w-]+) *>=(.*)", line).groups() for line in lines)
    return {name.lower().replace("-", "_"): bound for name, bound in found.items()}


def test_the_environment_of_jobs_has_the_packages_of_the_project():
    project = tomllib.loads((TOP / "pyproject.toml").read_text())["project"]
    listed = project["dependencies"] + project["optional-dependencies"]["workflow"]
    wanted = bounds(listed) | {"python": project["requires-python"].removeprefix(">=")}
    given = yaml.safe_load((TOP / "workflow/envs/impact-damper.yaml").read_text())
    assert bounds(given["dependencies"]) == {
        name: bound for name, bound in wanted.items() if name not in OUTSIDE
    }
