"""The workflow as it is asked for, and what it says to a broken configuration."""

import re

import pytest
from running import ROOT, snakemake

from impact_damper.contradictions import SECTIONS

ROOT = Path(__file__).parents[1]
PARTS = ["Snakefile", "config", "profiles", "workflow", "src"]
# An output begins as a NetCDF file does, for the check of results.
STUB = r"""
from pathlib import Path
for path in snakemake.output:
    Path(path).write_bytes(b"\x89HDF\r\n\x1a\n")
raise SystemExit
"""


def snakemake(project, *arguments, **options):
    """Run Snakemake on a project with the project's own package."""
    environment = os.environ | {"PYTHONPATH": str(project / "src")}
    command = [sys.executable, "-m", "snakemake", "--cores", "2", *arguments]
    options = {"cwd": project, "env": environment, "capture_output": True, "text": True} | options
    return subprocess.run(command, check=False, **options)


def jobs(result):
    """Number of jobs by rule, from the table that Snakemake prints first."""
    assert result.returncode == 0, result.stdout + result.stderr
    table = re.search(
        r"^job +count\n[- ]+\n(.*?)^total", result.stderr + result.stdout, re.M | re.S
    )
    return (
        {line.split()[0]: int(line.split()[1]) for line in table[1].splitlines()} if table else {}
    )


@pytest.mark.parametrize("arguments", [(), ("--configfile", "config/smoke.yaml")])
def test_every_script_serves_the_paper_and_the_smoke_run(arguments, tmp_path):
    scripts = {path.stem for path in (ROOT / "workflow/scripts").glob("*.py")}
    command = [*arguments, "-n", "--directory", tmp_path / "elsewhere"]
    drawn = {f"draw_{kind}" for kind in SECTIONS}
    rules = set(jobs(snakemake(ROOT, *command))) - {"all"}
    assert rules - drawn | {"draw"} == scripts
    assert drawn <= rules


def test_each_stage_is_a_target():
    stages = "design free response branches optimum subharmonic migration release_scan".split()
    stages += "design_rules harmonics balance_map contact_model rigid_limit".split()
    stages += "missed_contacts stable_steps verdicts accuracy".split()
    found = jobs(snakemake(ROOT, *stages, "figures", "tables", "-n", "--forceall"))
    assert {*stages, "figures", "tables"} < found.keys()


def test_a_broken_configuration_is_told_in_one_line_each(tmp_path):
    mine = tmp_path / "mine.yaml"
    mine.write_text("curves: {figure_05a: {mass_ratio: -1}}\nsed: 3\n")
    result = snakemake(ROOT, "-n", "--configfile", mine)
    told = result.stderr + result.stdout
    assert result.returncode == 1
    assert "Traceback" not in told
    assert re.search(
        r"^ *curves\.figure_05a\.mass_ratio = -1: must be .*greater than 0", told, re.M
    )
    assert re.search(r"^ *sed = 3: unknown key; known: ", told, re.M)


def test_a_key_that_stands_twice_is_told(tmp_path):
    mine = tmp_path / "mine.yaml"
    mine.write_text("seed: 1\nseed: 2\n")
    result = snakemake(ROOT, "-n", "--configfile", mine)
    assert result.returncode == 1
    assert "mine.yaml, line 2: seed stands twice" in result.stderr + result.stdout
