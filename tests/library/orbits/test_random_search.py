"""Stable orbits from random states: simulation stays on them."""

import numpy as np
from helpers.known_orbits import INELASTIC, PAPER
from numpy.testing import assert_allclose

from impact_damper.model.packed import pack
from impact_damper.model.settling import Settling
from impact_damper.motions.ensemble import settle
from impact_damper.orbits.random_search import stable_orbits


def test_simulation_settles_to_every_orbit_found():
    def family(value):
        return pack(PAPER, INELASTIC, value)

    found = list(stable_orbits(family, INELASTIC, (1.2, 2.2)))
    assert {orbit.periods for _, orbit in found} >= {1, 3}
    rows = np.array([orbit.p for _, orbit in found])
    states = np.array([orbit.strobe_states[0] for _, orbit in found]) + 1e-6
    records = settle(rows, states, Settling(), from_strobe=True)
    sizes = [orbit.record["maximum_displacement"] for _, orbit in found]
    assert_allclose(records["maximum_displacement"], sizes, rtol=1e-4)
    assert [orbit.periods for _, orbit in found] == records["period"].tolist()
