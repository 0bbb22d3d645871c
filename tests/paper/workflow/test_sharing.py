"""Checkouts share results through a cache if parameters, sources and lock file agree."""

import inspect
import json

import pytest
import yaml
from helpers import configurations
from helpers.running import ROOT, copy_of_project, edits, snakemake
from netCDF4 import Dataset

from chatterjee1995.workflow import job
from chatterjee1995.workflow.kernels import compiled_kernels

pytestmark = pytest.mark.workflow

STUB = """
from pathlib import Path
from netCDF4 import Dataset

for path in snakemake.output:
    with Dataset(path, "w") as file:
        file.checkout = str(Path.cwd())
raise SystemExit
"""
CONTACT = "results/contact_model/figure_10.nc"
BRANCHES = "results/branches/free_h215.nc"
OTHER = "results/branches/free_h150.nc"


def checkout(folder):
    """Return a copy of the project. STUB replaces its scripts, and kernels count as compiled."""
    folder.mkdir()
    for script in (copy_of_project(folder) / "workflow/scripts").glob("*.py"):
        script.write_text(STUB + script.read_text())
    config = configurations.read(folder / "config/config.yaml")
    marker = folder / "results/kernels.compiled"
    marker.parent.mkdir()
    marker.write_text(compiled_kernels(config["comparison"]["orders"]))
    return folder


def run(project, cache, *targets):
    """Remove and make targets with the cache; return for each the checkout that computed it."""
    for target in targets:
        (project / target).unlink(missing_ok=True)
    result = snakemake(project, *targets, "--cache", env={"SNAKEMAKE_OUTPUT_CACHE": str(cache)})
    assert result.returncode == 0, result.stdout + result.stderr
    return [computed_in(project / target) for target in targets]


def computed_in(path):
    """Return the checkout in which a file was computed."""
    with Dataset(path) as file:
        return file.checkout


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    """Return two checkouts and a cache with the results of the first checkout."""
    folder = tmp_path_factory.mktemp("sharing")
    cache = folder / "cache"
    cache.mkdir()
    first, second = checkout(folder / "first"), checkout(folder / "the second")
    assert run(first, cache, CONTACT, BRANCHES, OTHER) == [str(first)] * 3
    return first, second, cache


@pytest.fixture
def edit(shared):
    with edits(shared[1]) as change:
        yield change


def test_a_checkout_takes_what_another_computed(shared):
    first, second, cache = shared
    assert run(second, cache, CONTACT, BRANCHES) == [str(first)] * 2
    told = snakemake(second, CONTACT, BRANCHES, "-n")
    assert "Nothing to be done" in told.stdout + told.stderr


def test_what_differs_is_not_shared(shared, edit):
    """All datasets except the last differ between checkouts, in source, parameters or name."""

    def others(text):
        config = yaml.safe_load(text)
        config["oscillators"]["h150"]["damping"] = 0.151
        config["curves"]["again"] = config["curves"]["free_h215"]
        return yaml.safe_dump(config)

    first, second, cache = shared
    edit("src/chatterjee1995/stages/contact_model.py", lambda text: text + "# A word.\n")
    edit("config/config.yaml", others)
    found = run(second, cache, CONTACT, OTHER, "results/branches/again.nc", BRANCHES)
    assert found == [str(second)] * 3 + [str(first)]


def test_nothing_is_shared_between_versions_of_packages_or_without_the_option(shared, edit):
    _, second, cache = shared
    edit("requirements.lock", lambda text: text + "# A word.\n")
    assert run(second, cache, CONTACT) == [str(second)]
    (second / CONTACT).unlink()
    result = snakemake(second, CONTACT)
    assert result.returncode == 0 and computed_in(second / CONTACT) == str(second)
    assert json.loads((second / "results/provenance.json").read_text())["versions"]["numpy"]


def test_scripts_of_shared_data_know_no_names_but_those_in_their_parameters():
    """The cache ignores wildcards: a job that used one could get the file of another entry."""
    for script in (ROOT / "workflow/scripts").glob("*.py"):
        assert "wildcards" not in script.read_text(), script
    assert "wildcards" not in inspect.getsource(job)
