"""Steps of a design as the benchmark reads them, without designing anything."""

import time
from pathlib import Path

import pytest

from benchmarks import design


@pytest.fixture
def steps(monkeypatch):
    """Replace `design_damper` by a function with two steps, the second of which takes longer."""

    def write(*_, folder, **__):
        for seconds, name in ((0.01, "screening"), (0.05, "cliff")):
            time.sleep(seconds)
            (Path(folder) / f"{name}.nc").touch()

    monkeypatch.setattr(design.idm, "design_damper", write)


def test_the_steps_of_a_design_come_in_their_order(steps):
    table = design.table({"frequencies": 3})
    for name, part in table.groupby("design", sort=False):
        assert name in design.DESIGNS
        assert list(part["step"]) == ["screening", "cliff", "all", "all, CPU"]
        seconds, share = (
            dict(zip(part["step"], part[key], strict=True)) for key in ("seconds", "share")
        )
        assert 0 < seconds["screening"] < seconds["cliff"]
        assert seconds["screening"] + seconds["cliff"] == pytest.approx(seconds["all"])
        assert share["screening"] + share["cliff"] == pytest.approx(1)
