"""Motions along a sweep: periods, branches, and ends of branches."""

import numpy as np
import pytest
from helpers.known_orbits import PAPER
from numpy.testing import assert_allclose

from impact_damper.data.datasets import flag
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.settling import Settling
from impact_damper.motions.simulate import random_states
from impact_damper.motions.start_states import NO_LOOSE, NO_STARTS, Search
from impact_damper.motions.sweep import sweep

FREQUENCIES = np.array([1.25, 1.4, 1.6, 1.75, 1.9, 2.0, 2.05, 2.1])


def random_search(states):
    """Return a search with these random starts alone."""
    return Search(
        states, [NO_STARTS] * len(states), [NO_LOOSE] * len(states), *np.zeros((4, len(states)))
    )


def free_sweep(frequencies, **options):
    parameters = np.array([pack(PAPER, None, w) for w in frequencies])
    states = np.array([random_states(12, 2.5, None, [2, i]) for i in range(len(frequencies))])
    return sweep(parameters, FREQUENCY, "frequency", random_search(states), Settling(), **options)


@pytest.fixture(scope="module")
def free():
    return free_sweep(FREQUENCIES, workers=2)


def ends_of(data, event="fold"):
    """Return parameter, direction and displacement of all ends of branches with one event."""
    chosen = data["end_event"] == flag("end_event", event)
    columns = (data["end_value"], data["end_direction"], data["end_displacement"])
    return np.array(columns).T[chosen]


def test_three_branches_of_the_free_oscillator(free):
    """Resonance, non-resonance and one-third subharmonic are found where they exist, no others."""
    period, size = free["period"][1], free["maximum_displacement"][1]
    assert np.array_equal((period == 1).sum(axis=1), [1, 2, 2, 2, 2, 2, 1, 1])
    assert np.array_equal((period == 3).sum(axis=1), [0, 0, 0, 1, 1, 1, 1, 0])
    branch = free["branch"][1]
    for chosen in ((period == 3), (period == 1) & (size > 1.5), (period == 1) & (size < 0.9)):
        assert len(np.unique(branch[chosen])) == 1
    assert len(np.unique(branch[period > 0])) == 3


def test_branches_end_at_folds(free):
    """All branches end at folds, and the ends do not depend on the grid of the sweep."""
    ends = ends_of(free)
    assert len(ends) == 4 == len(free["end_value"])
    other = ends_of(free_sweep(np.array([1.28, 1.5, 1.8, 2.0, 2.03, 2.09])))
    order, again = np.argsort(ends[:, 0]), np.argsort(other[:, 0])
    assert_allclose(ends[order], other[again], atol=1e-4)
    assert np.array_equal(ends[order][:, 1], [-1, -1, 1, 1])
