"""Datasets in SI units: against closed forms and other scales."""

import math
from functools import cached_property

import numpy as np
import pytest
import xarray as xr

import impact_damper as idm
from impact_damper.data.datasets import from_si, in_si, variable
from impact_damper.data.variables import VARIABLES
from impact_damper.model.machine import Machine
from impact_damper.model.units import Scales

SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005}
LINEAR = Machine(**SPRING, force=40)
HARD = Machine(**SPRING, cubic_stiffness=4e9, force=40)
DAMPER = {"mass": 0.6, "gap": "8 mm", "restitution": 0.7, "contact_stiffness": 2e7}
AT_RESONANCE = LINEAR.natural_frequency


def test_datasets_come_back_from_si():
    generator = np.random.default_rng(1)
    names = [name for name, each in VARIABLES.items() if not each.flags and each.dims]
    data = xr.Dataset(
        {
            name: variable(name, generator.standard_normal(4), (f"{name}_dim",))
            for name in names
            if VARIABLES[name].kind != "followed"
        },
        attrs={"parameters": "{}"},
    )
    there = in_si(data, HARD)
    back = from_si(there, HARD.scales)
    for name in data.variables:
        np.testing.assert_allclose(back[name], data[name], rtol=1e-15)
        converted = VARIABLES[name].kind not in ("number", "angle", "mixed")
        assert (there[name].attrs["units"] != data[name].attrs["units"]) == converted


@pytest.mark.parametrize("hertz", [11.0, AT_RESONANCE, 30.0])
@pytest.mark.parametrize(
    "excitation", ["force", "base_displacement", "base_acceleration", "unbalance"]
)
def test_a_linear_machine_has_the_amplitude_of_its_closed_form(excitation, hertz):
    """On a moving base the amplitude is relative to the base."""
    value = {"force": 40, "base_displacement": 2e-4, "base_acceleration": 3, "unbalance": 0.002}
    machine = Machine(**SPRING | {"damping_ratio": 0.03}, **{excitation: value[excitation]})
    angular, damping = 2 * math.pi * hertz, 0.06 * math.sqrt(2e5 * 12)
    through = complex(2e5, damping * angular)
    force = {
        "force": 40,
        "base_displacement": 12 * 2e-4 * angular**2,
        "base_acceleration": 12 * 3,
        "unbalance": 0.002 * angular**2,
    }
    expected = abs(force[excitation] / (through - 12 * angular**2))
    found = idm.steady_motion(machine, None, hertz)
    assert found.attrs["machine"] and found["maximum_displacement"].attrs["units"] == "mm"
    assert float(found["maximum_displacement"]) == pytest.approx(1e3 * expected, rel=1e-7)


@pytest.fixture
def other_length(monkeypatch):
    """Return a function that makes the scale of length of all machines 1.7 times as large."""
    usual = Machine.scales.func

    def scales(machine):
        length = 1.7 * usual(machine).length
        stiffness = machine.linear_stiffness + abs(machine.cubic_stiffness) * length**2
        return Scales(length, math.sqrt(machine.mass / stiffness), machine.mass, si=True)

    def change():
        other = cached_property(scales)
        other.__set_name__(Machine, "scales")
        monkeypatch.setattr(Machine, "scales", other)

    return change


# The paper's oscillator and damper, if 2 mm, 10 ms and 3 kg are the units of length, time and mass.
HERTZ, STIFFNESS = 1 / (2 * math.pi * 1e-2), 3.0 / 1e-2**2
CUBIC = {"mass": 3.0, "cubic_stiffness": STIFFNESS / 2e-3**2, "damping": 64.5, "force": 60.0}
PAPER = {"mass": 0.36, "gap": 8e-3, "contact_stiffness": 2000 * STIFFNESS}


def of_paper(function, frequency, *, damper=PAPER, **given):
    """Call a function with the paper's oscillator in SI units."""
    machine = Machine(**CUBIC)
    return function(machine, machine.damper(**damper), frequency * HERTZ, **given)


