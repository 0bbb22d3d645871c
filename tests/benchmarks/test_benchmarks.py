"""Parts of the benchmarks on small problems, without measuring times."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from references import extended

from benchmarks import accuracy, costs, overhead, scaling, scenes, stages
from benchmarks.heyoka_runs import BATCH, SETTINGS
from benchmarks.methods import TIMED, heyoka, starts_of
from chatterjee1995.tables import files as table_files
from impact_damper.model.packed import pack

pytestmark = [
    pytest.mark.thorough,
    pytest.mark.skipif(bool(extended.obstacle()), reason=extended.obstacle()),
]

STATE = (0.0057201257, 0.1873935399, 0.0019436955, -2.4079123713)
TIMINGS = "seconds\tpeak_memory_mb\tcpu_seconds\n{}\t{}\t{}\n"


@pytest.fixture(scope="module")
def short():
    """A scene (test case) of two forcing cycles near the quiet orbit."""
    return scenes.make("short", pack(PAPER, DESIGN, 2.0), STATE, 2, BATCH)


def test_scenes_begin_at_those_of_the_configuration():
    found = {scene.name: scene for scene in scenes.from_configuration(1)}
    assert "chaos" not in found
    assert found["resonance"].components == 2
    assert found["design"].starts[0] == pytest.approx(STATE)
    # These motions have period 1, so that they return to their first states.
    for name in ("design", "resonance", "inelastic"):
        assert found[name].error(found[name].starts) < 1e-6


@pytest.mark.parametrize("name", ["kernel", "kernel_ensemble", "heyoka", "heyoka_batch"])
def test_the_tolerance_found_is_the_loosest_within_the_limit(short, name):
    found = accuracy.loosest(short, name, 1e-7)
    assert found.met and found.error <= 1e-7
    assert short.error(found.run(starts_of(short, name))) == found.error
    _, looser = accuracy.measured(short, name, found.tolerance * 10 ** (1 / accuracy.STEPS))
    assert looser > 1e-7


@pytest.mark.parametrize("name", TIMED)
def test_every_method_comes_to_the_exact_state(short, name):
    _, error = accuracy.measured(short, name, 1e-10)
    assert error < 1e-4


@pytest.mark.parametrize("change", SETTINGS)
def test_every_setting_of_heyoka_solves_the_same_equations(short, change):
    run = heyoka(short, 1e-12, **SETTINGS[change])
    assert short.error(run(short.starts)) < 1e-9


def test_cost_of_a_period_is_fitted_exactly_where_it_is_linear():
    table = costs.per_period(costs.motions(1), 1, (1e-6, 1e-9))
    assert len(table) == 4 and (table["median_us"] > 0).all()
    made = table.iloc[np.repeat([0, 2], 3)].assign(
        contacts=[0, 1, 2, 3, 0, 1], displacement=[1, 2, 1, 3, 5, 2], frequency=2.0, tolerance=1e-9
    )
    made["median_us"] = 1 + 2 * made["contacts"] + 3 * math.pi * made["displacement"]
    fit = costs.fitted(made).iloc[0]
    assert fit[["constant_us", "contact_us", "displacement_us"]].tolist() == pytest.approx(
        [1, 2, 3]
    )


def test_ensembles_come_to_the_same_on_any_number_of_threads(short):
    table = scaling.cores([short], scaling.SHARE + 1, 1)
    assert (table["same_results"] == "yes").all()
    assert (table["processes_apart"] > 0).all()
    assert len(scaling.sizes([short], (1, 2), 1)) == 4


def test_stages_are_gathered_from_the_pipelines_timings(tmp_path):
    for path, values in {
        "free/a.tsv": (2.0, 100.0, 1.5),
        "free/b.tsv": (5.0, 120.0, 0.5),
        "kernels.tsv": (3.0, 250.0, 2.0),
    }.items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(TIMINGS.format(*values))
    table = stages.table(tmp_path).set_index("stage")
    assert list(table.index) == ["free", "kernels", "total"]
    assert table.loc["free", ["jobs", "seconds", "longest_job"]].tolist() == [2, 7.0, "b"]
    assert table.loc["total", ["seconds", "cpu_seconds", "memory_mb"]].tolist() == [10, 4, 250]
    table_files.save_table(table.reset_index(), tmp_path / "t.csv", tmp_path / "t.md")
    assert stages.table(tmp_path / "nothing").empty
    (tmp_path / "timings").mkdir()
    (tmp_path / "free").rename(tmp_path / "timings/free")
    (tmp_path / "provenance.json").write_text('{"machine": {"cores": 2, "processor": "a CPU"}}')
    page = """(measured on b)\n| stage | result | jobs | CPU seconds |
| `free` | motions | 9 | 90 |\n| `other` | x | 8 | 80 |\n\nend"""
    assert stages.with_costs(page, tmp_path) == page.replace(
        "on b", "on 2 cores of a CPU, 2 in all"
    ).replace("9 | 90", "2 | 2")


@pytest.mark.workflow
def test_the_start_of_a_job_takes_time(monkeypatch):
    monkeypatch.setattr(overhead, "REPEATS", 1)
    assert overhead.start_up_of_a_job() > 0
