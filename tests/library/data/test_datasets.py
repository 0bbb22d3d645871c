"""Labelled datasets: attributes, files, and clean-up after a failure to write."""

import json

import netCDF4
import numpy as np
import pytest
import xarray as xr
from helpers.known_orbits import DESIGN, PAPER

from impact_damper.data import datasets
from impact_damper.data.variables import VARIABLES
from impact_damper.data.whole_files import BrokenFileError
from impact_damper.motions.response import frequency_response
from impact_damper.motions.simulate import simulate
from impact_damper.motions.steady import steady_motion


@pytest.fixture(scope="module")
def small():
    return datasets.dataset(
        {"outcome": [[1, -1], [0, 2]], "maximum_displacement": [[1.0, np.nan], [2.0, 3.0]]},
        {"frequency": [1.0, 2.0]},
        {"damping": 0.215, "seed": 7},
        "A small one",
    )


@pytest.fixture(scope="module", params=["simulate", "steady", "response"])
def made(request):
    return {
        "simulate": lambda: simulate(PAPER, DESIGN, 2.0, (0, 0, 0, 1), periods=3, samples=20),
        "steady": lambda: steady_motion(PAPER, DESIGN, 2.0, (0, 0, 0, 1)),
        "response": lambda: frequency_response(PAPER, DESIGN, [2.0, 2.01], starts=4),
    }[request.param]()


def test_every_dataset_says_what_made_it_and_survives_a_file(made, tmp_path):
    assert made.attrs["Conventions"].startswith("CF-")
    assert made.attrs["title"] and made.attrs["references"]
    assert datasets.parameters_of(made)["damping"] == 0.215
    assert datasets.parameters_of(made)["mass_ratio"] == 0.12
    datasets.save(made, tmp_path / "data.nc")
    with xr.open_dataset(tmp_path / "data.nc") as again:
        again.load()
    assert again.attrs.pop("id") == f"{tmp_path.name}/data"
    assert len(again.attrs.pop("sha256")) == 64
    assert again.identical(made)


def test_registry():
    """Every variable has units and a name."""
    for name, entry in VARIABLES.items():
        assert name.isidentifier() and entry.long_name
        assert isinstance(entry.dims, tuple)
        if entry.flags:
            values = list(entry.flags.values())
            assert len(set(values)) == len(values)
            assert all(-128 <= value <= 127 for value in values)
            assert all(meaning.isidentifier() for meaning in entry.flags)


def test_flags(small):
    attributes = small.outcome.attrs
    meanings = attributes["flag_meanings"].split()
    assert dict(zip(meanings, attributes["flag_values"].tolist(), strict=True)) == (
        VARIABLES["outcome"].flags
    )
    assert attributes["flag_values"].dtype == small.outcome.dtype == np.int8
    assert datasets.flag("outcome", "chaotic") == 2
    with pytest.raises(KeyError):
        datasets.flag("outcome", "bored")


def test_file_as_other_programs_see_it(small, tmp_path):
    """The file has CF attributes, NaN for a missing number, and no fill value for other types."""
    path = tmp_path / "below" / "small.nc"
    datasets.save(small, path)
    with netCDF4.Dataset(path) as file:
        assert json.loads(file.parameters) == {"damping": 0.215, "seed": 7}
        outcome = file["outcome"]
        assert outcome.dtype == np.int8 and "_FillValue" not in outcome.ncattrs()
        assert outcome.dimensions == ("frequency", "motion")
        assert "_FillValue" not in file["frequency"].ncattrs()
        assert file["frequency"].units == "1"
        assert np.isnan(np.ma.filled(file["maximum_displacement"][:], np.nan)[0, 1])


def test_file_can_be_overwritten_after_load(small, tmp_path):
    path = tmp_path / "small.nc"
    datasets.save(small, path)
    again = datasets.load(path)
    datasets.save(again.assign_attrs(title="Another"), path)
    assert datasets.load(path).attrs["title"] == "Another"


