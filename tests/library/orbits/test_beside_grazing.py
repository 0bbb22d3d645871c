"""Branches close to a grazing: derivatives, ends at other branches, branches that leave."""

import numpy as np
import pytest
from helpers.known_orbits import INELASTIC, PAPER, polished_orbit
from numpy.testing import assert_allclose
from references import extended

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit
from impact_damper.orbits.switching import other_branch

# States at W T = pi/2 of stable orbits, and their frequencies.
TWICE = 1.159, (0.128, 0.730, 0.408, 0.021)
THRICE = 1.307, (0.1335, 0.4984, -0.1455, -1.1693)


def family(value):
    return pack(PAPER, INELASTIC, value)


@pytest.fixture(scope="module")
def twice():
    """Return the branch of period 2 from W = 1.1 on."""
    value, state = TWICE
    return follow_branch(family, find_orbit(family(value), state, 2), value, (1.1, 1.3))


@pytest.fixture(scope="module")
def thrice():
    """Return the branch of symmetric orbits of period 3 near W = 1.23."""
    value, state = THRICE
    return follow_branch(family, find_orbit(family(value), state, 3), value, (1.2, 1.32))


@pytest.fixture(scope="module")
def asymmetric(thrice):
    """Return a loss of symmetry next to a grazing, and a point of the branch that begins at it."""
    places = [event.point.value for _, event in thrice.events if event.kind == "grazing"]
    event = next(
        event
        for _, event in thrice.events
        if event.kind == "symmetry_breaking"
        and np.min(np.abs(np.subtract(places, event.point.value))) < 1e-8
    )
    return event, other_branch(event)


def test_ends_of_a_doubled_branch_are_doublings_of_the_other(twice):
    """A branch of period 2 ends where a branch of period 1 has period doublings."""
    value, state = 1.95, polished_orbit("inelastic").state
    other = follow_branch(family, find_orbit(family(value), state), value, (1.1, 2.0))
    walks = [other]
    lost = next(event for _, event in other.events if event.kind == "symmetry_breaking")
    point = other_branch(lost)
    walks.append(follow_branch(family, point.orbit, point.value, (1.1, 2.0)))
    doublings = [
        event.point.value
        for walk in walks
        for _, event in walk.events
        if event.kind == "period_doubling"
    ]
    assert twice.ends == ("period_doubling", "period_doubling") and twice.lost == 0
    for end in (twice.points[0], twice.points[-1]):
        assert np.min(np.abs(np.subtract(doublings, end.value))) < 1e-8


def test_80_bit_motion_repeats_from_an_orbit_beside_a_grazing(asymmetric):
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    _, point = asymmetric
    orbit = find_orbit(family(point.value), point.orbit.strobe_states[0], 3)
    frequency = extended.Real(orbit.p[FREQUENCY])
    begin = extended.Real(orbit.phase) / frequency
    period = 6 * np.arccos(extended.Real(-1)) / frequency
    run = extended.run(orbit.p, orbit.state, begin, [begin + period])
    assert_allclose(run.states[-1].astype(float), orbit.state, rtol=0, atol=1e-11)
    assert len(orbit.sequence) == 7 and orbit.record["asymmetry"] > 1e-6
