"""Single motions with labels, random starts, and ensembles on several threads."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from numpy.testing import assert_allclose
from scipy import stats

from impact_damper.model.parameters import Damper
from impact_damper.motions.response import steady_orbit
from impact_damper.motions.simulate import COMPONENTS, random_states, simulate

ON_ORBIT = (0.00572, 0.187394, 0.001944, -2.407912)


def test_samples_and_contacts_of_a_simulation():
    data = simulate(PAPER, DESIGN, 2.0, (0, 0, 0, 1), periods=6.5, samples=100)
    assert data.sizes["time"] == 651
    assert_allclose(data.time[[0, -1]], [0, 6.5 * math.pi], rtol=1e-15)
    assert_allclose(np.diff(data.time), math.pi / 100, rtol=1e-10)
    assert_allclose([data[name][0] for name in list(data)[:4]], [0, 0, 0, 1])
    # |Z2| exceeds the clearance exactly during contacts
    beyond = np.sign(data.relative_displacement) * (abs(data.relative_displacement) > 2)
    t = data.time.values[:, None]
    within = (t > data.contact_begin.values) & (t < data.contact_end.values)
    assert np.array_equal(beyond, within @ data.contact_wall.values)
    assert np.all(data.approach_velocity * data.contact_wall > 0)
    assert np.all(data.departure_velocity * data.contact_wall < 0)
    # the velocity is the derivative of the displacement
    difference = np.gradient(data.displacement, data.time.values, edge_order=2)
    assert_allclose(difference, data.velocity, atol=0.1)


@pytest.mark.parametrize("damper", [None, DESIGN, Damper(0.4, 0.625)])
@pytest.mark.parametrize("within_gap", [True, False])
def test_random_states_are_uniform(damper, within_gap):
    """States are uniform in a ball, which the walls cut off with `within_gap`."""
    states = random_states(4000, 2.0, damper, 5, within_gap=within_gap)
    assert states.shape == (4000, 4)
    if damper is None:
        assert np.array_equal(states[:, :2], states[:, 2:])
        states = states[:, :2]
    size = states.shape[1]
    radius = np.linalg.norm(states, axis=1)
    assert np.max(radius) <= 2.0
    if damper is not None and within_gap:
        assert np.max(np.abs(states[:, 2])) < damper.clearance
    if damper is None or not within_gap or damper.clearance >= 2:
        assert stats.kstest((radius / 2) ** size, "uniform").pvalue > 0.01
        for values in states.T:
            # a coordinate u of a uniform ball: (1 + u/2)/2 is a symmetric beta variable
            shape = (size + 1) / 2
            assert stats.kstest((1 + values / 2) / 2, stats.beta(shape, shape).cdf).pvalue > 0.001
    else:
        # for any given Z2 the other components are uniform in the remaining ball
        left = 1 - (states[:, 2] / 2) ** 2
        others = np.linalg.norm(states[:, [0, 1, 3]], axis=1) / (2 * np.sqrt(left))
        assert stats.kstest(others**3, "uniform").pvalue > 0.01


def test_steady_orbit_closes():
    orbit = steady_orbit(PAPER, DESIGN, 2.0, (1.0, 0.5, 0.0, 0.0))
    ends = [orbit[name].values[[0, -1]] for name in COMPONENTS]
    assert_allclose(*np.transpose(ends), atol=1e-8)
    assert_allclose(np.ptp(orbit.time.values), np.pi)
    assert orbit.sizes["contact"] == 2
