"""Laws that hold whatever the integrator: momentum, energy, volume, symmetry, restitution."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER
from helpers.sampling import gauss, sample
from numpy.testing import assert_allclose

from impact_damper.model.packed import DAMPING, DASHPOT, FREQUENCY, STIFFNESS, pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions.simulate import random_states
from impact_damper.motions.strobe_map import period_map

WITH_LINEAR_SPRING = Oscillator(0.15, 1.2)


def period_of_contacts(known_orbit):
    """Return the log of all contacts in one period, which begins in mid-flight."""
    _, log = sample(
        known_orbit.parameters,
        known_orbit.state,
        known_orbit.strobe,
        [known_orbit.strobe + known_orbit.period],
    )
    assert len(log) > 0 and np.isfinite(log).all()
    return log


def test_momentum_through_every_contact(impacting_orbit):
    """The total momentum changes by the impulse of forcing, damping and springs alone."""
    p, start = impacting_orbit.parameters, impacting_orbit.strobe
    mass_ratio = impacting_orbit.damper.mass_ratio
    for _, begin, end, *_ in period_of_contacts(impacting_orbit):
        times, weights = gauss([begin, end], order=20)
        times = np.concatenate([[begin], times, [end]])
        states, _ = sample(p, impacting_orbit.state, start, times)
        x, v, _, w = states.T
        force = np.cos(p[FREQUENCY] * times) - p[DAMPING] * v - p[STIFFNESS] * x - x**3
        momentum = v + mass_ratio * (v - w)
        assert_allclose(momentum[-1] - momentum[0], weights @ force[1:-1], atol=2e-14)
        assert abs(momentum[-1] - momentum[0]) > 1e-5


def energy(p, mass_ratio, state):
    """Return the energy of oscillator and loose mass. In flight the walls store no energy."""
    x, v, _, w = state
    return v**2 / 2 + p[STIFFNESS] * x**2 / 2 + x**4 / 4 + mass_ratio * (v - w) ** 2 / 2


def test_energy_over_a_period(known_orbit):
    """The work of the forcing is the energy that damping and dashpot dissipate."""
    p, end = known_orbit.parameters, known_orbit.strobe + known_orbit.period
    _, log = sample(p, known_orbit.state, known_orbit.strobe, [end])
    times, weights = gauss(np.concatenate([[known_orbit.strobe], log[:, 1:3].ravel(), [end]]))
    states, _ = sample(p, known_orbit.state, known_orbit.strobe, np.append(times, end))
    v, w = states[:-1, 1], states[:-1, 3]
    touching = ((times[:, None] > log[:, 1]) & (times[:, None] < log[:, 2])).any(axis=1)
    work = weights @ (np.cos(p[FREQUENCY] * times) * v)
    damped = weights @ (p[DAMPING] * v**2)
    dashpot = weights @ np.where(touching, p[DASHPOT] * w**2, 0.0)
    mass_ratio = known_orbit.damper.mass_ratio if known_orbit.damper else 0.0
    stored = energy(p, mass_ratio, states[-1]) - energy(p, mass_ratio, known_orbit.state)
    assert work > 1e-3
    assert (dashpot > 0) == (p[DASHPOT] > 0)
    assert_allclose(stored, 0, atol=1e-9)
    assert_allclose(work, damped + dashpot + stored, rtol=1e-13, atol=5e-14)


@pytest.mark.parametrize("oscillator", [PAPER, WITH_LINEAR_SPRING])
@pytest.mark.parametrize("damper", [DESIGN, INELASTIC, Damper(0.4, 0.625, 0.6)])
def test_liouville(oscillator, damper):
    """The determinant of the flow is exp(-h t - 2 zc sqrt(r1 rm) (1 + 1/rm) x time in contact)."""
    p = pack(oscillator, damper, 1.8)
    strobe, period = 0.5 * math.pi / 1.8, 2 * math.pi / 1.8
    rate = damper.dashpot * (1 + 1 / damper.mass_ratio)
    errors = []
    for state in random_states(60, 2.0, damper, 7):
        _, matrix, contacts = period_map(p, state, 1, 1e-14)
        (last,), log = sample(p, state, strobe, [strobe + period])
        condition = np.linalg.cond(matrix)
        if contacts == 0 or abs(last[2]) > damper.clearance or condition > 1e6:
            continue
        touching = np.sum(log[:, 2] - log[:, 1])
        expected = math.exp(-oscillator.damping * period - rate * touching)
        errors.append((np.linalg.det(matrix) / expected - 1) / condition)
    assert len(errors) > 20
    assert_allclose(errors, 0, atol=5e-14)


def isolated_contact(mass_ratio, restitution, stiffness):
    """Return restitution, velocity after the contact of an oscillator at rest, time in contact."""
    p = pack(PAPER, Damper(mass_ratio, 1.0, restitution, stiffness), 2.0)
    strobe = math.pi / 4
    state = [0.0, 0.0, 1.0, 1.0]
    _, log = sample(p, state, strobe, [strobe + 0.5])
    _, begin, end, approach, departure = log[0]
    states, _ = sample(p, state, strobe, [end])
    return -departure / approach, states[0, 1], end - begin


@pytest.mark.parametrize("mass_ratio", [0.01, 0.12, 1.0, 10.0])
@pytest.mark.parametrize("restitution", [0.3, 0.6, 0.75, 0.9, 1.0])
def test_restitution_of_an_isolated_contact(mass_ratio, restitution):
    """With the dashpot by (25) the restitution is e in the limit of an infinite stiffness r1."""
    stiffness = np.array([1e5, 1e7, 1e9])
    seen = [isolated_contact(mass_ratio, restitution, r1) for r1 in stiffness]
    found, velocity, duration = np.array(seen).T
    impulse = -(1 + restitution) * mass_ratio / (1 + mass_ratio)
    limit = np.array([restitution, impulse])
    errors = np.abs(np.array([found, velocity]) - limit[:, None])
    # Forcing and springs act during a contact too. This causes an error of order r1^(-1/2).
    assert np.all(errors[:, -1] < 3 * duration[-1])
    assert np.all(errors[:, 2] < 0.11 * errors[:, 1] + 1e-12)
    assert np.all(errors[:, 1] < 0.25 * errors[:, 0] + 1e-12)
    ratio = -math.log(restitution) / math.hypot(math.pi, math.log(restitution))
    natural = np.sqrt(stiffness * (1 + 1 / mass_ratio) * (1 - ratio**2))
    assert_allclose(duration * natural, math.pi, rtol=1e-2)
