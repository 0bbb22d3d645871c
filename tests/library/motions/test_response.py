"""Frequency response as a labelled dataset, and the share of starts that collide.

W is the forcing frequency. A start is an initial state.
"""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from helpers.sampling import sample
from numpy.testing import assert_allclose
from scipy import stats

from impact_damper.data.datasets import flag
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper
from impact_damper.motions.response import collisions, frequency_response
from impact_damper.motions.simulate import random_states

FREQUENCIES = np.array([1.95, 2.0, 2.05])


@pytest.fixture(scope="module")
def response():
    return frequency_response(PAPER, DESIGN, FREQUENCIES, starts=24, seed=4, workers=2)


def test_response_counts_the_starts_that_lead_to_each_motion(response):
    assert response.sizes["frequency"] == 3 and response.sizes["start"] == 24
    assert np.all(response.motion_starts.sum("motion") == 24)
    settled = (response.run_outcome == flag("outcome", "settled")).sum("start")
    counted = response.motion_starts.where(response.outcome == flag("outcome", "settled"), 0).sum(
        "motion"
    )
    assert np.array_equal(settled, counted)
    followed = response.origin == flag("origin", "followed")
    assert np.all(response.motion_starts.where(followed, 0) == 0)


def test_quiet_motion_is_there(response, design_orbit):
    """There is one branch with two contacts in a cycle; at W = 2 it is the known orbit."""
    quiet = (response.contacts == 2) & (response.period == 1)
    assert np.all(quiet.sum("motion") == 1)
    assert len(np.unique(response.branch.values[quiet.values])) == 1
    state = response.state.values[quiet.values][1]
    assert_allclose(np.abs(state[3]), np.abs(design_orbit.state[3]), atol=1e-7)


@pytest.mark.parametrize(
    "wrong, message",
    [
        ({"frequencies": [2.0, 1.0]}, "frequencies = .*: must be increasing"),
        ({"frequencies": []}, "at least 1 value"),
        ({"frequencies": [0.0, 1.0]}, r"frequencies\[0\] = 0"),
        ({"frequencies": math.nan}, r"frequencies\[0\] = nan"),
        ({"frequencies": [1.0], "seed": -1}, "seed = -1"),
        ({"frequencies": [1.0], "starts": 0}, "starts = 0"),
        ({"frequencies": [1.0], "radius": -1.0}, "radius = -1"),
    ],
)
def test_arguments_are_checked(wrong, message):
    with pytest.raises(ValueError, match=message):
        frequency_response(PAPER, DESIGN, **wrong)


def test_collisions():
    """The share beyond a wall follows from the volume of the ball.

    Other starts collide at the times of simulated first contacts.
    """
    damper, starts = Damper(0.25, 1.0), 1500
    data = collisions(PAPER, damper, 1.8, starts=starts, radius=2.0, periods=60)
    literal, within = data.isel(ball=0), data.isel(ball=1)
    expected = 2 * stats.beta(2.5, 2.5).cdf((1 - damper.clearance / 2) / 2)
    error = math.sqrt(expected * (1 - expected) / starts)
    assert abs(literal.beyond_wall - expected) < 4 * error
    assert within.beyond_wall == 0
    assert literal.colliding >= literal.beyond_wall
    p, waits = pack(PAPER, damper, 1.8), []
    for state in random_states(starts, 2.0, damper, [1995, 1])[:100]:
        _, log = sample(p, state, 0.0, [60 * 2 * math.pi / 1.8], 1e-9)
        waits.append(log[0, 1] * 1.8 / (2 * math.pi) if len(log) else math.inf)
    finite = np.array(waits)[np.isfinite(waits)]
    assert np.max(finite) <= within.longest_wait + 1e-9
    assert abs(within.colliding - len(finite) / 100) < 0.15
