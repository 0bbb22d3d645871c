"""Designs of a damper: kept steps, interruptions, number of threads, and consistent results."""

import os
import signal
import threading

import numpy as np
import pytest
import xarray as xr

import impact_damper as idm
from impact_damper.data.datasets import SOURCE, flag
from impact_damper.design import additions
from impact_damper.design import design_damper as machines

MACHINE = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.02, force=40)
SMALL = {
    "mass": 1.2,
    "band": (20.4, 20.7),
    "restitution": 0.6,
    "contact": 2e7,
    "tolerances": {"gap": 0.05},
    "share": 0.8,
}
EFFORT = {"frequencies": 3, "candidates": 4, "starts": 16}
STEPS = {"decision", *additions.ADDITIONS}


def design(folder=None, restitution=0.6, **effort):
    given = SMALL | {"restitution": restitution, "effort": idm.Effort(**EFFORT | effort)}
    return machines.design_damper(MACHINE, **given, folder=folder)


def kept(folder):
    return {path.stem for path in folder.glob("*.nc")}


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A design and the folder of its steps."""
    folder = tmp_path_factory.mktemp("steps")
    return design(folder=folder), folder


@pytest.mark.thorough
def test_all_steps_are_kept_and_read_again(finished, monkeypatch):
    data, folder = finished
    assert kept(folder) == STEPS

    def computes(*_, **__):
        raise AssertionError("a step was computed again")

    monkeypatch.setattr(machines, "find_gap", computes)
    for name in additions.ADDITIONS:
        monkeypatch.setitem(additions.ADDITIONS, name, computes)
    assert design(folder=folder).identical(data)


@pytest.mark.thorough
def test_an_interrupted_design_continues_after_its_kept_steps(finished, tmp_path, monkeypatch):
    """The result on two threads equals the result on one thread."""

    def interrupt(*_, **__):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setitem(additions.ADDITIONS, "masses", interrupt)
        design(folder=tmp_path, workers=2)
    done = kept(tmp_path)
    assert done == STEPS - {"masses", "transients", "shocks", "competitors"}
    times = {name: (tmp_path / f"{name}.nc").stat().st_mtime_ns for name in done}
    assert design(folder=tmp_path, workers=2).identical(finished[0])
    assert times == {name: (tmp_path / f"{name}.nc").stat().st_mtime_ns for name in done}


def test_ctrl_c_is_heard_while_motions_run(tmp_path):
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    presses = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    presses.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            # Such a design takes far longer than the 0.3 s until the key is pressed.
            design(folder=tmp_path, frequencies=41, candidates=40, starts=500, workers=2)
    finally:
        presses.join()
        signal.signal(signal.SIGINT, before)
    assert kept(tmp_path) < STEPS


def quick(monkeypatch, function=machines.design_damper, **changed):
    """Return a design that consists of its decision only."""
    for name in list(additions.ADDITIONS):
        monkeypatch.delitem(additions.ADDITIONS, name)
    given = SMALL | {"effort": idm.Effort(**EFFORT)} | changed
    return function(MACHINE, **given)


@pytest.mark.thorough
def test_a_limit_is_only_compared_with_the_promise(finished, monkeypatch):
    free, size = finished[0], float(finished[0]["promised_displacement"])
    for limit, status in ((1.05, "met"), (0.95, "missed")):
        found = quick(monkeypatch, displacement_limit=limit * 1e-3 * size)
        assert float(found["promised_displacement"]) == size
        assert found["design_gap"] == free["design_gap"]
        assert found["decision"] == free["decision"]
        assert idm.decode(found["limit_status"]).item() == status


@pytest.mark.thorough
def test_a_given_gap_has_the_promise_of_the_design(finished, monkeypatch):
    """Design and evaluation use the same new starts if the design confirms its first choice."""
    data = finished[0]
    made = MACHINE.damper(
        mass=1.2, gap=1e-3 * data["design_gap"].item(), restitution=0.6, contact_stiffness=2e7
    )
    asked = {name: SMALL[name] for name in ("band", "tolerances", "share")}
    for name in list(additions.ADDITIONS):
        monkeypatch.delitem(additions.ADDITIONS, name)
    found = idm.evaluate_damper(MACHINE, made, **asked, effort=idm.Effort(**EFFORT))
    promised = [float(each["promised_displacement"]) for each in (found, data)]
    assert promised[0] == pytest.approx(promised[1], rel=1e-2)


@pytest.mark.thorough
def test_a_gap_that_does_nothing_is_not_to_be_built(monkeypatch):
    """With the gap designed for the heavier loose mass the displacement falls by over a quarter."""
    for name in additions.ADDITIONS.keys() - {"masses"}:
        monkeypatch.delitem(additions.ADDITIONS, name)
    made = MACHINE.damper(mass=0.6, gap="0.05 mm", restitution=0.6, contact_stiffness=2e7)
    asked = {name: SMALL[name] for name in ("band", "tolerances", "share")}
    found = idm.evaluate_damper(MACHINE, made, **asked, effort=idm.Effort(**EFFORT))
    assert idm.decode(found["decision"]).item() == "do_not_build"
    assert (found["addition_status"] == flag("addition_status", "computed")).all()
    assert np.allclose(found["other_mass"], [0.6, 1.2])
    small = 0.75 * float(found["largest_bare_displacement"])
    assert float(found["other_displacement"][1]) < small < float(found["other_displacement"][0])


@pytest.mark.thorough
def test_an_addition_that_fails_is_named_and_the_design_ends(monkeypatch):
    def fails(*_, **__):
        raise ArithmeticError("144 contacts")

    for name in list(additions.ADDITIONS):
        monkeypatch.setitem(additions.ADDITIONS, name, fails)
    data = design()
    assert (data["addition_status"] == flag("addition_status", "failed")).all()
    assert data.attrs["failed_orbits"] == "ArithmeticError: 144 contacts"
    assert data["promised_displacement"] > 0


class Computing:
    """A computation that counts how often it was called."""

    def __init__(self):
        self.count = 0

    def __call__(self, progress=None):
        self.count += 1
        return xr.Dataset({"x": ("y", [1.0, float(self.count)])}, attrs={"source": SOURCE})


@pytest.fixture
def compute():
    return Computing()


def kept_step(folder, compute, made):
    return machines.Steps(folder, False, made).step("one", compute)


def test_other_arguments_and_sources_compute_it_again(tmp_path, compute, monkeypatch):
    kept_step(tmp_path, compute, {"mass": 1})
    assert kept_step(tmp_path, compute, {"mass": 2})["x"][1] == 2
    monkeypatch.setattr(machines, "_sources", lambda: "edited")
    assert kept_step(tmp_path, compute, {"mass": 2})["x"][1] == 3


@pytest.mark.parametrize("damage", [b"", b"no dataset", None])
def test_a_damaged_file_is_computed_again(tmp_path, compute, damage):
    kept_step(tmp_path, compute, {})
    path = tmp_path / "one.nc"
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2] if damage is None else damage)
    assert kept_step(tmp_path, compute, {})["x"][1] == 2
    assert kept_step(tmp_path, compute, {})["x"][1] == 2
