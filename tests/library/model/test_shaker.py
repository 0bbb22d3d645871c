"""A machine on a shaker, whose base has one amplitude of acceleration at all frequencies."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

import impact_damper as idm

MASS, STIFFNESS, RATIO, ACCELERATION = 12.0, 2e5, 0.02, 3.0
MACHINE = idm.Machine(
    mass=MASS, linear_stiffness=STIFFNESS, damping_ratio=RATIO, base_acceleration=ACCELERATION
)
NATURAL = math.sqrt(STIFFNESS / MASS) / (2 * math.pi)
LOOSE, GAP, RESTITUTION, WALL = 0.6, 8e-3, 0.7, 2e6
DAMPER = MACHINE.damper(mass=LOOSE, gap=GAP, restitution=RESTITUTION, contact_stiffness=WALL)


def test_response_over_a_band_is_the_transmissibility_in_space():
    """Over a range of frequencies w the force has the relative error (2 zeta w/w0)^4/8."""
    hertz = np.linspace(12, 30, 7)
    found = idm.frequency_response(MACHINE, None, hertz, starts=2)
    r = hertz / NATURAL
    passed = np.hypot(1, 2 * RATIO * r) / np.hypot(1 - r**2, 2 * RATIO * r)
    expected = 1e3 * ACCELERATION / (2 * math.pi * hertz) ** 2 * passed
    off = found["maximum_displacement"].max("motion") / expected - 1
    assert np.all(np.abs(off) < (2 * RATIO * r) ** 4 / 8 + 1e-8)


def test_orbits_of_a_branch_are_those_of_three_bodies_in_space():
    """Base, machine and loose mass by SciPy: after a forcing cycle the motion repeats."""
    start = idm.steady_motion(MACHINE, DAMPER, 20, (0, 0, 0, 0.3)).state.values
    branch = idm.orbit_branches(MACHINE, DAMPER, 20, start, parameter="frequency", span=(18, 20.5))
    # The force contains the part V/W^2, so that the orbit far from the start is compared.
    point = branch.isel(point=int(np.argmin(branch.followed_value.values)))
    angular = 2 * math.pi * float(point.followed_value)
    c, amplitude = MACHINE.viscous_damping, ACCELERATION / angular**2
    logarithm, ratio = math.log(RESTITUTION), LOOSE / MASS
    share = -logarithm / math.sqrt((1 + ratio) * (math.pi**2 + logarithm**2))
    dashpot = 2 * share * math.sqrt(WALL * LOOSE)
    # the force of spring and dashpot leads the base
    lead = math.atan2(c * angular, STIFFNESS)

    def rate(t, y):
        base = amplitude * math.cos(angular * t - lead)
        speed = -amplitude * angular * math.sin(angular * t - lead)
        apart, closing = y[0] - y[2], y[1] - y[3]
        depth = max(apart - GAP / 2, 0) + min(apart + GAP / 2, 0)
        push = WALL * depth + (dashpot * closing if depth else 0)
        pull = -STIFFNESS * (y[0] - base) - c * (y[1] - speed) - push
        return [y[1], pull / MASS, y[3], push / LOOSE]

    x, v, z, w = point.orbit_state.values
    begin = float(point.orbit_phase) / angular
    run = solve_ivp(
        rate,
        (begin, begin + 2 * math.pi / angular),
        [x, v, x - z, v - w],
        method="DOP853",
        rtol=1e-10,
        atol=1e-13,
        max_step=2e-5,
    )
    size = [1e-3, 0.1, 1e-3, 0.1]
    assert int(point.orbit_contacts) == 2
    assert_allclose(run.y[:, -1] / size, run.y[:, 0] / size, atol=2e-5)
    assert_allclose(1e3 * np.abs(run.y[0]).max(), point.orbit_displacement, rtol=1e-5)


def test_rule_for_the_clearance_in_closed_form():
    """At resonance a base with the acceleration a exerts the force k a/w0^2 by the spring."""
    square = STIFFNESS / MASS
    force = STIFFNESS * ACCELERATION / square * (1 + 2 * RATIO**2)
    expected = force / (0.05 * MASS * square)
    damper = MACHINE.damper(mass=0.05 * MASS, gap=0.01, restitution=0.7, contact_stiffness=1e7)
    found = idm.clearance_sweep(MACHINE, damper, NATURAL, [1e-3, 2e-3], method="harmonic_balance")
    assert found.peak_rule_clearance == pytest.approx(1e3 * expected, rel=1e-6)
