"""Integrators: required attributes, orders, located contacts, stability in contact."""

import math

import numpy as np
import pytest
from helpers import configurations
from helpers.known_orbits import DESIGN, INELASTIC, PAPER
from helpers.sampling import sample
from numpy.testing import assert_allclose

from chatterjee1995.methods.integrator import Integrator
from chatterjee1995.methods.integrators import fixed_steps, integrators
from chatterjee1995.methods.labels import TOLERANCE_KEYS
from impact_damper.model.packed import CLEARANCE, pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions import strobe_map

ORDERS = {"verlet": 2, "runge_kutta_4": 4, "merson": 4}
START = np.array([0.7, -0.3, 0.5, 0.2])


@pytest.mark.parametrize("name", integrators())
def test_an_integrator_has_what_its_stages_call(name):
    integrator = integrators()[name]
    where = type(integrator).__module__
    assert integrator.title, f"{where}: {name} has no title"
    assert integrator.compared, f"{where}: no stage compares {name}"
    places = [each.place for each in integrators().values()]
    assert places.count(integrator.place) == 1, f"{where}: the place of {name} is taken"
    for stage in integrator.compared:
        assert stage in Integrator.REQUIRED, f"{where}: {name} names no stage {stage}"
        needed = Integrator.REQUIRED[stage]
        own = [getattr(type(integrator), each) is not getattr(Integrator, each) for each in needed]
        assert any(own), f"{where}: {stage} calls {needed[0]}, which {name} lacks"
    if "accuracy" in integrator.compared:
        known = integrator.tolerances in TOLERANCE_KEYS
        assert known, f"{where}: {name} has no tolerances, one of {', '.join(TOLERANCE_KEYS)}"
        assert integrator.tolerances in configurations.read()["comparison"]


def fixed_end(method, p, y, steps, periods, t=0.0):
    """Return the state after `periods` forcing cycles of `steps` equal steps each."""
    ends = np.empty((steps * periods, 5))
    step = math.pi / steps  # the frequency is 2
    fixed_steps.fixed_ends(integrators()[method].number, p, np.array(y, float), t, step, ends)
    return ends[-1, 1:]


@pytest.fixture(scope="module")
def free():
    """Return parameters without a damper, and the state after two cycles by the Taylor series."""
    p = pack(PAPER, None, 2.0)
    states, _ = sample(p, START, 0.0, [2 * 2 * math.pi / 2.0])
    return p, states[-1]


@pytest.mark.parametrize("method", ORDERS)
def test_order_of_fixed_steps(method, free):
    p, end = free
    errors = [
        np.abs(fixed_end(method, p, START, steps, 2) - end).max() for steps in (200, 400, 800)
    ]
    assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), ORDERS[method], atol=0.15)


@pytest.mark.parametrize("name", integrators("accuracy"))
def test_a_run_on_a_smooth_motion(name, free):
    p, end = free
    integrator = integrators()[name]
    for locate in integrator.located:
        run = integrator.run(p, START, 0.0, 2, 1e-9, locate, 10**6)
        assert run.status == "ended" and run.operations > 0
        assert_allclose(run.state, end, atol=1e-5)


@pytest.mark.parametrize("method", ORDERS)
def test_linear_stability_limit_of_the_contact(method):
    """With almost no clearance the two masses and the contact spring are a linear oscillator."""
    stiffness, mass_ratio = 1e6, 0.25
    p = pack(Oscillator(1e-9), Damper(mass_ratio, 1.0, contact_stiffness=stiffness), 2.0)
    p[CLEARANCE] = 1e-12
    contact = math.sqrt(stiffness * (1 + 1 / mass_ratio))
    limit = integrators()[method].stability_limit

    def growth(scaled):
        """Return the largest |eigenvalue| of a step. The common motion of the masses has 1."""
        h = scaled / contact
        drives = fixed_steps.forcing(p, 0.0, h)

        def after(y):
            state = tuple(map(float, y))
            return np.array(fixed_steps.one_step(integrators()[method].number, p, drives, h, state))

        matrix = [after(1e-6 * unit) - after(-1e-6 * unit) for unit in np.eye(4)]
        return np.abs(np.linalg.eigvals(np.array(matrix).T / 2e-6)).max()

    for scaled in (0.5, 1.0):
        assert_allclose(growth(scaled), 1.0, atol=1e-2)
    assert growth(0.98 * limit) < 1.01
    assert growth(1.02 * limit) > 1.02


@pytest.mark.parametrize("damper", [DESIGN, INELASTIC], ids=["elastic", "inelastic"])
@pytest.mark.parametrize("name", ["merson", "DOP853"])
def test_located_contacts_agree_with_the_taylor_series(name, damper):
    p = pack(PAPER, damper, 2.0)
    y = np.array([0.1, 0.2, 0.0, -2.4 * damper.clearance / 2])
    begin = strobe_map.strobe_time(p)
    expected, log = sample(p, y, begin, begin + math.pi * np.arange(1, 4))
    run = integrators()[name].run(p, y, begin, 3, 1e-12, True, 10**6)
    assert_allclose(run.state, expected[-1], atol=1e-8)
    assert len(log) >= 4
    assert_allclose(run.contact_times, log[:, 1], atol=1e-8)


def test_runs_that_diverge_or_take_too_many_evaluations_have_nan():
    p = pack(PAPER, DESIGN, 2.0)
    given = p, np.array([0.0, 0.0, 5.0, 0.0]), 0.0, 3, 20
    assert np.isnan(integrators()["runge_kutta_4"].largest_displacements(*given)).all()
    run = integrators()["DOP853"].run(p, START, 0.0, 2, 1e-9, True, 20)
    assert run.status == "capped" and np.isnan(run.state).all()


def test_a_contact_at_the_start_counts_and_a_series_that_overflows_fails():
    p, begin = pack(PAPER, DESIGN, 2.0), 0.25 * math.pi
    series = integrators()["taylor"]
    found = series.run(p, np.array([0.1, 0.0, 2.01, 0.5]), begin, 20, 1e-11)
    assert found.contact_times[0] == begin
    lost = series.run(p, np.array([1e200, 0.0, 0.0, 1.0]), begin, 20, 1e-11)
    assert lost.status == "failed" and np.isnan(lost.displacement)
