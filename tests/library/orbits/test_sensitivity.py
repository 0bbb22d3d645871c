"""Derivatives of orbits compared with differences of orbits, and with Liouville's theorem.

Z1 is the displacement of the primary mass. Multipliers are Floquet multipliers.
"""

from dataclasses import replace

import numpy as np
import pytest
from helpers.known_orbits import polished_orbit
from helpers.symmetric import CENTRAL, converged, linear_orbit
from numpy.testing import assert_allclose
from references import equation

from impact_damper.model.packed import (
    CLEARANCE,
    COUNT,
    DAMPING,
    DASHPOT,
    FREQUENCY,
    INVERSE_MASS_RATIO,
    STIFFNESS,
    pack,
)
from impact_damper.model.packed import DESIGN as DESIGN_PARAMETERS
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.orbits.orbit import TURN
from impact_damper.orbits.paths import follow_path
from impact_damper.orbits.sensitivity import (
    Variations,
    _displacement,
    path_of,
    sensitivity,
)
from impact_damper.orbits.shooting import find_orbit, shoot

LINEAR = Oscillator(0.02, 1.0, cubic=0.0, unbalance=0.3)
STIFF = Damper(0.05, 3.0, restitution=0.6, contact_stiffness=500.0)
# Cubic coefficients with which the spring's force at max |Z1| changes by some per cent.
SPRINGS = {"hardening": 1e-4, "softening": -1e-4, "linear": 0.0}


def named_orbit(name):
    if name in ("design", "inelastic", "large", "resonance"):
        known = polished_orbit(name)
        found = find_orbit(known.parameters, known.state)
        return converged(
            known.parameters, found.state, found.phase, name in ("design", "inelastic")
        )
    if name == "on a shaker":
        return linear_orbit(replace(LINEAR, unbalance=0.1, shaker=0.2), STIFF, 1.0, 0.75)
    return linear_orbit(replace(LINEAR, cubic=SPRINGS[name]), STIFF, 1.0, 0.75)


@pytest.fixture(
    scope="module",
    params=["design", "inelastic", "large", "resonance", *SPRINGS, "on a shaker"],
    ids=str,
)
def orbit(request):
    return named_orbit(request.param)


def differences(orbit, direction):
    """Return central differences of order 8 of four properties of an orbit.

    They are the state, the derivative matrix, max |Z1| and the largest modulus of a multiplier. The
    parameters change by multiples of `direction`.
    """
    symmetric, n = orbit.root is not None, orbit.active
    total = 0.0
    for k, weight in CENTRAL.items():
        for sign in (-1, 1):
            p = orbit.p + sign * k * direction
            near = converged(p, orbit.state, orbit.phase, symmetric)
            matrix = (near.root if symmetric else near.monodromy)[:n, :n]
            size, modulus = near.record["maximum_displacement"], abs(near.multipliers[0])
            numbers = np.concatenate([near.state, matrix.ravel(), [size, modulus]])
            total = total + sign * weight * numbers
    return total[:4], total[4:-2], total[-2], total[-1]


def steps(orbit):
    """Return pairs of the index of a parameter that has an effect, and its step in differences."""
    sizes = np.maximum(np.abs(orbit.p), 0.1)
    farthest = orbit.record["maximum_displacement"]
    for index in range(COUNT):
        force = equation.spring(np.eye(COUNT)[index], farthest)
        if index != STIFFNESS and force != 0:
            sizes[index] = min(farthest / force, 10.0)
    count = COUNT if orbit.touching > 0 else CLEARANCE
    return list(enumerate(4e-4 * sizes[:count]))


def assert_near(found, expected, step, size=1.0):
    """Assert equality to 1e-7 of the largest component, and to the rounding of differences."""
    atol = 1e-7 * np.max(np.abs(expected)) + 2e-12 * max(1.0, size) / step
    assert_allclose(found, expected, rtol=0, atol=atol)


def test_derivatives_by_packed_parameters(orbit):
    found = sensitivity(orbit)
    assert found.displacement_smooth and found.modulus_smooth
    for k, step in steps(orbit):
        state, matrix, size, modulus = differences(orbit, step * np.eye(COUNT)[k])
        assert_near(found.state_slopes[:, k], state / step, step, np.abs(orbit.state).max())
        assert_near(found.matrix_slopes[k].ravel(), matrix / step, step)
        assert_near(found.displacement_slopes[k], size / step, step, found.maximum_displacement)
        assert_near(found.modulus_slopes[k], modulus / step, step)
    assert_allclose(found.modulus, abs(orbit.multipliers[0]), rtol=1e-10)
    assert_allclose(found.maximum_displacement, orbit.record["maximum_displacement"], rtol=1e-12)