# State from which the linear machine with its damper comes to small motions.
QUIET_START = (0.0, 0.0, 0.0, 0.3)
CALLS = {
    "simulate": lambda m, d: idm.simulate(m, d, 21.0, (1e-3, 0, 0, 0.1), periods=5),
    "steady_motion": lambda m, d: idm.steady_motion(m, d, AT_RESONANCE, QUIET_START),
    "periodic_orbit": lambda m, d: idm.periodic_orbit(
        m, d, AT_RESONANCE, CALLS["steady_motion"](m, d)["state"].values
    ),
    "harmonic_balance": lambda m, d: idm.harmonic_balance(m, None, [19.0, 22.0]),
    "frequency_response": lambda m, d: idm.frequency_response(
        m, d, [20.5, 20.8], starts=3, radius="3 mm"
    ),
    "clearance_sweep": lambda m, d: idm.clearance_sweep(
        m, d, AT_RESONANCE, [7.4e-3, 7.8e-3], starts=3, radius="3 mm"
    ),
    # The damper is on for 3 cycles only, so that chaos does not magnify rounding errors.
    "migrate": lambda *_: of_paper(idm.migrate, 1.95, seed=1, longest_hold=3)[
        ["displacement", "on_time", "off_time", "destination", "switchings"]
    ].isel(time=slice(1000)),
    "basins": lambda *_: of_paper(
        idm.basins,
        2.0,
        damper=PAPER | {"mass": 0.75, "gap": 4e-3, "restitution": 0.75},
        displacement=4e-4,
        velocity=0.06,
        cells=4,
        loose=["1 mm", -0.1],
    ),
}


NUMERICAL = ("periods_run", "run_length", "basin_time", "attractor_time", "liouville_error")


@pytest.mark.parametrize("name", CALLS)
def test_results_do_not_depend_on_the_scales(name, other_length):
    """A variable that is registered with a wrong physical quantity would change."""

    def called():
        machine = Machine(**SPRING, force=40)
        return CALLS[name](machine, machine.damper(**DAMPER))

    usual = called()
    other_length()
    other = called()
    compared = 0
    for each in usual.variables:
        values = usual[each].values
        if VARIABLES[each].kind == "mixed" or values.dtype.kind not in "fi":
            continue
        # Results of iterations, whose tolerances are in the machine's scales, may differ.
        numerical = each in NUMERICAL or "multiplier" in each
        if not numerical and "phase" not in each:
            np.testing.assert_allclose(other[each], values, rtol=2e-5, atol=2e-7, err_msg=each)
            compared += 1
    assert compared > 2


def test_branches_are_followed_from_motions_in_si():
    motions = idm.frequency_response(LINEAR, None, [20.0], starts=1)
    branches = idm.orbit_branches(LINEAR, None, span=(19, 22), motions=[motions])
    peak = 20 / math.sqrt(1 - 0.005**2)
    assert float(branches["orbit_displacement"].max()) == pytest.approx(peak, rel=1e-3)
    assert branches["followed_value"].values[[0, -1]] == pytest.approx([19, 22], rel=1e-12)


@pytest.mark.parametrize(
    ("function", "given", "told"),
    [
        (idm.simulate, (0,), "frequency = 0 Hz: must be at least"),
        (idm.simulate, (20, ("1 kg", 0, 0, 0)), "state[0] = '1 kg': must be"),
        (idm.frequency_response, ([20, "0 Hz"],), "frequencies[1] = '0 Hz': must"),
        (idm.migrate, (40.0,), "frequency = 40 Hz: without the damper there must be both a non-r"),
    ],
)
def test_wrong_arguments_are_named_in_si_units(function, given, told):
    machine = Machine(**CUBIC)
    with pytest.raises((TypeError, ValueError)) as raised:
        function(machine, machine.damper(**PAPER), *given)
    assert str(raised.value).startswith(told)


def test_the_radius_of_a_search_is_warned_of_in_si_units():
    expected = r"^radius = 1e-5 m: .* at frequency = 31 Hz, with displacement = 0\.00\d+ m and"
    with pytest.warns(UserWarning, match=expected):
        idm.frequency_response(Machine(**CUBIC), None, [31], starts=1, radius="10 µm")
