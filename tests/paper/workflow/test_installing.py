"""Files for installing and citing against pyproject.toml, the Makefile and the lock file."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

TOP = Path(__file__).parents[3]


def test_the_container_installs_and_calls_what_exists():
    """The image has a Python that the project allows. The Makefile has each target called."""
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
