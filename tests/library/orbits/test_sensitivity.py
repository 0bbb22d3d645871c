"""Derivatives of orbits by parameters, compared with a closed form and with a law of similarity."""

import numpy as np
import pytest
from helpers.known_orbits import polished_orbit
from numpy.testing import assert_allclose

from impact_damper.model.packed import CLEARANCE, CUBIC, DAMPING, FORCE, pack
from impact_damper.model.parameters import Oscillator
from impact_damper.orbits.sensitivity import relative_slopes
from impact_damper.orbits.shooting import find_orbit


def along(orbit, **powers):
    """Return the direction in which parameters change in proportion to themselves."""
    places = {"clearance": CLEARANCE, "cubic": CUBIC, "force": FORCE, "damping": DAMPING}
    direction = np.zeros(len(orbit.p))
    for name, power in powers.items():
        direction[places[name]] = power * orbit.p[places[name]]
    return direction


@pytest.mark.parametrize("name", ["design", "inelastic", "large"])
def test_lengths_are_similar(name):
    """With lengths in another unit the displacements scale, and the multipliers stay."""
    known = polished_orbit(name)
    orbit = find_orbit(known.parameters, known.state)
    parts = [relative_slopes(orbit, along(orbit, **{key: power})) for key, power in SCALED.items()]
    assert np.all(np.isfinite(parts))
    assert_allclose(np.sum(parts, axis=0), (1, 0), atol=1e-5)


SCALED = {"clearance": 1, "cubic": -2, "force": 1}


def test_a_linear_oscillator_has_a_closed_form():
    h, w0, w = 0.2, 1.1, 1.7
    orbit = find_orbit(pack(Oscillator(h, w0, 0.0, 0.5), None, w), np.zeros(4))
    size = (w0**2 - w**2) ** 2 + (h * w) ** 2
    expected = -((h * w) ** 2) / size, -h * np.pi / w
    assert_allclose(relative_slopes(orbit, along(orbit, damping=1)), expected, rtol=1e-6)
