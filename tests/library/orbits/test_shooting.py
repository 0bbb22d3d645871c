"""Periodic orbits: residual, Liouville's theorem, and multipliers by 80-bit arithmetic."""

import numpy as np
import pytest
from helpers.known_orbits import PAPER, STARTS, polished_orbit
from numpy.testing import assert_allclose
from references import extended

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.orbits.orbit import TURN
from impact_damper.orbits.shooting import find_orbit


@pytest.fixture(scope="module", params=list(STARTS))
def orbit(request):
    known_orbit = polished_orbit(request.param)
    return find_orbit(known_orbit.parameters, known_orbit.state)


def test_multipliers_by_80_bit_arithmetic(orbit):
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    begin, length = orbit.phase / orbit.p[0], orbit.periods * TURN / orbit.p[0]
    run = extended.run(orbit.p, orbit.state, begin, [begin + length])
    assert_allclose(run.states[-1].astype(float), orbit.state, atol=1e-11)
    expected = np.linalg.eigvals(run.flow[: orbit.active, : orbit.active].astype(float))
    found = orbit.multipliers[: orbit.active]
    order = np.lexsort((-expected.imag.round(9), -np.abs(expected).round(9)))
    again = np.lexsort((-found.imag.round(9), -np.abs(found).round(9)))
    assert_allclose(found[again], expected[order], atol=1e-9)


# Damping of a hardening oscillator, damper, W, and a state at W T = pi/2 near a stable orbit, whose
# rounding errors leave a residual above 1e-12 of the state.
STIFF = [
    (0.005, Damper(0.0138, 8.0, 0.683, 3.2e5), 0.836, (0.15442, -2.4314, -3.1677, 3.2239)),
    (0.0289, Damper(0.0229, 8.73, 0.962, 6.54e5), 0.801, (0.19783, -2.2068, -0.68975, 3.6161)),
]


@pytest.mark.parametrize(("damping", "damper", "frequency", "state"), STIFF)
def test_an_orbit_between_stiff_walls_is_accepted(damping, damper, frequency, state):
    """In 80-bit arithmetic the motion from its state repeats."""
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    orbit = find_orbit(pack(Oscillator(damping, 1.0, 0.01), damper, frequency), state)
    assert orbit.converged
    begin = extended.Real(orbit.phase) / extended.Real(frequency)
    period = 2 * np.arccos(extended.Real(-1)) / extended.Real(frequency)
    end = extended.run(orbit.p, orbit.state, begin, [begin + period]).states[-1]
    assert_allclose(end.astype(float), orbit.state, rtol=0, atol=1e-10)


def test_without_an_orbit_the_result_has_not_converged():
    """Far from all orbits Newton's method does not converge, or finds an orbit of period 1."""
    orbit = find_orbit(pack(PAPER, Damper(0.12, 2.0), 2.0), np.array([1.0, 1.0, 0.0, 4.0]), 2)
    assert not orbit.converged or orbit.repeats_sooner()


def test_phase_leaves_a_contact():
    """From a state in contact the orbit is found with its state at a later phase, in flight."""
    known_orbit = polished_orbit("design")
    reference = find_orbit(known_orbit.parameters, known_orbit.state)
    inside = reference.p[0] * (reference.contacts[1, 1] + 0.01)
    found = find_orbit(reference.p, reference.at(inside), 1, inside % TURN)
    assert found.converged and found.margin(found.phase) > 0.1
    assert found.is_same(reference)
