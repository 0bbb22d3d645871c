"""The archive of a small run: its crate, its digests, and a job that is run again."""

import json
import subprocess
import sys
import zipfile

import pytest
from helpers.running import ROOT

ARCHIVE = ROOT / "workflow/archive.py"
RULE = """
rule motion:
    input: "config/config.yaml"
    output: "results/motion/{name}.nc"
    log: "results/logs/motion/{name}.log"
    params: given={"state": [1.5, None]}
    script: "../scripts/stage.py"
"""
SCRIPT = """
from pathlib import Path
Path(snakemake.output[0]).write_text(str(snakemake.params.given))
Path("results/timings/motion").mkdir(parents=True, exist_ok=True)
Path("results/timings/motion/a.tsv").write_text("seconds\\tcpu_seconds\\n1.0\\t0.5\\n")
"""
FILES = {
    "Snakefile": 'include: "workflow/rules/all.smk"\n',
    "config/config.yaml": "results: results\n",
    "pyproject.toml": (ROOT / "pyproject.toml").read_text(),
    "results/provenance.json": '{"versions": {"snakemake": "9"}}',
    "workflow/rules/all.smk": RULE,
    "workflow/scripts/stage.py": SCRIPT,
}

pytestmark = pytest.mark.workflow


def run(folder, *arguments):
    """Run a Python program in a folder, and return the completed process."""
    command = [sys.executable, *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return the folder of a run of one job, with its archive."""
    made = tmp_path_factory.mktemp("run")
    for name, text in FILES.items():
        path = made / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    run(made, "-m", "snakemake", "--cores", "1", "results/motion/a.nc").check_returncode()
    run(made, ARCHIVE, "write", "run.zip").check_returncode()
    return made


def test_the_crate_has_each_file_and_the_job(folder):
    with zipfile.ZipFile(folder / "run.zip") as archive:
        names = set(archive.namelist()) - {"ro-crate-metadata.json"}
        graph = json.loads(archive.read("ro-crate-metadata.json"))["@graph"]
    entities = {each["@id"]: each for each in graph}
    assert len(entities) == len(graph)
    assert {each["@id"] for each in entities["./"]["hasPart"]} == names
    job = entities["#motion/a"]
    assert job["object"] == [{"@id": "config/config.yaml"}, {"@id": "#motion/a/state"}]
    assert job["result"] == {"@id": "results/motion/a.nc"}
    assert json.loads(entities["#motion/a/state"]["value"]) == [1.5, None]
    assert entities["#motion/a/seconds"]["value"] == "1.0"


def test_the_check_runs_a_job_again_to_the_same_bytes(folder):
    ended = run(folder, ARCHIVE, "check", "run.zip")
    assert ended.returncode == 0, ended.stderr
    assert "motion/a run again writes the same bytes" in ended.stdout


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_the_check_finds_a_changed_file(folder):
    with zipfile.ZipFile(folder / "run.zip", "a") as archive:
        archive.writestr("results/motion/a.nc", "other")
    ended = run(folder, ARCHIVE, "check", "run.zip")
    assert ended.returncode != 0
    assert "results/motion/a.nc" in ended.stderr
