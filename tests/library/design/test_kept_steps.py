"""Steps of a design in files: read if they were made from the same inputs, else computed again."""

import pytest
import xarray as xr

from impact_damper.data.datasets import SOURCE
from impact_damper.design import kept_steps
from impact_damper.design.kept_steps import KeptSteps


class Computing:
    """A computation that counts how often it was called."""

    def __init__(self):
        self.count = 0

    def __call__(self):
        self.count += 1
        return xr.Dataset({"x": ("y", [1.0, float(self.count)])}, attrs={"source": SOURCE})


@pytest.fixture
def compute():
    return Computing()


def step(folder, compute, made):
    return KeptSteps(folder, made).step("one", compute)


def test_a_step_is_computed_once(tmp_path, compute):
    first, second = (step(tmp_path, compute, {"mass": 1}) for _ in range(2))
    assert compute.count == 1 and first.identical(second)


def test_without_a_folder_nothing_is_kept(compute):
    for _ in range(2):
        step(None, compute, {})
    assert compute.count == 2


def test_other_arguments_and_sources_compute_it_again(tmp_path, compute, monkeypatch):
    step(tmp_path, compute, {"mass": 1})
    assert step(tmp_path, compute, {"mass": 2})["x"][1] == 2
    monkeypatch.setattr(kept_steps, "_sources", lambda: "edited")
    assert step(tmp_path, compute, {"mass": 2})["x"][1] == 3


@pytest.mark.parametrize("damage", [b"", b"no dataset", None])
def test_a_damaged_file_is_computed_again(tmp_path, compute, damage):
    step(tmp_path, compute, {})
    path = tmp_path / "one.nc"
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2] if damage is None else damage)
    assert step(tmp_path, compute, {})["x"][1] == 2
    assert step(tmp_path, compute, {})["x"][1] == 2


def test_a_step_that_fails_leaves_no_file(tmp_path, compute):
    def fails():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        step(tmp_path, fails, {})
    assert not list(tmp_path.iterdir())
    step(tmp_path, compute, {})
    assert compute.count == 1
