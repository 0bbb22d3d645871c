"""Trajectories and contacts against heyoka.py, a Taylor integrator that locates events.

Z2 is the displacement of the primary mass relative to the loose mass.
"""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER
from helpers.sampling import sample
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from impact_damper.kernel.single import side_of
from impact_damper.model.packed import CLEARANCE, pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions.simulate import random_states
from impact_damper.motions.strobe_map import period_map

TOLERANCES = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12]
DAMPERS = pytest.mark.parametrize("damper", [DESIGN, INELASTIC], ids=["elastic", "inelastic"])


def compare(heyoka_references, p, state, start, times, atol, side=0):
    """Compare states and contacts of the kernel with two runs of heyoka; return its contacts."""
    states, log = sample(p, state, start, times, 1e-14)
    for reference in heyoka_references:
        expected = reference.run(p, state, start, times, side)
        assert len(expected.contacts) == len(log)
        assert_allclose(states, expected.states, atol=atol)
        assert np.array_equal(log[:, 0], expected.contacts[:, 0])
        assert_allclose(log[:, 1:], expected.contacts[:, 1:], atol=atol)
    return log


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_error_stays_within_ten_tolerances(known_orbit, heyoka_references, tolerance):
    """Compare after 20 periods, from a state on an orbit and from a state close to the orbit."""
    p, end = known_orbit.parameters, known_orbit.strobe + 20 * known_orbit.period
    for nudge in (0.0, 1e-2):
        first = known_orbit.state + nudge
        expected = heyoka_references[0].run(p, first, known_orbit.strobe, [end])
        (last,), log = sample(p, first, known_orbit.strobe, [end], tolerance)
        assert len(log) == len(expected.contacts)
        assert np.max(np.abs(last - expected.states[0])) < 10 * tolerance


def test_whole_motion(known_orbit, heyoka_references):
    """All samples, in flight and in contact, and all contacts agree."""
    times = known_orbit.strobe + np.linspace(0, 5, 401)[1:] * known_orbit.period
    log = compare(
        heyoka_references,
        known_orbit.parameters,
        known_orbit.state,
        known_orbit.strobe,
        times,
        1e-11,
    )
    assert len(log) == (10 if known_orbit.damper else 0)


@DAMPERS
@pytest.mark.parametrize("linear_frequency", [0.0, 1.5])
@pytest.mark.parametrize("speed", [-3.0, -0.5, 0.0, 0.5, 3.0])
def test_start_in_contact(heyoka_references, damper, linear_frequency, speed):
    p = pack(Oscillator(0.215, linear_frequency), damper, 2.0)
    times = np.linspace(0, 0.5, 51)[1:]
    for side in (1, -1):
        state = np.array([0.4, -0.3, side * (damper.clearance + 0.02), speed])
        assert side_of(p, state) == side
        log = compare(heyoka_references, p, state, 0.0, times, 1e-11, side)
        assert log[0, 0] == side and log[0, 1] == 0.0 and log[0, 3] == speed


def grazing_state(reference, p, depth):
    """Return a start, and the time at which Z2 has its first maximum, `depth` beyond the wall.

    The maximum is that of the motion without walls.
    """
    state = np.array([0.3, 0.5, 0.0, 0.9])
    unbounded = p.copy()
    unbounded[CLEARANCE] = 16.0

    def free(t):
        return reference.run(unbounded, state, 0.0, [t]).states[0]

    instant = brentq(lambda t: free(t)[3], 0.3, 3.0, xtol=1e-14)
    state[2] += p[CLEARANCE] + depth - free(instant)[2]
    return state, instant


@DAMPERS
@pytest.mark.parametrize("exponent", range(3, 14))
def test_no_grazing_contact_is_missed_or_invented(heyoka_references, damper, exponent):
    p = pack(PAPER, damper, 2.0)
    depth = 10.0**-exponent
    for sign in (1, -1):
        state, instant = grazing_state(heyoka_references[0], p, sign * depth)
        _, log = sample(p, state, 0.0, [instant + 0.3])
        assert len(log) == (sign == 1)
        if sign == 1:
            assert log[0, 1] < instant
            assert 0 < log[0, 3] < 3 * math.sqrt(6 * depth)
        # The speed of approach is the square root of a depth with rounding errors.
        compare(heyoka_references, p, state, 0.0, [instant + 0.3], 3e-15 / math.sqrt(depth) + 1e-11)


@pytest.mark.parametrize(
    "damper", [DESIGN, INELASTIC, Damper(0.4, 0.625, 0.3)], ids=["elastic", "inelastic", "dead"]
)
def test_random_starts(heyoka_references, damper):
    """Numbers of contacts agree; states agree within the growth of errors along the motion."""
    p = pack(PAPER, damper, 1.7)
    start, end = math.pi / 3.4, math.pi / 3.4 + 2 * math.pi / 1.7
    counted = 0
    for state in random_states(150, 2.0, damper, 3):
        _, matrix, contacts = period_map(p, state, 1, 1e-14)
        sensitivity = 1e-13 * (10 + np.linalg.norm(matrix))
        (last,), log = sample(p, state, start, [end])
        assert len(log) == contacts
        for reference in heyoka_references:
            expected = reference.run(p, state, start, [end])
            assert len(expected.contacts) == contacts
            assert_allclose(last, expected.states[0], atol=sensitivity)
        counted += contacts
    assert counted > 150
