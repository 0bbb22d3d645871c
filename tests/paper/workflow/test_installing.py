"""Files for installing and citing against pyproject.toml, the Makefile and the lock file."""

import re
import subprocess
import sys
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


def test_the_container_installs_and_calls_what_exists():
    """The image has a Python that the project allows, and each target of `make` is there."""
    text = (TOP / "Containerfile").read_text()
    (image,) = re.findall(r"^FROM docker\.io/library/python:([\d.]+)-slim", text, re.M)
    project = tomllib.loads((TOP / "pyproject.toml").read_text())["project"]
    assert f"Programming Language :: Python :: {image}" in project["classifiers"]
    makefile = (TOP / "Makefile").read_text()
    called = [*re.findall(r"^RUN make (\w+)", text, re.M), *re.findall(r'CMD \["(\w+)"\]', text)]
    assert len(called) == 2
    assert all(re.search(rf"^{target}( \w+)*:", makefile, re.M) for target in called)
    left_out = (TOP / ".dockerignore").read_text().split()
    assert not {"src", "workflow", "config", "requirements.lock", "Makefile"}.intersection(left_out)


def test_the_files_for_citing_are_those_of_pyproject(tmp_path):
    subprocess.run([sys.executable, TOP / "workflow/citation.py", tmp_path], check=True)
    for made in tmp_path.iterdir():
        assert made.read_text() == (TOP / made.name).read_text(), "run `make citation`"
    assert len(list(tmp_path.iterdir())) == 2
