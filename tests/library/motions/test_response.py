"""Frequency response as a labelled dataset; lives of chaotic motions."""

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from numpy.testing import assert_allclose

from impact_damper.data.datasets import flag
from impact_damper.model.packed import pack
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble
from impact_damper.motions.records import CHAOTIC
from impact_damper.motions.response import find_lives, frequency_response

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


RUNNING = {"workers": 2, "progress": None}


@pytest.fixture(scope="module")
def violent():
    """Return parameters and states of chaotic motions of figure 5 (a), at two frequencies."""
    parameters = np.array([pack(PAPER, DESIGN, frequency) for frequency in (1.1, 1.6)])
    starts = np.random.default_rng(7).uniform(-1.5, 1.5, (48, 4))
    states = []
    for p in parameters:
        found = ensemble.settle(np.tile(p, (len(starts), 1)), starts, Settling(patience=100))
        states.append(found[found["outcome"] == CHAOTIC]["state"][0])
    return parameters, np.array(states)[:, None]


def lives(violent, runs, periods, seed=1):
    parameters, states = violent
    outcomes = np.full((len(parameters), 1), flag("outcome", "chaotic"))
    return find_lives(parameters, outcomes, states, runs, periods, seed, Settling(), **RUNNING)


def test_transient_is_told_from_chaos_that_lasts(violent):
    found = lives(violent, 12, 1000)
    lasting, transient = ({name: values[i, 0] for name, values in found.items()} for i in range(2))
    assert lasting["life_ends"] == 0 and np.isnan(lasting["mean_life"])
    # If chaos ends in none of n runs of length T, the 95 % interval of the rate ends at
    # -ln(0.025)/(n T).
    assert_allclose(lasting["mean_life_lower"], 12 * 1000 / -np.log(0.025))
    assert np.isinf(lasting["mean_life_upper"])
    assert transient["life_ends"] > 6
    assert transient["mean_life_lower"] < transient["mean_life"] < transient["mean_life_upper"]
