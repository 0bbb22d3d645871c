"""Policies of migration as evidence for claims, from made-up data.

A policy decides when the damper is switched off, so that the oscillator reaches its small motion.
"""

import math

import numpy as np
import pytest
import xarray as xr
from helpers.made_up import world

from chatterjee1995.claims.policies import SHARES, by_policy
from chatterjee1995.claims.verdicts import CLAIMS
from impact_damper.data.datasets import damper_of


@pytest.fixture
def data():
    return world()


def policies(case, frequency):
    """Return a dataset of policies with the damper of a case, at one frequency.

    Their shares of success are 0.1, 0.2, ... in the order of SHARES.
    """
    damper = damper_of(case)
    share = np.arange(1, len(SHARES) + 1) / 10
    bounded = share[:, None] + [0, -0.05, 0.05]
    dims = ("case", "frequency", "policy", "bound")
    return xr.Dataset(
        {
            "policy_success": (dims, bounded[None, None]),
            "policy_cycles": ((*dims[:3], "quantile", "bound"), 100 * bounded[None, None, :, None]),
            "realised_share": (("case", "frequency", "bound"), np.full((1, 1, 3), 0.7)),
            "case_mass_ratio": ("case", [damper.mass_ratio]),
            "case_clearance": ("case", [damper.clearance]),
            "case_restitution": ("case", [damper.restitution]),
        },
        {
            "policy": list(SHARES),
            "frequency": [frequency],
            "quantile": [0.5],
            "bound": ["share", "lower", "upper"],
        },
        case.attrs,
    )


def test_numbers_are_those_of_the_damper_at_the_frequency(data):
    case = data["migration"]["figure_15"]
    found = by_policy({"release_policies": {"paper": policies(case, 1.7)}}, case)
    assert [found[f"by_{name}"] for name in SHARES] == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert found["by_state_least"] == pytest.approx(0.05)
    assert found["by_state_cycles"] == pytest.approx(10) and found["through"] == 0.7
    other = by_policy({"release_policies": {"paper": policies(case, 1.8)}}, case)
    assert all(math.isnan(value) for value in other.values()) and other.keys() == found.keys()


def test_claims_cite_the_policies(data):
    cases = data["migration"]
    data["release_policies"] = {
        "a": policies(cases["figure_15"], 1.7),
        "b": policies(cases["figure_13"], 1.95),
    }
    rows = {claim.number: claim.judge(data) for claim in CLAIMS if claim.number in ("13", "14")}
    assert "30 % of the runs arrive" in rows["13"]["finding"]
    assert "upper end of this interval: 0.15" in rows["14"]["evidence"]
