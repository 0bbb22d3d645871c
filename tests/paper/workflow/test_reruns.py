"""Snakemake plans again exactly the jobs that depend on an edited value or file."""

import json
import re
from fnmatch import fnmatch
from modulefinder import ModuleFinder
from pathlib import Path

import pytest
import yaml
from helpers import configurations
from helpers.running import ROOT, copy_of_project, edits, snakemake
from netCDF4 import Dataset

from chatterjee1995.sections import selection
from chatterjee1995.sections.configuration import configuration
from chatterjee1995.sections.registry import CHAPTERS, STAGES
from chatterjee1995.workflow.kernels import compiled_kernels
from impact_damper.kernel.sources import module_file, sources

pytestmark = pytest.mark.workflow

# Regular expression of the rules that have one job.
ALONE = "chapter_.*|machine_pages|compile_kernels|"
ALONE += "|".join(name for name, stage in STAGES.items() if stage.together)
# The rule `compile_kernels` has no inputs.
SCRIPTS = ("stage", "studies", "chapter", "machine_pages")


def chapters(*names):
    """Return the names of the jobs of chapters of the report."""
    return {f"chapter_{name}" for name in names}


# Edit of a value in the configuration, and the jobs that run again after the edit.
VALUES = [
    (
        ("curves", "figure_08", "clearance", 1.07),
        *(f"{stage}/figure_08" for stage in ("response", "subharmonic", "branches")),
        "harmonic_balance",
        *chapters("design", "responses", "claims"),
    ),
    (("points", "clearances", 47), "optimum", *chapters("clearance", "responses", "claims")),
    (("collisions", "figure_05a", "mass_ratio", 0.13), "collisions", *chapters("claims")),
    (
        ("oscillators", "l100", "damping", 0.22),
        *(f"{stage}/free_l100" for stage in ("response", "branches")),
        *("harmonic_balance", "design_orbit"),
        *chapters("design", "responses", "claims"),
    ),
    (("comparison", "orders", [[12, 15]]), "accuracy/*", *chapters("methods")),
    (("figures", "figure_08", "title", "Again"), *chapters("responses")),
]
# Files, and the jobs that run again after an edit.
FILES = {
    "src/impact_damper/plot/pages/templates/design.jinja": {"machine_pages"},
    "src/chatterjee1995/tables/migration.py": chapters("migration"),
    "src/chatterjee1995/claims/claims.yaml": chapters("claims"),
    "src/chatterjee1995/stages/studies.py": {
        *("study_chunks/*", "studies/design_plane"),
        *chapters("clearance", "responses"),
    },
    "src/impact_damper/motions/legs.py": {
        *("migration/*", "release_scan/*", "release_policies/*"),
        *chapters("migration", "claims"),
    },
}


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """Return a copy of the project that looks as after a complete run; all results are empty."""
    project = copy_of_project(tmp_path_factory.mktemp("a project"))
    for line in snakemake(project, "everything", "--summary").stdout.splitlines()[1:]:
        output = project / line.split("\t")[0]
        output.parent.mkdir(parents=True, exist_ok=True)
        with Dataset(output, "w") if output.suffix == ".nc" else output.open("w"):
            pass
    config = configurations.read(project / "config/config.yaml")
    (project / "results/kernels.compiled").write_text(
        compiled_kernels(config["comparison"]["orders"])
    )
    result = snakemake(project, "everything", "--touch", "--forceall")
    assert result.returncode == 0, result.stdout + result.stderr
    return project


@pytest.fixture(scope="module")
def config(project):
    return configurations.read(project / "config/config.yaml")


@pytest.fixture
def edit(project):
    with edits(project) as change:
        yield change


def to_do(project):
    """Return the names of the jobs that Snakemake would run, and of all jobs."""
    result = snakemake(project, "everything", "--summary")
    assert result.returncode == 0, result.stdout + result.stderr
    planned, known = set(), set()
    for line in result.stdout.splitlines()[1:]:
        output, _, rule, *_, plan = line.split("\t")
        name = rule if re.fullmatch(ALONE, rule) else f"{rule}/{Path(output).stem}"
        known.add(name)
        if plan != "no update":
            planned.add(name)
    return planned, known


def matching(jobs, patterns):
    """Return the jobs whose names match one of the patterns."""
    return {job for job in jobs if any(fnmatch(job, pattern) for pattern in patterns)}


def test_an_edit_of_values_concerns_what_reads_them(project, edit, config):
    edited, concerned = config, set()
    for (*path, value), *jobs in VALUES:
        edited = configurations.changed(edited, path, value)
        concerned.update(jobs)
    edit("config/config.yaml", lambda _: yaml.safe_dump(edited, sort_keys=False))
    planned, known = to_do(project)
    assert planned == matching(known, concerned)


def test_an_edit_of_files_concerns_what_runs_them(project, edit):
    """The edits concern a table, claims, a template, and modules of one and of several stages."""
    for path in FILES:
        edit(path, lambda text: text + "\n")
    planned, known = to_do(project)
    assert planned == matching(known, set().union(*FILES.values()))


def test_a_configuration_is_checked_again_after_an_edit(project, edit, config):
    """Only the configuration of the last complete run is not checked again."""
    assert "checked" in json.loads((project / "results/provenance.json").read_text())
    below = config["settling"]["patience"] - 1
    wrong = configurations.changed(config, ["settling", "limit"], below)
    edit("config/config.yaml", lambda _: yaml.safe_dump(wrong, sort_keys=False))
    result = snakemake(project, "-n")
    assert result.returncode == 1 and "settling.limit" in result.stdout + result.stderr


@pytest.mark.parametrize("script", SCRIPTS)
def test_sources_of_a_script_are_what_python_imports(script, config):
    """Python's own search for imports finds the files that `sources` finds."""
    paths = [ROOT / f"workflow/scripts/{script}.py"]
    whole = configuration(config, trusted=True)
    if script == "chapter":
        modules = {m for chapter in CHAPTERS for m in selection.chapter_modules(whole, chapter)}
        paths += map(module_file, modules)
    if script == "stage":
        paths += {module_file(stage.function.split(":")[0]) for stage in STAGES.values()}
    finder = ModuleFinder(path=[str(ROOT / "src")])
    for path in paths:
        finder.run_script(str(path))
    found = {Path(m.__file__) for m in finder.modules.values() if m.__file__} | set(paths)
    own = sources(*paths, *map(module_file, ("chatterjee1995", "chatterjee1995.workflow.job")))
    # `sources` omits an `__init__.py` from which no name is imported, and modules imported only
    # there, such as all plots: these files affect no result.
    plots = sources(module_file("impact_damper.plot"))
    assert {path.name for path in found - own - plots} <= {"__init__.py"}


def test_touched_files_comments_and_order_rerun_nothing(project, edit, config):
    for part in ("src", "workflow", "config"):
        for path in (project / part).rglob("*.*"):
            path.touch()

    def turned(value):
        if not isinstance(value, dict):
            return value
        return {key: turned(part) for key, part in reversed(value.items())}

    again = f"# A word.\n{yaml.safe_dump(turned(config), sort_keys=False)}"
    edit("config/config.yaml", lambda _: again)
    marker = project / "results/kernels.compiled"
    text = marker.read_text()
    marker.unlink()
    result = snakemake(project, "-n")
    marker.write_text(text)
    assert "Nothing to be done" in result.stdout + result.stderr
