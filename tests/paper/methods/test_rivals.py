"""Other integrators: order of convergence without contacts, and largest stable step in contact."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER
from helpers.sampling import sample
from numpy.testing import assert_allclose

from chatterjee1995.methods import fixed_step, merson
from chatterjee1995.methods.methods import integrators
from chatterjee1995.methods.scipy_methods import SciPy
from impact_damper.model.packed import CLEARANCE, pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions import strobe_map

ORDERS = {"heun": 2, "verlet": 2, "runge_kutta_4": 4, "merson": 4}
START = np.array([0.7, -0.3, 0.5, 0.2])


def fixed(method, p, y, steps, periods, t=0.0):
    strobes, largest = np.empty((periods, 4)), np.empty(periods)
    run = fixed_step.run_fixed(
        fixed_step.NAMES.index(method), p, np.array(y, float), t, steps, strobes, largest
    )
    return strobes, largest, run


@pytest.fixture(scope="module")
def free():
    """Parameters without a damper, and the state after two cycles by the Taylor series."""
    p = pack(PAPER, None, 2.0)
    states, _ = sample(p, START, 0.0, [2 * 2 * math.pi / 2.0])
    return p, states[-1]


@pytest.mark.parametrize("method", fixed_step.NAMES)
def test_order_of_fixed_steps(method, free):
    p, end = free
    errors = [
        np.abs(fixed(method, p, START, steps, 2)[0][-1] - end).max() for steps in (200, 400, 800)
    ]
    assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), ORDERS[method], atol=0.15)


@pytest.mark.parametrize("locate", [False, True])
def test_merson_follows_its_tolerance(locate, free):
    """The error is of order h^4, with the step h, and the estimate of the error of order h^5.

    The error is therefore proportional to tolerance^(4/5).
    """
    p, end = free
    errors = []
    for tolerance in (1e-6, 1e-8, 1e-10, 1e-12):
        strobes = merson.Merson().strobes(p, START, 0.0, 2, tolerance, locate)
        errors.append(np.abs(strobes[-1] - end).max())
    slope = np.polyfit([-6, -8, -10, -12], np.log10(errors), 1)[0]
    assert 0.7 < slope < 1.1


@pytest.mark.parametrize("method", ["RK45", "DOP853", "LSODA", "Radau"])
def test_scipy_on_smooth_motion(method, free):
    p, end = free
    for locate in (False, True):
        states = SciPy(method).strobes(p, START, 0.0, 2, 1e-9, locate, 10**6)
        assert_allclose(states[-1], end, atol=1e-5)


@pytest.mark.parametrize("method", fixed_step.NAMES)
def test_linear_stability_limit_of_the_contact(method):
    """With almost no clearance the two masses on the contact spring are a linear oscillator.

    The springs of the primary mass are negligible compared with the contact spring.
    """
    stiffness, mass_ratio = 1e6, 0.25
    p = pack(Oscillator(1e-9), Damper(mass_ratio, 1.0, contact_stiffness=stiffness), 2.0)
    p[CLEARANCE] = 1e-12
    contact = math.sqrt(stiffness * (1 + 1 / mass_ratio))
    limit = fixed_step.STABILITY_LIMIT[method]

    def growth(scaled):
        """Return the largest |eigenvalue| of the matrix of a step of length `scaled`/frequency.

        The common motion of both masses has the eigenvalue 1.
        """
        h = scaled / contact
        number = fixed_step.NAMES.index(method)
        drives = fixed_step.forcing(p, 0.0, h)

        def after(y):
            return np.array(fixed_step.one_step(number, p, drives, h, tuple(map(float, y))))

        matrix = [after(1e-6 * unit) - after(-1e-6 * unit) for unit in np.eye(4)]
        return np.abs(np.linalg.eigvals(np.array(matrix).T / 2e-6)).max()

    for scaled in (0.5, 1.0):
        expected = math.sqrt(1 + scaled**4 / 4) if method == "heun" else 1.0
        assert_allclose(growth(scaled), expected, atol=1e-2)
    if limit > 0:
        assert growth(0.98 * limit) < 1.01
        assert growth(1.02 * limit) > 1.02


@pytest.mark.parametrize("damper", [DESIGN, INELASTIC], ids=["elastic", "inelastic"])
def test_located_contacts_agree_with_the_taylor_series(damper):
    p = pack(PAPER, damper, 2.0)
    y = np.array([0.1, 0.2, 0.0, -2.4 * damper.clearance / 2])
    begin = strobe_map.strobe_time(p)
    times = begin + math.pi * np.arange(1, 4)
    expected, log = sample(p, y, begin, times)
    assert len(log) >= 4
    strobes = merson.Merson().strobes(p, y, begin, 3, 1e-12, True)
    assert_allclose(strobes, expected, atol=1e-8)
    states = SciPy("DOP853").strobes(p, y, begin, 3, 1e-12, True, 10**6)
    assert_allclose(states, expected, atol=1e-8)


def test_the_kink_takes_the_order_away():
    """With elastic contacts that are not located, a method of order 4 has only order 2."""
    p = pack(PAPER, DESIGN, 2.0)
    y = np.array([0.1, 0.2, 0.0, -2.4])
    begin = strobe_map.strobe_time(p)
    expected, _ = sample(p, y, begin, [begin + math.pi])
    steps = np.unique(np.geomspace(2000, 40000, 24).astype(int))
    errors = [
        np.abs(fixed("runge_kutta_4", p, y, int(n), 1, begin)[0][-1] - expected[-1]).max()
        for n in steps
    ]
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert -2.7 < slope < -1.3


def test_a_diverging_run_has_nan_from_this_cycle_on():
    p = pack(PAPER, DESIGN, 2.0)
    strobes, largest, run = fixed("runge_kutta_4", p, [0.0, 0.0, 5.0, 0.0], 20, 3)
    assert run < 3
    assert np.isnan(strobes[run:]).all() and np.isnan(largest[run:]).all()


def test_too_many_evaluations_are_a_failure():
    p = pack(PAPER, DESIGN, 2.0)
    states = SciPy("RK45").strobes(p, START, 0.0, 2, 1e-9, True, most_evaluations=20)
    assert np.isnan(states).all()


@pytest.mark.parametrize("name", ["taylor", "merson", "DOP853"])
def test_the_end_of_a_run_is_its_last_strobe(name):
    p = pack(PAPER, DESIGN, 2.0)
    given = p, np.array([0.1, 0.2, 0.0, -2.4]), strobe_map.strobe_time(p), 2, 1e-10, True
    integrator = integrators()[name]
    assert_allclose(integrator.end(*given), integrator.strobes(*given)[-1], atol=1e-8)
