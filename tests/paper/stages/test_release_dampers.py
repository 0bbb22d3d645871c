"""Dampers compared for migration and suppression.

Suppression leaves the damper on; migration switches it on and off to reach the small motion of the
oscillator without a damper.

The quiet orbit is the small symmetric periodic motion for which a damper is designed.
"""

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_array_equal

from chatterjee1995.stages.best_dampers import best_clearances
from chatterjee1995.stages.release_dampers import WAITS, release_dampers
from chatterjee1995.stages.release_trials import free_case
from chatterjee1995.tables.policies import release_answers
from chatterjee1995.tables.policies import release_dampers as table
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.policies import run_trials
from impact_damper.motions.policy_choice import best_policy
from impact_damper.orbits.clearance_sweep import clearance_sweep

CUBIC = Oscillator(0.215)
CUT = {"mass_ratio": 0.12, "clearance": 2.0, "restitutions": [0.9, 1.0]}


@pytest.fixture(scope="module")
def data():
    grid = [0.12, 0.3], [1.0, 2.0], [1.0]
    return release_dampers(CUBIC, [2.0], *grid, cut=CUT, trials=6, starts=4, cells=16)


def test_a_damper_on_map_and_cut_has_the_same_numbers(data):
    on_map = data.isel(frequency=0).sel(mass_ratio=0.12, clearance=2, restitution=1)
    on_cut = data.isel(frequency=0).sel(cut_restitution=1)
    for name in ("success", "cycles", "quiet", "largest"):
        assert_array_equal(on_map[f"damper_{name}"], on_cut[f"cut_{name}"])


def test_success_is_that_of_trials_with_the_damper(data):
    free = free_case(CUBIC, 2.0, 16, Settling(), 1)
    on = pack(CUBIC, Damper(0.3, 1.0), 2.0)
    policy = best_policy(on, free, WAITS, 6, 350.0, [1995, 1])
    outcome = run_trials(on, free, policy, 6, 350.0, 1995)
    found = data.isel(frequency=0).sel(mass_ratio=0.3, clearance=1, restitution=1, policy="state")
    assert found.damper_success.sel(bound="share") == np.mean(outcome.reached)


def test_the_quiet_displacement_is_that_of_the_orbit(data):
    """It agrees with the orbit that Newton's method follows over the clearance."""
    sweep = clearance_sweep(CUBIC, {"mass_ratio": 0.12}, 2.0, [1.9, 2.0], starts=4)
    found = data.isel(frequency=0).sel(mass_ratio=0.12, clearance=2, restitution=1)
    assert float(found.damper_quiet) == pytest.approx(float(sweep.quiet_displacement[1]), rel=1e-6)
    assert np.all((data.damper_quiet <= data.damper_largest) | data.damper_quiet.isnull())


def made_up(state, quiet):
    """Return a dataset with one mass ratio and three clearances.

    `state` is the success of the policy by state, and `quiet` the quiet displacement, at each
    clearance.
    """
    cycles = np.array([[np.inf, 30.0, 20.0], [np.inf, 40.0, 50.0]])
    dims = ("policy", "mass_ratio", "clearance", "bound")
    bounds = [0.0, -1.0, 1.0]
    success = np.array([state, [0.0, 0.0, 0.0]])
    return xr.Dataset(
        {
            "damper_success": (dims, np.repeat(success[:, None, :, None], 3, -1)),
            "damper_cycles": (dims, cycles[:, None, :, None] + bounds),
            "damper_quiet": (("mass_ratio", "clearance"), [quiet]),
            "resonance_displacement": 2.0,
        },
        {
            "policy": ["state", "settled"],
            "mass_ratio": [0.1],
            "clearance": [1.0, 2.0, 3.0],
            "bound": ["share", "lower", "upper"],
            "frequency": 1.7,
            "restitution": 1.0,
        },
    )


def test_best_clearances():
    best = best_clearances(made_up([0, 1, 1], [0.3, 0.1, np.nan]))
    assert (best["migration"], best["suppression"]) == (3, 2)
    best = best_clearances(made_up([0, 0, 0], [np.nan] * 3))
    assert np.isnan([*best.values()]).all()
    one = made_up([0, 1, 1], [0.3, 0.1, np.nan]).expand_dims(["frequency", "restitution"])
    one["resonance_displacement"] = ("frequency", [2.0])
    (row,) = table({"release_dampers": {"paper": one}}).to_dict("records")
    assert row["same"] == "no" and row["quiet"] == pytest.approx(0.05)
    assert row["median cycles"] == 20 and row["median cycles, suppression"] == 30
    (row,) = release_answers({"release_dampers": {"paper": one}}).to_dict("records")
    assert row["for migration"] == "rm = 0.1, d0 = 3"
    assert row["answer"] == "no; the damper for suppression is slower"
    assert row["for suppression"] == "rm = 0.1, d0 = 2" and row["quiet, suppression"] == 0.05
