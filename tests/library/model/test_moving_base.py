"""Machines on a moving base: displacement relative to the base, with any spring."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

import impact_damper as idm
from impact_damper.theory.design_rule import rule_clearance

MASS, STIFFNESS, CUBIC, RATIO = 12.0, 2e5, 4e9, 0.02
SPRING = {"mass": MASS, "linear_stiffness": STIFFNESS, "damping_ratio": RATIO}
LOOSE, GAP, RESTITUTION, WALL = 0.6, 8e-3, 0.7, 2e6
DAMPER = {"mass": LOOSE, "gap": GAP, "restitution": RESTITUTION, "contact_stiffness": WALL}
NATURAL = math.sqrt(STIFFNESS / MASS) / (2 * math.pi)


def test_response_over_a_band_is_the_transmissibility_relative_to_the_base():
    hertz = np.linspace(12, 30, 7)
    found = idm.frequency_response(
        idm.Machine(**SPRING, base_acceleration=3), None, hertz, starts=2
    )
    r = hertz / NATURAL
    expected = 1e3 * 3 * MASS / STIFFNESS / np.hypot(1 - r**2, 2 * RATIO * r)
    assert_allclose(found["maximum_displacement"].max("motion"), expected, rtol=1e-7)


@pytest.mark.parametrize("name", ["base_displacement", "base_acceleration"])
def test_motions_are_those_of_two_bodies_in_space(name):
    """SciPy integrates machine and loose mass in the coordinates of a frame at rest."""
    angular = 2 * math.pi * 24
    amplitude = 0.4e-3
    machine = idm.Machine(
        **SPRING,
        cubic_stiffness=CUBIC,
        **{name: amplitude * (angular**2 if name == "base_acceleration" else 1)},
    )
    damper = machine.damper(**DAMPER, exit_rule="zero_penetration")
    state = (1e-3, 0.2, 3.9e-3, 0.4)
    found = idm.simulate(machine, damper, 24, state, start=0.0, periods=3, samples=60)
    c, logarithm = machine.viscous_damping, math.log(RESTITUTION)
    share = -logarithm / math.hypot(math.pi, logarithm)
    dashpot = 2 * share * math.sqrt(WALL / (1 / MASS + 1 / LOOSE))

    def rate(t, y):
        """Return the derivative of positions and velocities of machine and loose mass."""
        stretch = y[0] - amplitude * math.cos(angular * t)
        speed = y[1] + amplitude * angular * math.sin(angular * t)
        apart, closing = y[0] - y[2], y[1] - y[3]
        depth = max(apart - GAP / 2, 0) + min(apart + GAP / 2, 0)
        push = WALL * depth + (dashpot * closing if depth else 0)
        pull = -STIFFNESS * stretch - CUBIC * stretch**3 - c * speed - push
        return [y[1], pull / MASS, y[3], push / LOOSE]

    x, v, z, w = state
    times = found.time.values
    run = solve_ivp(
        rate,
        (0, times[-1]),
        [x + amplitude, v, x + amplitude - z, v - w],
        t_eval=times,
        method="DOP853",
        rtol=1e-10,
        atol=1e-13,
        max_step=2e-5,
    )
    assert found.sizes["contact"] > 2
    in_space = 1e-3 * found.displacement + amplitude * np.cos(angular * times)
    assert_allclose(run.y[0], in_space, atol=1e-7)
    assert_allclose(run.y[0] - run.y[2], 1e-3 * found.relative_displacement, atol=1e-6)


def test_rule_for_the_clearance_in_closed_form():
    """At resonance the force of inertia is m a, and rule (19) gives d0 = a m1/(m2 w0^2)."""
    machine = idm.Machine(**SPRING, base_acceleration=3)
    expected = 3 / (0.05 * STIFFNESS / MASS)
    clearance = rule_clearance(machine.oscillator(), 0.05)
    assert machine.scales.to_si(clearance, "clearance") == pytest.approx(expected, rel=1e-12)
