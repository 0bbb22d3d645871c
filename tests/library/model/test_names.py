"""A misspelt argument, name or parameter is answered with the nearest known one."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import impact_damper as idm

ROOT = Path(__file__).parents[3]
OSCILLATOR, DAMPER = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
MACHINE = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)


@pytest.mark.parametrize(
    ("call", "meant"),
    [
        (lambda: idm.Oscillator(dampng=0.2), "damping"),
        (lambda: idm.Machine(mass=1, linear_stifness=2), "linear_stiffness"),
        (lambda: MACHINE.damper(mass=1, gap=0.1, restituton=1), "restitution"),
        (lambda: idm.simulate(OSCILLATOR, None, 2.0, period=3), "periods"),
        (lambda: idm.design_damper(MACHINE, mas=1), "mass"),
    ],
)
def test_a_misspelt_argument_is_answered(call, meant):
    with pytest.raises(TypeError, match=f"has no argument .*; did you mean {meant}\\?"):
        call()


def test_a_misspelt_parameter_of_a_branch_is_answered():
    given = {"state": (0, 0, 0, 0), "span": (1, 3)}
    with pytest.raises(ValueError, match="parameter = .*did you mean clearance"):
        idm.orbit_branches(OSCILLATOR, DAMPER, 2.0, parameter="clearence", **given)
    with pytest.raises(ValueError, match="parameter = .*did you mean frequency"):
        idm.orbit_branches(MACHINE, None, 20.0, (0, 0), parameter="frequnecy", span=(18, 22))


def test_the_gap_of_a_machine_is_its_full_play_along_a_branch():
    damper = MACHINE.damper(mass=0.6, gap=5e-3, restitution=0.7, contact_stiffness=2e7)
    state = idm.steady_motion(MACHINE, damper, 20.5, (0, 0, 0, 0.3)).state.values
    given = {"parameter": "gap", "span": ("4 mm", "6 mm")}
    found = idm.orbit_branches(MACHINE, damper, 20.5, state, **given).followed_value
    assert (float(found.min()), float(found.max())) == pytest.approx((4, 6))
    assert found.long_name.endswith("full play")


def test_the_version_is_stated_alike_everywhere():
    assert f'version = "{idm.__version__}"' in (ROOT / "pyproject.toml").read_text()
    assert f"version: {idm.__version__}" in (ROOT / "CITATION.cff").read_text()


def test_the_help_begins_with_the_public_names():
    assert len(idm.__all__) <= 19 and all(name in idm.__doc__ for name in idm.__all__)


def test_a_number_of_a_dataset_is_an_argument():
    best = xr.DataArray(2.0, attrs={"units": "1"})
    assert idm.Damper(0.12, best) == DAMPER
    assert isinstance(idm.Damper(np.array(0.12), best).clearance, float)
    with pytest.raises(ValueError, match="clearance = 2.0 mm: must be dimensionless"):
        idm.Damper(0.12, best.assign_attrs(units="mm"))
    gap = xr.DataArray(3.0, attrs={"units": "mm"})
    made = MACHINE.damper(mass=0.6, clearances=(gap, gap), contact_stiffness=2e7)
    assert made.gap == 0.006


def test_the_optimum_of_a_sweep_is_a_gap_of_a_machine():
    damper = MACHINE.damper(mass=0.6, gap=5e-3, restitution=0.7, contact_stiffness=2e7)
    given = 20.5, ["2 mm", "5 mm", "9 mm"]
    best = idm.clearance_sweep(MACHINE, damper, *given, method="harmonic_balance").rule_clearance
    force = MACHINE.force / (damper.mass * (2 * np.pi * 20.5) ** 2)
    assert float(best) == pytest.approx(1e3 * 2 * force, rel=1e-9)  # rule (18), full play in mm
    assert MACHINE.damper(mass=0.6, gap=best, contact_stiffness=2e7).gap == pytest.approx(2 * force)
