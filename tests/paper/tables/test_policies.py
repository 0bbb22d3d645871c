"""The table of policies of migration, from made-up data."""

import numpy as np
import xarray as xr

from chatterjee1995.tables.policies import release_policies

POLICIES = ["settled", "hold", "state"]
BOUNDS = ["share", "lower", "upper"]


def bounded(values):
    """Return values with intervals from 0.1 below to 0.1 above."""
    return np.stack([values, np.subtract(values, 0.1), np.add(values, 0.1)], axis=-1)


def made_up():
    """Return one damper at one frequency."""
    two = ("case", "frequency", "policy")
    cycles = bounded([[[[60.0] * 2, [30.0] * 2, [20.0] * 2]]])
    return xr.Dataset(
        {
            "case_mass_ratio": ("case", [0.12]),
            "case_clearance": ("case", [2.0]),
            "case_restitution": ("case", [1.0]),
            "policy_success": ((*two, "bound"), bounded([[[0.3, 0.6, 0.8]]])),
            "policy_cycles": ((*two, "quantile", "bound"), cycles),
            "policy_damper": ((*two, "bound"), bounded([[[9.0, 5.0, 3.0]]])),
            "policy_impacts": ((*two, "bound"), bounded([[[9.0, 5.0, 3.0]]])),
            "policy_releases": (two, [[[3.0, 2.0, 1.0]]]),
            "policy_hold": (two, [[[np.nan, 5.0, 5.0]]]),
            "policy_phase": (two, [[[np.nan] * 3]]),
        },
        {"frequency": [1.7], "policy": POLICIES, "quantile": [0.5, 0.95], "bound": BOUNDS},
    )


def test_each_policy_has_a_row():
    rows = release_policies({"release_policies": {"paper": made_up()}}).set_index("policy")
    assert list(rows.index) == POLICIES
    assert rows.loc["state", "median cycles"] == 20 and rows.loc["state", "hold"] == 5
    assert rows.loc["state", "rule"] == "state in the goal's basin, at most K = 5"
    assert rows.loc["state", "share and interval"] == "0.8 (0.7 to 0.9)"
    assert set(rows["damper"]) == {"rm = 0.12, d0 = 2, e = 1"}
