"""Tables of migration by different policies, from made-up data.

Migration takes the oscillator from its resonance to its small motion by switching the damper on and
off; a policy chooses the moments.
"""

import numpy as np
import xarray as xr

from chatterjee1995.tables.policies import (
    best_margin,
    release_disturbances,
    release_policies,
    release_predictions,
)

POLICIES = ["settled", "state", "clairvoyant"]
BOUNDS = ["share", "lower", "upper"]


def bounded(values):
    """Return values with intervals from 0.1 below to 0.1 above."""
    return np.stack([values, np.subtract(values, 0.1), np.add(values, 0.1)], axis=-1)


def made_up(settled=60.0, state=20.0, realised=0.505):
    """Return one damper at one frequency, and two disturbances."""
    cycles = bounded([[[[settled] * 2, [state] * 2, [10.0] * 2]]])
    two = ("case", "frequency", "policy")
    disturbed = ("case", "noisy_frequency", "disturbance", "margin", "bound")
    return xr.Dataset(
        {
            "case_mass_ratio": ("case", [0.12]),
            "case_clearance": ("case", [2.0]),
            "case_restitution": ("case", [1.0]),
            "policy_success": ((*two, "bound"), bounded([[[0.3, 0.8, 1.0]]])),
            "policy_cycles": ((*two, "quantile", "bound"), cycles),
            "policy_damper": ((*two, "bound"), bounded([[[9.0, 3.0, 2.0]]])),
            "policy_impacts": ((*two, "bound"), bounded([[[9.0, 3.0, 2.0]]])),
            "policy_releases": (two, [[[3.0, 2.0, 1.0]]]),
            "policy_hold": (two, [[[np.nan, 5.0, np.nan]]]),
            "policy_phase": (two, [[[np.nan] * 3]]),
            "predicted_share": (("case", "frequency", "bound"), bounded([[0.5]])),
            "realised_share": (("case", "frequency", "bound"), bounded([[realised]])),
            "agreeing_share": (("case", "frequency", "bound"), bounded([[0.99]])),
            "least_impulse": ("frequency", [1.4]),
            "disturbed_success": (disturbed, bounded([[[[0.8, 0.8, 0.5], [0.2, 0.4, 0.6]]]])),
            "disturbed_cycles": (disturbed, bounded([[[[30.0, 20.0, 9.0], [9.0, 8.0, 7.0]]]])),
        },
        {
            "frequency": [1.7],
            "policy": POLICIES,
            "quantile": [0.5, 0.95],
            "bound": BOUNDS,
            "noisy_frequency": [1.7],
            "disturbance": ["none", "noise 10 %"],
            "margin": [0.0, 0.01, 0.02],
        },
    )


def table(function, **changes):
    return function({"release_policies": {"paper": made_up(**changes)}})


def test_policies_and_bound_have_a_row_each():
    rows = table(release_policies).set_index("policy")
    assert list(rows.index) == POLICIES
    assert rows.loc["state", "median cycles"] == 20 and rows.loc["state", "hold"] == 5
    assert rows.loc["state", "rule"] == "state in the goal's basin, margin 0, at most K = 5"
    assert rows.loc["state", "share and interval"] == "0.8 (0.7 to 0.9)"
    assert set(rows["damper"]) == {"rm = 0.12, d0 = 2, e = 1"}


def test_predictions_are_told_to_hold_or_not():
    (row,) = table(release_predictions).to_dict("records")
    assert row["within 1 %"] == "yes" and row["at most half"] == "yes"
    (row,) = table(release_predictions, realised=0.52, state=31.0).to_dict("records")
    assert row["within 1 %"] == "no" and row["at most half"] == "no"
    (row,) = table(release_predictions, settled=np.inf, state=176.0).to_dict("records")
    assert row["at most half"] == "no" and np.isnan(row["state over settled"])
    (row,) = table(release_predictions, state=np.inf).to_dict("records")
    assert row["at most half"] == "not known"


def test_the_best_margin_has_the_most_success_and_then_the_least_time():
    data = made_up().isel(case=0, noisy_frequency=0)
    assert best_margin(data.sel(disturbance="none")) == 0.01
    assert best_margin(data.sel(disturbance="noise 10 %")) == 0.02
    rows = table(release_disturbances).set_index("disturbance")
    assert rows.loc["noise 10 %", ["without margin", "with best margin"]].tolist() == [0.2, 0.6]
    assert np.all(rows["clairvoyant"] == 1)
    margins = ["margin 0", "margin 0.01", "margin 0.02", "margin 0.02, median cycles"]
    assert rows.loc["noise 10 %", margins].tolist() == [0.2, 0.4, 0.6, 7]
