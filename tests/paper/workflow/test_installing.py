"""Files for installing and citing against pyproject.toml, the Makefile and the lock file."""

import ast
import re
import subprocess
import sys
import tomllib
from importlib.metadata import packages_distributions
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
    assert re.findall(r"apt-get install(?: --\S+)* (.*) \\", text) == ["gcc libc6-dev make"]
    assert re.search(r"^\$\(READY\): .*\n(\t.*\n)*\t.* requirements\.lock ", makefile, re.M)
    assert (TOP / "requirements.lock").exists()
    left_out = (TOP / ".dockerignore").read_text().split()
    assert not {"src", "workflow", "config", "requirements.lock", "Makefile"}.intersection(left_out)


def test_the_files_for_citing_and_the_environment_of_jobs_are_those_of_pyproject(tmp_path):
    subprocess.run([sys.executable, TOP / "workflow/citation.py", tmp_path], check=True)
    made = [path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()]
    assert len(made) == 3
    for path in made:
        assert (tmp_path / path).read_text() == (TOP / path).read_text(), "run `make citation`"


def test_the_environment_of_jobs_has_what_their_sources_import():
    listed = re.findall(r"^  - (\S+)", (TOP / "workflow/envs/impact-damper.yaml").read_text(), re.M)
    sources = [*TOP.glob("src/**/*.py"), *TOP.glob("workflow/scripts/*.py")]
    nodes = [node for path in sources for node in ast.walk(ast.parse(path.read_text()))]
    names = {each.name for node in nodes if isinstance(node, ast.Import) for each in node.names}
    names |= {node.module for node in nodes if isinstance(node, ast.ImportFrom)}
    found = packages_distributions()
    packages = {each for name in names for each in found.get(name.partition(".")[0], [])}
    plain = [{re.sub(r"[-_.]+", "-", each).lower() for each in many} for many in (packages, listed)]
    assert {"llvmlite", "pyyaml", "pydantic-core"} <= plain[0]
    assert plain[0] - {"impact-damper", "snakemake"} <= plain[1]
