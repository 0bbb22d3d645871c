"""The workflow runs what depends on a change, and nothing else.

Reruns are asked of a copy of the project whose scripts only write their outputs.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from impact_damper.contradictions import SECTIONS

ROOT = Path(__file__).parents[1]
PARTS = ["Snakefile", "config", "profiles", "workflow", "src"]
STUB = """
from pathlib import Path
for path in snakemake.output:
    Path(path).write_text("")
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


def planned(result):
    """What a dry run would do, in the words of its messages."""
    assert result.returncode == 0, result.stdout + result.stderr
    return set(re.findall(r"^Job \d+: (.*)$", result.stderr + result.stdout, re.M))


def entries(config, names):
    """The configuration with the named entries alone."""
    return config | {
        section: {name: config[section][name] for name in kept} for section, kept in names.items()
    }


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A small project after a run to its end."""
    project = tmp_path_factory.mktemp("a project")
    for part in PARTS:
        copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
        copy(ROOT / part, project / part)
    for script in (project / "workflow/scripts").glob("*.py"):
        script.write_text(STUB + script.read_text())
    path = project / "config/config.yaml"
    config = entries(
        yaml.safe_load(path.read_text()),
        {
            "oscillators": ["h215", "h107"],
            "curves": ["figure_05a", "figure_08"],
            "motions": ["figure_04"],
            "collisions": ["figure_05a"],
            "optima": ["h215_rm012", "h215_rm018"],
            "migration": ["figure_13"],
            "release_scans": ["close"],
            "rigid_limit": ["figure_05a"],
            "design_rules": ["stiffness"],
            "figures": ["figure_01", "figure_02", "figure_05a", "figure_08", "figure_13"],
        },
    )
    path.write_text(yaml.safe_dump(config, sort_keys=False))
    result = snakemake(project)
    assert result.returncode == 0, result.stdout + result.stderr
    return project


@pytest.fixture
def edit(finished):
    """Edit a file of the finished project for a dry run, of which the plan is returned."""
    originals = {}

    def plan_after(name, change):
        path = finished / name
        originals[path] = path.read_text()
        path.write_text(change(originals[path]))
        return planned(snakemake(finished, "-n"))

    yield plan_after
    for path, text in originals.items():
        path.write_text(text)


def with_comment(text):
    return f"{text}# A word.\n"


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
    stages += "missed_contacts stable_steps verdicts accuracy studies".split()
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


def test_nothing_is_left_to_do(finished):
    assert planned(snakemake(finished, "-n")) == set()


def test_touched_files_rerun_nothing(finished):
    for part in ("src", "workflow", "config"):
        for path in (finished / part).rglob("*.*"):
            path.touch()
    assert planned(snakemake(finished, "-n")) == set()


def test_comments_and_order_in_the_configuration_rerun_nothing(edit):
    def turned(values):
        if not isinstance(values, dict):
            return values
        return {key: turned(value) for key, value in reversed(values.items())}

    def change(text):
        return with_comment(yaml.safe_dump(turned(yaml.safe_load(text)), sort_keys=False))

    assert edit("config/config.yaml", change) == set()


def test_a_curve_reruns_itself_and_what_draws_it(edit):
    plan = edit("config/config.yaml", lambda text: text.replace("1.063", "1.07", 1))
    assert plan == {
        "Harmonic balance and suppression band of the curve figure_08",
        "Motions with the damper over frequency, of the curve figure_08",
        "What the damper makes of the one-third subharmonic, for the curve figure_08",
        "Branches of orbits with the damper, for the curve figure_08",
        "Drawing figure_08",
        "Captions of the figures",
        "Table of design",
        "Table of bands",
        "Table of readings",
        "Table of subharmonics",
        "Table of orbits",
        "Table of bifurcations",
        "Table of claims",
    }


def test_a_title_redraws_its_figure_alone(edit):
    plan = edit("config/config.yaml", lambda text: text.replace("at low damping", "again"))
    assert plan == {"Drawing figure_08", "Captions of the figures"}


def test_a_caption_template_is_read_again_for_captions_alone(edit):
    plan = edit("workflow/report/response.rst", with_comment)
    assert plan == {"Captions of the figures"}


def test_a_figure_style_computes_nothing(edit):
    figures = ("figure_01", "figure_02", "figure_05a", "figure_08", "figure_13")
    plan = edit("src/impact_damper/figures/style.py", with_comment)
    assert plan == {f"Drawing {name}" for name in figures}


def test_the_validation_reruns_nothing(edit):
    assert edit("src/impact_damper/configuration.py", with_comment) == set()


def test_an_imported_module_reruns_what_rests_on_it(edit):
    plan = edit("src/impact_damper/kernel.py", with_comment)
    assert plan > {
        "Motions of the free oscillator h215 over frequency",
        "Motions with the damper over frequency, of the curve figure_08",
        "Migration control, the case figure_13",
    }
    assert not plan & {
        "Harmonic balance of the free oscillator h215",
        "Harmonic balance and suppression band of the curve figure_08",
        "Drawing figure_01",
    }


def test_a_script_reruns_its_own_jobs(edit):
    plan = edit("workflow/scripts/migration_trials.py", with_comment)
    assert plan == {
        "Migration control, the case figure_13",
        "Drawing figure_13",
        "Table of migration",
        "Table of claims",
    }


def test_a_release_scan_reruns_itself_and_its_tables(edit):
    plan = edit("config/config.yaml", lambda text: text.replace("last: 1.76", "last: 1.77"))
    assert plan == {
        "Where releases lead over frequency, the scan close",
        "Table of releases",
        "Table of claims",
    }


def test_a_lost_chunk_costs_itself(finished):
    chunk = finished / "results/study_chunks/design_plane/2-of-4.nc"
    study = finished / "results/studies/design_plane.nc"
    chunk.unlink()
    gathered = planned(snakemake(finished, "-n"))
    study.unlink()
    plan = planned(snakemake(finished, "-n"))
    chunk.touch()
    study.touch()
    assert gathered == set()
    assert plan == {
        "Chunk 2-of-4 of the study design_plane",
        "Gathering the study design_plane",
    }


def test_a_lost_marker_of_the_kernels_reruns_nothing(finished):
    marker = finished / "results/kernels.compiled"
    marker.unlink()
    assert planned(snakemake(finished, "-n")) == set()
    marker.touch()
