"""Single motions with labels, random starts, and ensembles on several threads."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from numpy.testing import assert_allclose
from scipy import stats
from scipy.integrate import cumulative_simpson, quad
from scipy.linalg import expm
from scipy.optimize import minimize_scalar

import impact_damper as idm
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions import panels
from impact_damper.motions.simulate import COMPONENTS, random_states, simulate
from impact_damper.motions.steady import steady_orbit


def test_samples_and_contacts_of_a_simulation():
    data = simulate(PAPER, DESIGN, 2.0, (0, 0, 0, 1), periods=6.5, samples=100)
    assert data.sizes["time"] == 651
    assert_allclose(data.time[[0, -1]], [0, 6.5 * math.pi], rtol=1e-15)
    assert_allclose(np.diff(data.time), math.pi / 100, rtol=1e-10)
    assert_allclose([data[name][0] for name in list(data)[:4]], [0, 0, 0, 1])
    # |Z2| exceeds the clearance exactly during contacts
    beyond = np.sign(data.relative_displacement) * (abs(data.relative_displacement) > 2)
    t = data.time.values[:, None]
    within = (t > data.contact_begin.values) & (t < data.contact_end.values)
    assert np.array_equal(beyond, within @ data.contact_wall.values)
    assert np.all(data.approach_velocity * data.contact_wall > 0)
    assert np.all(data.departure_velocity * data.contact_wall < 0)
    # the velocity is the derivative of the displacement
    difference = np.gradient(data.displacement, data.time.values, edge_order=2)
    assert_allclose(difference, data.velocity, atol=0.1)


@pytest.mark.parametrize("damper", [None, DESIGN, Damper(0.4, 0.625)])
@pytest.mark.parametrize("within_gap", [True, False])
def test_random_states_are_uniform(damper, within_gap):
    """States are uniform in a ball. With `within_gap` the walls cut off parts of the ball."""
    states = random_states(4000, 2.0, damper, 5, within_gap=within_gap)
    assert states.shape == (4000, 4)
    if damper is None:
        assert np.array_equal(states[:, :2], states[:, 2:])
        states = states[:, :2]
    size = states.shape[1]
    radius = np.linalg.norm(states, axis=1)
    assert np.max(radius) <= 2.0
    if damper is not None and within_gap:
        assert np.max(np.abs(states[:, 2])) < damper.clearance
    if damper is None or not within_gap or damper.clearance >= 2:
        assert stats.kstest((radius / 2) ** size, "uniform").pvalue > 0.01
        for values in states.T:
            # a coordinate u of a uniform ball: (1 + u/2)/2 is a symmetric beta variable
            shape = (size + 1) / 2
            assert stats.kstest((1 + values / 2) / 2, stats.beta(shape, shape).cdf).pvalue > 0.001
    else:
        # for any given Z2 the other components are uniform in the remaining ball
        left = 1 - (states[:, 2] / 2) ** 2
        others = np.linalg.norm(states[:, [0, 1, 3]], axis=1) / (2 * np.sqrt(left))
        assert stats.kstest(others**3, "uniform").pvalue > 0.01


def test_steady_orbit_closes():
    orbit = steady_orbit(PAPER, DESIGN, 2.0, (1.0, 0.5, 0.0, 0.0))
    ends = [orbit[name].values[[0, -1]] for name in COMPONENTS]
    assert_allclose(*np.transpose(ends), atol=1e-8)
    assert_allclose(np.ptp(orbit.time.values), np.pi)
    assert orbit.sizes["contact"] == 2


@pytest.mark.parametrize("rule", ["zero_penetration", "no_tension"])
@pytest.mark.parametrize("restitution", [1.0, 0.5])
def test_the_force_of_an_impact_is_in_closed_form(restitution, rule):
    """Without forcing a contact of a linear oscillator follows from a matrix exponential."""
    oscillator = Oscillator(0.1, 1.0, 0.0, 0.0)
    damper = Damper(0.2, 0.5, restitution=restitution, contact_stiffness=300.0, exit_rule=rule)
    start = np.array([0.1, -0.4, -0.5, -1.3])
    motion = idm.simulate(oscillator, damper, 1.0, start, periods=0.2, samples=50)
    end = float(motion.contact_end[0])
    push = np.array([0, 0, damper.contact_stiffness, damper.dashpot])  # on Z2 + d0 and Z2'
    spring = np.array([-1.0, -0.1, 0, 0])
    matrix = np.array([[0, 1, 0, 0], spring - push, [0, 0, 0, 1], spring - push * (1 + 1 / 0.2)])

    def state(t):
        return expm(matrix * t) @ (start + [0, 0, 0.5, 0])

    def force(t):
        return abs(push @ state(t))

    fine = np.linspace(0, end, 200)
    guess = np.argmax([force(t) for t in fine])
    around = fine[max(guess - 1, 0)], fine[min(guess + 1, 199)]
    options = {"xatol": 1e-12}
    best = minimize_scalar(lambda t: -force(t), bounds=around, method="bounded", options=options)
    most = max(-best.fun, force(0.0))
    assert_allclose(motion.contact_force[0], most, rtol=1e-9)
    assert motion.largest_contact_force == motion.contact_force.max()
    # the impulse is the momentum that the loose mass loses
    impulse = quad(lambda t: push @ state(t), 0, end, epsabs=1e-13)[0]
    loose = [(-0.4 + 1.3), state(end)[1] - float(motion.departure_velocity[0])]
    assert_allclose(-impulse, 0.2 * (loose[0] - loose[1]), rtol=1e-8)


def test_forces_of_long_motions_do_not_depend_on_pieces(monkeypatch):
    """In a chaotic motion, other steps of the integrator would lead to other contacts."""
    chaos = {"state": (1.0, 0.5, -0.3, 2.0), "periods": 150, "samples": 10}
    whole = idm.simulate(PAPER, DESIGN, 1.6, **chaos)
    monkeypatch.setattr(panels, "PIECE", 7)
    pieces = idm.simulate(PAPER, DESIGN, 1.6, **chaos)
    assert whole.sizes["contact"] > 100 and whole.contact_force.min() > 0
    assert_allclose(pieces.contact_force, whole.contact_force, rtol=1e-9)


def test_contacts_of_a_machine_in_newton_and_none_without_a_damper():
    """For stiff elastic walls the force is v (k m)^(1/2) with the reduced mass m."""
    machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
    damper = machine.damper(mass=0.6, gap=0.008, restitution=1.0, contact_stiffness=1e11)
    motion = idm.simulate(machine, damper, 20.5, (0, 0, 0, 0.3), periods=5)
    rate = np.sqrt(1e11 * 12 * 0.6 / 12.6)
    assert motion.contact_force.attrs["units"] == "N" and motion.sizes["contact"] > 3
    assert_allclose(motion.contact_force, rate * np.abs(motion.approach_velocity), rtol=1e-3)
    bare = idm.simulate(machine, None, 20.5, periods=5)
    assert bare.largest_contact_force == 0 and "absolute_displacement" not in bare


@pytest.mark.parametrize("base", [{"base_displacement": 1e-4}, {"base_acceleration": 3.0}])
def test_a_machine_on_a_moving_base_in_absolute_coordinates(base):
    """The closed form without contacts; with contacts, the twice integrated acceleration."""
    machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.05, **base)
    angular = 2 * np.pi * 20.0
    height = base.get("base_displacement", 3.0 / angular**2)
    steady = idm.steady_motion(machine, None, 20.0)
    bare = idm.simulate(machine, None, 20.0, steady.state, periods=1)
    link = 2e5 + 1j * angular * machine.viscous_damping
    moved = height * link / (2e5 - 12 * angular**2 + 1j * angular * machine.viscous_damping)
    turn = np.exp(1j * angular * bare.time.values)
    assert_allclose(bare.absolute_displacement, 1e3 * (moved * turn).real, atol=1e-8)
    assert_allclose(bare.absolute_acceleration, -(angular**2 * moved * turn).real, atol=1e-6)
    assert bare.absolute_acceleration.attrs["units"] == "m/s^2"
    damper = machine.damper(mass=0.6, gap=0.002, restitution=1.0, contact_stiffness=2e6)
    motion = idm.simulate(machine, damper, 20.0, (0, 0, 0, 0.3), periods=3, samples=20_000)
    assert motion.sizes["contact"] > 3
    speed = cumulative_simpson(motion.absolute_acceleration, x=motion.time.values, initial=0)
    course = cumulative_simpson(speed, x=motion.time.values, initial=0)
    found = motion.absolute_displacement.values - motion.absolute_displacement.values[0]
    # at the start the base is at its highest point, without velocity
    assert_allclose(1e3 * course, found, atol=5e-5)
