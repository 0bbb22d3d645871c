"""Parameters: their meaning, places in the packed array, errors for wrong values and names."""

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

import impact_damper as idm
from impact_damper.model import packed
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator, describe
from impact_damper.model.settling import Settling


@pytest.mark.parametrize("mass_ratio", [0.01, 0.25, 10.0])
@pytest.mark.parametrize("restitution", [0.05, 0.3, 0.75, 0.9, 1.0])
def test_damping_of_the_contact_gives_the_restitution(mass_ratio, restitution):
    """Equation (25) gives e = exp(-pi z/sqrt(1 - z^2)) with the relative damping ratio z."""
    damper = Damper(mass_ratio, 1.0, restitution)
    z = damper.contact_damping * math.sqrt(1 + mass_ratio)
    assert_allclose(math.exp(-math.pi * z / math.sqrt(1 - z**2)), restitution, rtol=1e-14)
    # The relative motion with the penetration q solves q'' + (1 + 1/rm)(dashpot q' + r1 q) = 0.
    inverse = 1 + 1 / mass_ratio
    natural = math.sqrt(damper.contact_stiffness * inverse)
    assert_allclose(damper.dashpot * inverse, 2 * z * natural, atol=1e-14)


def test_without_a_damper_walls_are_out_of_reach_and_exert_no_force():
    p = pack(Oscillator(0.04, 0.9), None, 1.7)
    assert p[packed.CLEARANCE] == np.inf
    assert not np.any(p[[packed.CONTACT_STIFFNESS, packed.INVERSE_MASS_RATIO, packed.DASHPOT]])


def test_datasets_store_the_parameters_of_a_run():
    stored = describe(Oscillator(0.2), Damper(0.1, 2.0), Settling(limit=700))
    assert {"damping", "clearance", "gravity", "friction"} < stored.keys()
    assert stored["limit"] == 700


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