def test_determinant_by_liouville(orbit):
    """The determinant's logarithm changes with damping, period, and time in contact."""
    found, p = sensitivity(orbit), orbit.p
    n = orbit.active
    share = 1 if orbit.root is None else 0.5
    matrix = (orbit.monodromy if orbit.root is None else orbit.root)[:n, :n]
    logarithm = np.trace(np.linalg.solve(matrix, found.matrix_slopes), axis1=1, axis2=2)
    period = share * TURN / p[FREQUENCY]
    expected = np.zeros(COUNT)
    expected[DAMPING], expected[FREQUENCY] = -period, p[DAMPING] * period / p[FREQUENCY]
    if n == 4:
        mobility, time = 1 + p[INVERSE_MASS_RATIO], share * orbit.touching
        expected[DASHPOT] -= mobility * time
        expected[INVERSE_MASS_RATIO] -= p[DASHPOT] * time
        expected -= p[DASHPOT] * mobility * contact_time_slopes(orbit, found) * share
        assert_allclose(logarithm, expected, rtol=1e-9, atol=1e-9)
    else:
        assert_allclose(logarithm[:CLEARANCE], expected[:CLEARANCE], rtol=1e-9, atol=1e-9)


def contact_time_slopes(orbit, found):
    """Return the derivative of the time in contact, from the delay of each of its ends."""
    begin = orbit.phase / orbit.p[FREQUENCY]
    slopes = np.zeros(COUNT)
    for wall, start, end, *_ in orbit.contacts:
        for time, sign in ((start, -1), (end, 1)):
            # The change of the state at the phase of the event gives the delay of the event.
            path = follow_path(orbit.p, orbit.state, begin, time)
            change = Variations(path).changes(found.state_slopes, np.eye(COUNT))[2, :, -1]
            moved = wall * np.eye(COUNT)[CLEARANCE]
            slopes += sign * (moved - change) / path.states[3, -1]
            slopes[FREQUENCY] -= sign * time / orbit.p[FREQUENCY]
    return slopes


def test_derivatives_by_design_parameters():
    """They agree with differences of orbits in which one number of machine or damper is changed."""
    orbit = named_orbit("softening")
    found = sensitivity(orbit)
    damper = replace(STIFF, clearance=orbit.p[CLEARANCE])
    given = {"frequency": 1.0, "linear_stiffness": 1.0}
    parts = {"oscillator": replace(LINEAR, cubic=SPRINGS["softening"]), "damper": damper}

    def packed(name, value):
        if name == "frequency":
            return pack(parts["oscillator"], damper, value)
        if name == "linear_stiffness":
            return pack(replace(parts["oscillator"], linear_frequency=value**0.5), damper, 1.0)
        owner = "oscillator" if hasattr(parts["oscillator"], name) else "damper"
        return pack(**(parts | {owner: replace(parts[owner], **{name: value})}), frequency=1.0)

    for part in parts.values():
        given |= {name: getattr(part, name) for name in vars(part)}
    sizes = found.by_design(found.displacement_slopes)
    moduli = found.by_design(found.modulus_slopes)
    states = found.by_design(found.state_slopes)
    assert set(sizes) == set(DESIGN_PARAMETERS) <= set(given)
    for name in DESIGN_PARAMETERS:
        step = 2e-4 * (abs(given[name]) if name != "cubic" else 0.02)
        totals = 0.0
        for k, weight in CENTRAL.items():
            for sign in (-1, 1):
                p = packed(name, given[name] + sign * k * step)
                near = converged(p, orbit.state, orbit.phase, True)
                numbers = near.record["maximum_displacement"], abs(near.multipliers[0])
                totals = totals + sign * weight * np.append(near.state, numbers) / step
        assert_near(states[name], totals[:4], step, 20)
        assert_near(sizes[name], totals[4], step, 10)
        assert_near(moduli[name], totals[5], step)


def test_a_kink_of_the_displacement_is_not_smooth():
    """An unsymmetric change increases one of the two maxima of |Z1| and decreases the other."""
    half = named_orbit("design")
    path = path_of(shoot(half.p, half.state, 1, half.phase))
    pushed = Variations(path).changes(np.eye(4), np.zeros((COUNT, 4)))
    assert not _displacement(path, pushed[0])[-1]


def test_an_orbit_that_has_not_converged_is_refused():
    orbit = named_orbit("design")
    with pytest.raises(ValueError, match="must have converged"):
        sensitivity(shoot(orbit.p, orbit.state + 0.01, 1, orbit.phase))
