"""Frequency response as a labelled dataset."""

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from numpy.testing import assert_allclose

from impact_damper.motions.response import frequency_response

FREQUENCIES = np.array([1.95, 2.0, 2.05])


@pytest.fixture(scope="module")
def response():
    return frequency_response(PAPER, DESIGN, FREQUENCIES, starts=24, seed=4, workers=2)


def test_quiet_motion_is_there(response, design_orbit):
    """There is one branch with two contacts in a cycle; at W = 2 it is the known orbit."""
    quiet = (response.contacts == 2) & (response.period == 1)
    assert np.all(quiet.sum("motion") == 1)
    assert len(np.unique(response.branch.values[quiet.values])) == 1
    state = response.state.values[quiet.values][1]
    assert_allclose(np.abs(state[3]), np.abs(design_orbit.state[3]), atol=1e-7)