def test_nothing_is_left_of_a_failure(small, tmp_path, monkeypatch):
    """A failure leaves no part of the new file and does not change the old file."""
    path = tmp_path / "small.nc"
    datasets.save(small, path)
    before = path.read_bytes()

    def full(*_):
        assert len(list(tmp_path.iterdir())) == 2
        raise OSError("no space left")

    monkeypatch.setattr("os.replace", full)
    with pytest.raises(OSError, match="no space left"):
        datasets.save(small.assign_attrs(title="Another"), path)
    with pytest.raises((TypeError, ValueError)):
        datasets.save(small.assign_attrs(title=object()), path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["small.nc"]


def test_every_damage_is_told_or_harms_nothing(small, tmp_path):
    """If bytes are changed, cut off or set to zero, reading fails or gives equal data."""
    path = tmp_path / "small.nc"
    extremes = [-np.nan, -0.0]  # a file need not keep the sign of NaN
    small = small.assign(method=("motion", ["one", "another"]), displacement=("motion", extremes))
    small = small.assign(walls=("event", np.array([], object)))
    datasets.save(small, path)
    whole, told = path.read_bytes(), set()
    expected = datasets.load(path)
    places = range(0, len(whole), 197)
    damages = [whole[:k] for k in places]
    damages += [whole[:k] + bytes([whole[k] ^ 0x55]) + whole[k + 1 :] for k in places]
    damages += [whole[:k] + bytes(len(whole) - k) for k in places]
    for damaged in damages:
        path.write_bytes(damaged)
        try:
            assert datasets.load(path).identical(expected)
        except BrokenFileError as error:
            message = str(error)
            assert message.startswith(str(path)) and "\n" not in message
            assert "delete" not in message
            told.add(message)
    assert len(told) > len(places)


def test_a_foreign_file_is_told(small, tmp_path):
    datasets.save(small, tmp_path / "response/one.nc")
    other = tmp_path / "response/other.nc"
    other.write_bytes((tmp_path / "response/one.nc").read_bytes())
    with pytest.raises(BrokenFileError, match=r"other\.nc holds response/one"):
        datasets.load(other)
    xr.Dataset({"a": 1}).to_netcdf(other, engine="netcdf4")
    with pytest.raises(BrokenFileError, match=r"other\.nc was not made by this project"):
        datasets.load(other)
    other.write_text("CDF")
    with pytest.raises(BrokenFileError, match=r"other\.nc is not a NetCDF file of this project"):
        datasets.load(other)
    other.unlink()
    with pytest.raises(FileNotFoundError):
        datasets.load(other)


def test_a_part_that_a_killed_job_left_is_removed(small, tmp_path):
    path, other = tmp_path / "[a].nc", tmp_path / "[a].nc2.part-1"
    for left in (tmp_path / "[a].nc.part-1", other):
        left.write_bytes(b"half")
    datasets.save(small, path)
    assert set(tmp_path.iterdir()) == {path, other}


def test_a_file_that_cannot_be_written_is_told(small, tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("no folder")
    with pytest.raises(OSError, match=r"small\.nc cannot be written: .*run the same command again"):
        datasets.save(small, blocked / "small.nc")


def test_flags_are_decoded(small):
    outcome = xr.DataArray([[1, 2], [0, 5]], dims=("a", "b"), coords={"a": [3, 4]})
    outcome.attrs = datasets.variable("outcome", [[1]]).attrs
    words = datasets.decode(outcome)
    assert words.values.tolist() == [["settled", "chaotic"], ["unresolved", "escaped"]]
    assert words.dims == outcome.dims and words["a"].values.tolist() == [3, 4]
    assert "flag_values" not in words.attrs
    with pytest.raises(ValueError, match=r"values = \[99\]: must be among"):
        datasets.decode(outcome.where(outcome != 5, 99))
    for wrong in (3, [1, 2], xr.DataArray(1), None):
        with pytest.raises(TypeError, match="values = .*: must be a variable of a dataset"):
            datasets.decode(wrong)
