"""The quiet orbit over a grid: its ends, multipliers and bifurcations."""

from dataclasses import replace

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER

from chatterjee1995.methods.quiet_orbits import (
    PHASE,
    find_quiet_orbit,
    follow_quiet_orbits,
    straight_flight_end,
)
from impact_damper.data.datasets import flag
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble
from impact_damper.motions.records import is_symmetric_pair
from impact_damper.motions.strobe_map import STROBE
from impact_damper.orbits.shooting import shoot

LEFT, RIGHT = 0, 1
SETTLING = Settling(patience=300, limit=3000)


def row(damper, frequencies, oscillator=PAPER):
    return np.array([[pack(oscillator, damper, w) for w in frequencies]])


def seeded(parameters, state, column=-1):
    states = np.full((*parameters.shape[:2], 4), np.nan)
    states[0, column] = state
    return follow_quiet_orbits(parameters, states)


def at_phase(p, state):
    """Return the state at `PHASE` of the orbit through a state at the strobe."""
    return shoot(p, state, 1, STROBE).at(PHASE)


def orbit_at(damper, frequency, design_orbit):
    """Return the quiet orbit, followed from W = 2 over the damper and then over the frequency."""
    y, p = at_phase(design_orbit.parameters, design_orbit.state), design_orbit.parameters
    for q in (pack(PAPER, damper, 2.0), pack(PAPER, damper, frequency)):
        for share in np.linspace(0, 1, 201)[1:]:
            orbit, status = find_quiet_orbit((1 - share) * p + share * q, y)
            assert status == "found"
            y = orbit.state
        p = q
    return orbit


def settled(orbit, push):
    """Return the record of the motion that starts near an orbit."""
    state = orbit.strobe_states[0] + push
    return ensemble.settle(orbit.p[None], state[None], SETTLING, from_strobe=True)[0]


def test_the_fold_by_simulation_on_both_sides(design_orbit):
    frequencies = np.arange(1.0, 2.01, 0.04)
    found = seeded(row(DESIGN, frequencies), design_orbit.state)
    fold = np.interp(found.end[0, LEFT], np.arange(len(frequencies)), frequencies)
    assert list(found.end_event[0]) == ["fold", "map_ends"]
    orbit = orbit_at(DESIGN, fold + 5e-3, design_orbit)
    record = settled(orbit, 0.0)
    assert is_symmetric_pair(record) and record["outcome"] == flag("outcome", "settled")
    beyond = pack(PAPER, DESIGN, fold - 5e-3)
    state = orbit.strobe_states[0]
    left = ensemble.settle(beyond[None], state[None], SETTLING, from_strobe=True)[0]
    assert not is_symmetric_pair(left)


@pytest.mark.parametrize("restitution", [0.5, 0.6])
def test_with_inelastic_contact_it_ends_where_straight_flight_predicts(restitution):
    """The closed form holds for rigid walls and high frequency; d0 = 0.5 is close to this limit."""
    oscillator = Oscillator(0.02)
    damper = replace(DESIGN, clearance=0.5, restitution=restitution, contact_stiffness=2e6)
    expected = straight_flight_end(oscillator, 0.5, restitution)
    frequencies = np.linspace(0.8, 1.1, 31) * expected
    grid = row(damper, frequencies, oscillator)
    start = ensemble.settle(
        np.repeat(grid[0, :1], 8, axis=0),
        np.random.default_rng(3).uniform(-0.4, 0.4, (8, 4)),
        Settling(patience=300, limit=3000),
    )
    quiet = start[is_symmetric_pair(start)]
    assert len(quiet)
    found = seeded(grid, quiet["state"][0], column=0)
    end = np.interp(found.end[0, RIGHT], np.arange(31), frequencies)
    assert found.end_event[0, RIGHT] == "fold"
    assert end == pytest.approx(expected, rel=0.005)
