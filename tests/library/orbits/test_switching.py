"""The other branch at a bifurcation, compared with laws of bifurcations and with simulations."""

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER, polished_orbit
from numpy.testing import assert_allclose

from impact_damper.model.packed import pack
from impact_damper.model.settling import Settling
from impact_damper.motions.ensemble import settle
from impact_damper.orbits import switching
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit
from impact_damper.orbits.switching import met_branch, other_branch


def event_of(damper, name, frequency, span, kind):
    """Return the first event of a kind on the branch of a known orbit, and its `family`."""

    def family(value):
        return pack(PAPER, damper, value)

    orbit = find_orbit(family(frequency), polished_orbit(name).state)
    branch = follow_branch(family, orbit, frequency, span)
    return next(event for _, event in branch.events if event.kind == kind), family


@pytest.fixture(scope="module")
def lost():
    return event_of(None, "resonance", 2.0, (0.6, 2.1), "symmetry_breaking")[0]


@pytest.fixture(scope="module")
def doubling():
    return event_of(DESIGN, "large", 1.7, (1.58, 1.8), "period_doubling")


def test_two_mirror_images_leave_where_symmetry_is_lost(lost):
    orbit = other_branch(lost).orbit
    image = find_orbit(orbit.p, -orbit.at(orbit.phase + np.pi), 1, orbit.phase)
    assert image.is_same(orbit) and np.max(np.abs(image.state - orbit.state)) > 1e-3
    assert_allclose(
        image.record["maximum_displacement"], orbit.record["maximum_displacement"], rtol=1e-9
    )


def test_doubled_motion_is_the_one_that_simulation_finds(doubling, monkeypatch):
    event, family = doubling
    monkeypatch.setattr(switching, "DISTANCES", (4e-3,))
    other = other_branch(event)
    assert other.orbit.periods == 2 and not other.orbit.repeats_sooner()
    assert np.min(np.abs(other.orbit.multipliers - 1)) < 0.01
    value = event.point.value - 2e-3
    branch = follow_branch(family, other.orbit, other.value, (value, 1.8))
    assert set(branch.ends) == {"range_ends", "period_doubling"}
    end = next(point for point in branch.points if point.value == value)
    nudged = event.point.orbit.strobe_states[0] + np.array([1e-3, 0, 1e-3, 0])
    settling = Settling(tolerance=1e-10, patience=300, limit=3000)
    record = settle(family(value)[None], nudged[None], settling, from_strobe=True)[0]
    assert_allclose(
        end.orbit.record["maximum_displacement"], record["maximum_displacement"], rtol=1e-6
    )


def test_the_branch_at_which_another_ends_is_the_one_that_it_left(doubling, monkeypatch):
    event, family = doubling
    monkeypatch.setattr(switching, "DISTANCES", (4e-3,))
    other = other_branch(event)
    branch = follow_branch(family, other.orbit, other.value, (event.point.value - 2e-3, 1.8))
    edge = branch.ends.index("period_doubling")
    met = met_branch(branch.points[-edge], "period_doubling")
    assert met.orbit.periods == 1 and met.orbit.is_same(event.point.orbit, 1e-6)
    assert_allclose(met.value, event.point.value, rtol=0, atol=1e-8)
