"""Plans of the workflow for its targets, and its messages about wrong configurations."""

import re

import pytest
from helpers.running import ROOT, snakemake

from chatterjee1995.sections.registry import CHAPTERS, PAPER, STAGES

pytestmark = pytest.mark.workflow


def jobs(result):
    """Return the number of jobs by rule, from the table that Snakemake prints first."""
    assert result.returncode == 0, result.stdout + result.stderr
    table = re.search(
        r"^job +count\n[- ]+\n(.*?)^total", result.stderr + result.stdout, re.M | re.S
    )
    return (
        {line.split()[0]: int(line.split()[1]) for line in table[1].splitlines()} if table else {}
    )


@pytest.mark.parametrize(
    ("arguments", "most"), [((), 110), (("--configfile", "config/smoke.yaml"), 40)]
)
def test_every_stage_is_run_for_the_paper_and_in_the_smoke_run(arguments, most, tmp_path):
    """Every target is known. The number of jobs is limited: starting a job takes seconds."""
    targets = {"everything", "figures", "tables", *(f"all_{stage}" for stage in STAGES)}
    planned = snakemake(ROOT, *targets, *arguments, "-n", "--directory", tmp_path / "elsewhere")
    found = jobs(planned)
    assert targets < found.keys()
    for target in targets:  # targets start no process
        del found[target]
    assert sum(found.values()) <= most
    others = {"compile_kernels", "study_chunks", "machine_pages"}
    assert found.keys() == STAGES.keys() | others | {f"chapter_{name}" for name in CHAPTERS}


def test_the_paper_is_made_without_the_stages_beside_it(tmp_path):
    found = jobs(snakemake(ROOT, "-n", "--directory", tmp_path / "elsewhere"))
    del found["all"]
    assert sum(found.values()) <= 100
    beside = {name for name, stage in STAGES.items() if not stage.paper}
    shown = {f"chapter_{name}" for name in CHAPTERS}
    assert found.keys() & shown == {f"chapter_{name}" for name in PAPER}
    assert not found.keys() & beside and found.keys() > STAGES.keys() - beside


def test_a_broken_configuration_starts_no_job_and_is_told_in_one_line_each(tmp_path):
    mine = tmp_path / "mine.yaml"
    mine.write_text("curves: {figure_05a: {mass_ratio: -1}}\nsed: 3\nseed: .nan\n")
    result = snakemake(ROOT, "--configfile", mine, "--directory", tmp_path / "elsewhere")
    told = result.stderr + result.stdout
    assert result.returncode == 1
    assert "Traceback" not in told
    assert re.search(
        r"^ *curves\.figure_05a\.mass_ratio = -1: must be .*at least 1e-0?6", told, re.M
    )
    assert re.search(r"^ *sed = 3: unknown key; known: ", told, re.M)
    assert re.search(r"^ *seed = nan: must be a whole number", told, re.M)
    assert not (tmp_path / "elsewhere/results").exists()
    mine.write_text("seed: 1\nseed: 2\n")
    result = snakemake(ROOT, "-n", "--configfile", mine)
    assert result.returncode == 1
    assert "mine.yaml, line 2: seed stands twice" in result.stderr + result.stdout


def test_each_hook_stands_once():
    """Snakemake replaces the first of two hooks `onstart` by the second, without a message."""
    files = [ROOT / "Snakefile", *(ROOT / "workflow/rules").glob("*.smk")]
    hooks = re.findall("^(on[a-z]+):", "".join(path.read_text() for path in files), re.MULTILINE)
    assert sorted(hooks) == ["onstart", "onsuccess"]
