"""Responses of machines with absorbers: closed forms, the published optimum, and long runs."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.design.absorber_problems import problems_of
from impact_damper.design.absorber_responses import absorber_responses
from impact_damper.design.absorber_search import search
from impact_damper.design.direct import best_absorber
from impact_damper.design.linear_response import response
from impact_damper.design.tuning import exact_absorber, nonlinear_absorber
from impact_damper.model.machine import Machine
from impact_damper.theory.nonlinear_absorber import AbsorberOnDuffing, tuned_cubic

SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.01}
LINEAR = {
    "force": Machine(**SPRING, force=40),
    "unbalance": Machine(**SPRING, unbalance=0.002),
    "base_displacement": Machine(**SPRING, base_displacement=2e-4),
    "base_acceleration": Machine(**SPRING, base_acceleration=3.0),
}
HARD = Machine(mass=12, linear_stiffness=2e5, cubic_stiffness=4e9, damping_ratio=0.005, force=40)
FREQUENCIES = [18.0, 20.5, 23.0]


@pytest.mark.parametrize("name", LINEAR)
def test_linear_machines(name):
    """The closed form against the equations in SI units and against the orbit of a search."""
    machine = LINEAR[name]
    data = absorber_responses(machine, 0.6, FREQUENCIES, [1.0, 2.0], band=(10, 40))
    absorber = exact_absorber(machine, 0.6, (10, 40))
    w = 2 * np.pi * np.array(FREQUENCIES)
    through = 2e5 + 1j * w * machine.viscous_damping
    force = {
        "force": 40.0,
        "unbalance": 0.002 * w**2,
        "base_displacement": 2e-4 * np.abs(through),
        "base_acceleration": 3.0 / w**2 * np.abs(through),
    }[name]
    link = absorber.stiffness + 1j * w * absorber.damping
    carried = -(w**2) * 0.6 * link / (link - 0.6 * w**2)
    expected = 1e3 * np.abs(force / (through - 12 * w**2 + carried))
    tuned = data["competitor_displacement"].sel(competitor="tuned", detuning=0)
    assert_allclose(tuned.sel(force_share=1), expected, rtol=1e-11)
    assert_allclose(tuned.sel(force_share=2), 2 * expected, rtol=1e-11)
    problems = problems_of(machine, absorber, FREQUENCIES, [1.0, 2.0])
    found = search(problems, (3, 2), 2, 1)[0]
    assert_allclose(found.most.reshape(3, 2) * machine.scales.length * 1e3, tuned, rtol=1e-8)
    np.testing.assert_array_equal(found.share, 1)


@pytest.mark.thorough
def test_what_is_not_possible_is_said():
    linear = absorber_responses(LINEAR["force"], 0.6, FREQUENCIES, [1.0])
    remarks = json.loads(linear.attrs["remarks"])
    assert "it is the tuned absorber" in remarks["nonlinear"] and remarks["best"]
    cubic = Machine(mass=12, cubic_stiffness=4e9, damping=15.0, force=40)
    data = absorber_responses(cubic, 0.6, FREQUENCIES, [1.0])
    assert set(json.loads(data.attrs["remarks"])) == {"tuned", "nonlinear"}
    status = data["competitor_status"].values
    assert (status[[0, 3]] == flag("competitor_status", "found")).all()
    assert (status[1:3] == flag("competitor_status", "not_possible")).all()
    assert np.isfinite(data["competitor_displacement"].values[[0, 3]]).all()


@pytest.mark.thorough
def test_the_published_nonlinear_absorber():
    """Both peaks of Habib and others, against a separate program that balances four harmonics."""
    machine = Machine(mass=1, linear_stiffness=1, cubic_stiffness=1, damping_ratio=1e-6, force=0.03)
    published = AbsorberOnDuffing(0.05, 1.0, tuned_cubic(0.05, 1.0), 0.03).peaks()
    hertz = published.frequencies / (2 * np.pi)
    data = absorber_responses(machine, 0.05, hertz, [1.0], detunings=[0.0], starts=2)
    found = data["competitor_displacement"].sel(competitor="nonlinear").squeeze()
    assert_allclose(found * 1e-3 / 0.03, published.displacements, rtol=1e-4)
    assert_allclose(found[1], found[0], rtol=0.01)


def test_a_motion_without_a_period_by_scipy():
    """At four times the force the nonlinear absorber has a torus and no stable periodic motion."""
    absorber, hertz = nonlinear_absorber(HARD, 0.6), 23.6
    data = absorber_responses(HARD, 0.6, [hertz], [4.0], detunings=[0.0])
    found = data.sel(competitor="nonlinear").squeeze()
    assert found["competitor_status"] == flag("competitor_status", "not_periodic")
    assert found["competitor_motions"] == 0

    def rate(t, y):
        x, v, u, w = y
        total = 160 * np.cos(2 * np.pi * hertz * t)
        total -= HARD.viscous_damping * v + 2e5 * x + 4e9 * x**3
        link = absorber.stiffness * u + absorber.damping * w + absorber.cubic_stiffness * u**3
        return [v, (total - link) / 12, w, (total - link) / 12 - link / 0.6]

    times = np.arange(60 * 32, 160 * 32) / (32 * hertz)
    run = solve_ivp(
        rate, (0, times[-1]), np.zeros(4), t_eval=times, method="DOP853", rtol=1e-7, atol=1e-9
    )
    strobes = run.y[0, ::32]
    assert np.ptp(strobes) > 0.1 * np.abs(run.y[0]).max()
    assert_allclose(found["competitor_displacement"], 1e3 * np.abs(run.y[0]).max(), rtol=0.01)


@pytest.mark.thorough
def test_a_motion_without_a_period_that_few_starts_reach():
    """A motion that no random start leads to is found from neighbouring frequencies and forces."""
    machine, absorber = HARD, best_absorber(HARD, 0.6, (20, 32))
    frequencies, shares = np.linspace(23.0, 27.5, 16), [2.83, 4.0]
    problems = problems_of(machine, absorber, frequencies, shares)
    few = search(problems, (16, 2), 2, 1)[0]
    many = search(problems, (16, 2), 48, 2)[0]
    wandering = flag("competitor_status", "not_periodic")
    np.testing.assert_array_equal(few.status == wandering, many.status == wandering)
    assert_allclose(few.most, many.most, rtol=0.1)
    assert ((few.status == wandering) & (few.share == 0)).any()


def test_a_detached_resonance():
    """Above both peaks there is a second motion, of twice the size of the motion from rest."""
    machine = Machine(mass=1, linear_stiffness=1, cubic_stiffness=1, damping=0.002, force=0.13)
    absorber, w = nonlinear_absorber(machine, 0.05), 1.85
    problems = problems_of(machine, absorber, [w / (2 * np.pi)], [0.8, 1.0])
    found, orbits, _ = search(problems, (1, 2), 4, 1)
    assert found.motions.tolist() == [1, 2]
    for orbit in np.flatnonzero(orbits.problem == 1):
        length = machine.scales.length
        start = orbits.state[orbit] * length * [1, w, 1, w]

        def rate(t, y):
            x, v, u, s = y
            link = absorber.stiffness * u + absorber.damping * s + absorber.cubic_stiffness * u**3
            a = 0.13 * np.cos(w * t) - 0.002 * v - x - x**3 - link
            return [v, a, s, a - link / 0.05]

        start = start + 1e-3 * np.abs(start).max()
        times = np.linspace(199, 200, 1001) * 2 * np.pi / w
        run = solve_ivp(rate, (0, times[-1]), start, "DOP853", times, rtol=1e-8, atol=1e-10)
        assert_allclose(np.abs(run.y[0]).max(), orbits.largest[orbit, 0] * length, rtol=1e-3)


@pytest.mark.thorough
def test_the_bare_machine_by_the_search_of_the_package():
    """The search of `frequency_response`, with another integrator, finds the same displacements."""
    data = absorber_responses(HARD, 0.6, [23.0, 24.0], [1.0], detunings=[0.0])
    other = idm.frequency_response(HARD, None, [23.0, 24.0], starts=2)
    stable = other["maximum_displacement"].where(np.isfinite(other["residual"]))
    bare = data.sel(competitor="bare").squeeze()
    assert_allclose(bare["competitor_displacement"], stable.max("motion"), rtol=1e-6)
    assert_allclose(bare["competitor_least_displacement"], stable.min("motion"), rtol=1e-6)


def test_a_softening_machine_escapes_from_some_starts():
    soft = Machine(
        mass=12, linear_stiffness=2e5, cubic_stiffness=-4e9, damping_ratio=0.005, force=10
    )
    data = absorber_responses(soft, 0.6, [19.0], [1.0], detunings=[0.0], starts=256)
    assert data["competitor_escaped"].sel(competitor="bare", frequency=19) > 0
    assert data["competitor_displacement"].max() < 7.1
    assert (data["absorber_cubic_stiffness"].sel(competitor="nonlinear") < 0).all()


@pytest.mark.thorough
def test_wider_searches_find_nothing_larger():
    """A search from 4 starts, as for the tables, misses no motion that 32 starts reach."""
    few = absorber_responses(HARD, 0.6, [21, 24, 28], [1.0, 4.0], detunings=[0.0], starts=4)
    many = absorber_responses(
        HARD, 0.6, [21, 24, 28], [1.0, 4.0], detunings=[0.0], starts=32, seed=7
    )
    assert_allclose(few["competitor_displacement"], many["competitor_displacement"], rtol=5e-3)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"mass": 0}, "mass = 0 kg: must be at least"),
        ({"mass": 12.1}, "the mass of the machine"),
        ({"frequencies": [21, 20]}, "frequencies = .*: must be increasing"),
        ({"frequencies": [-1]}, "frequencies.0. = -1 Hz"),
        ({"force_shares": [0.0]}, "force_shares.0. = 0"),
        ({"detunings": [-1]}, "detunings.0. = -1"),
        ({"starts": 0}, "starts = 0"),
        ({"machine": Machine(**SPRING, force=0)}, "force = 0 N"),
        ({"band": (30, 20)}, "band = .*in order"),
    ],
)
def test_nonsense_is_refused(change, told):
    given = {"machine": HARD, "mass": 0.6, "frequencies": FREQUENCIES} | change
    with pytest.raises(ValueError, match=told):
        absorber_responses(**given)


def test_response_without_absorber_is_that_of_an_oscillator():
    found = response(LINEAR["force"], None, 20.0)
    w = 40 * np.pi
    assert_allclose(found, 40 / abs(2e5 - 12 * w**2 + 1j * w * LINEAR["force"].viscous_damping))
