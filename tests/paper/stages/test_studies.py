"""A study does not depend on its division into chunks, and each chunk fills its own cells."""

import json

import numpy as np
import pytest
from helpers.known_orbits import PAPER
from numpy.testing import assert_allclose, assert_array_equal

from chatterjee1995.stages import studies
from chatterjee1995.stages.studies import OUTCOMES, gather_chunks
from impact_damper.data.datasets import dataset, load, save
from impact_damper.data.whole_files import BrokenFileError
from impact_damper.model.parameters import Damper
from impact_damper.model.settling import Settling
from impact_damper.motions.simulate import random_states
from impact_damper.motions.steady import steady_motion

QUICK = Settling(tolerance=1e-6, patience=100, limit=200, watched=10)
AXES = {
    "mass_ratio": [0.25, 0.4],
    "clearance": [1.0, 1.2],
    "frequency": [2.0],
    "restitution": [0.75, 1.0],
}


def chunk(cells, **others):
    given = {"starts": 3, "radius": 2.0, "settling": QUICK} | others
    return studies.study_chunk(PAPER, AXES, cells, **given)


@pytest.fixture(scope="module")
def entire():
    return chunk((0, 8))


def made_up(shape, cells, seed=7):
    """Return a chunk whose values are functions of the number of the cell."""
    names = ("mass_ratio", "clearance", "frequency", "restitution")
    axes = {name: np.linspace(0.1, 1, n) for name, n in zip(names, shape, strict=True)}
    numbers = np.arange(*cells)
    data = {
        "quiet_count": numbers.astype(np.int32),
        "outcome_count": np.outer(numbers, range(1, len(OUTCOMES) + 1)).astype(np.int32),
        "largest_displacement": (("cell",), np.cos(numbers)),
    }
    made = {"damping": 0.215, "seed": seed}
    return dataset(data, axes | {"cell": numbers, "counted_outcome": list(OUTCOMES)}, made, "")


def saved(folder, shape, bounds, seed=7):
    """Save made-up chunks from each of `bounds` to the next, and return the chunks' files."""
    paths = []
    for first, last in zip(bounds, bounds[1:], strict=False):
        paths.append(folder / f"{first}-{last}.nc")
        save(made_up(shape, (first, last), seed), paths[-1])
    return paths


def test_chunks_come_back_to_their_cells_however_they_are_cut(tmp_path):
    shape, results = (3, 4, 2, 5), []
    for number, bounds in enumerate([(0, 120), (0, 1, 60, 120), range(0, 121, 7), (0, 119, 120)]):
        folder = tmp_path / str(number) / "studies"
        bounds = [*bounds] if bounds[-1] == 120 else [*bounds, 120]
        gather_chunks(saved(folder, shape, bounds), folder / "all.nc")
        results.append((folder / "all.nc").read_bytes())
    assert len(set(results)) == 1
    data = load(folder / "all.nc")
    numbers = np.arange(120).reshape(shape)
    assert_array_equal(data["quiet_count"], numbers)
    assert_array_equal(data["outcome_count"].sel(counted_outcome=OUTCOMES[2]), 3 * numbers)
    assert_array_equal(data["largest_displacement"], np.cos(numbers))
    best = np.take(data["clearance"].values, np.argmin(np.cos(numbers), axis=1))
    assert_array_equal(data["best_clearance"], best)
    rm, w = data["mass_ratio"], data["frequency"]
    assert_allclose(data["rule_clearance"] * rm * w**2, 1)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda paths, folder: paths[::-1],
        lambda paths, folder: [paths[0], paths[2]],
        lambda paths, folder: paths[:2],
        lambda paths, folder: [*paths[:2], saved(folder / "b", (2, 3, 2, 1), [8, 12], seed=8)[0]],
        lambda paths, folder: [*paths[:2], saved(folder / "b", (2, 3, 1, 2), [8, 12])[0]],
    ],
    ids=["out of order", "one lost", "last lost", "other parameters", "other grid"],
)
def test_chunks_that_do_not_make_a_study_are_told(spoil, tmp_path):
    paths = spoil(saved(tmp_path, (2, 3, 2, 1), [0, 4, 8, 12]), tmp_path)
    with pytest.raises(BrokenFileError, match=r"\.nc .*cell"):
        gather_chunks(paths, tmp_path / "all.nc")
    assert not list(tmp_path.glob("all.nc*"))


def test_chunks_agree_with_the_whole_study(entire):
    for cells in ((0, 3), (3, 4), (4, 8)):
        part = chunk(cells, workers=2)
        for name in part.data_vars:
            assert_array_equal(part[name], entire[name].sel(cell=slice(*cells))[: np.ptp(cells)])
        assert json.loads(part.attrs["parameters"]) == json.loads(entire.attrs["parameters"])


def test_a_cell_counts_the_motions_from_its_starts(entire):
    damper = Damper(0.4, 1.0, restitution=0.75)
    number = np.ravel_multi_index((1, 0, 0, 0), (2, 2, 1, 2))
    motions = [
        steady_motion(PAPER, damper, 2.0, state, settling=QUICK)
        for state in random_states(3, 2.0, damper, [1995, number])
    ]
    cell = entire.sel(cell=number)
    sizes = [float(motion["maximum_displacement"]) for motion in motions]
    assert float(cell["largest_displacement"]) == pytest.approx(max(sizes), rel=1e-12)
    values = [int(motion["outcome"]) for motion in motions]
    assert_array_equal(cell["outcome_count"], [values.count(k) for k in range(len(OUTCOMES))])
    assert_array_equal(entire["outcome_count"].sum("counted_outcome"), 3)


def test_the_first_chunk_names_a_value_out_of_range_in_the_last_cell():
    axes = AXES | {"mass_ratio": [1, 20]}
    with pytest.raises(ValueError, match="mass_ratio = 20: must be .*at most 10"):
        studies.study_chunk(PAPER, axes, (0, 1), radius=0.5, settling=QUICK)
