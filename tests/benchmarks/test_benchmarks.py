"""Parts of the benchmarks on small problems, without measuring times."""

import pytest
from helpers.known_orbits import DESIGN, PAPER
from references import extended

from benchmarks import accuracy, scaling, scenes
from benchmarks.heyoka_runs import BATCH, SETTINGS
from benchmarks.methods import TIMED, heyoka, starts_of
from impact_damper.model.packed import pack

pytestmark = [
    pytest.mark.thorough,
    pytest.mark.skipif(bool(extended.obstacle()), reason=extended.obstacle()),
]

STATE = (0.0057201257, 0.1873935399, 0.0019436955, -2.4079123713)


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


def test_ensembles_come_to_the_same_on_any_number_of_threads(short):
    table = scaling.cores([short], scaling.SHARE + 1, 1)
    assert (table["same_results"] == "yes").all()
    assert (table["processes_apart"] > 0).all()
    assert len(scaling.sizes([short], (1, 2), 1)) == 4
