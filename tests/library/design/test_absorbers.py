"""Tuned absorbers, compared with closed forms and SciPy."""

import math
from dataclasses import replace

import numpy as np
import pytest
from helpers.design_tasks import task
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.signal import find_peaks

from impact_damper.data.datasets import flag
from impact_damper.design.absorbers import (
    absorber_responses,
    exact_absorber,
    response,
)
from impact_damper.model.machine import Machine, TunedAbsorber

SPRING = {"mass": 12, "linear_stiffness": 2e5}
LINEAR = Machine(**SPRING, damping_ratio=0.005, force=40)
UNDAMPED = Machine(**SPRING, damping_ratio=1e-8, force=40)
EXCITED = {
    "force": LINEAR,
    "damped": replace(LINEAR, damping_ratio=0.1),
    "unbalance": Machine(**SPRING, damping_ratio=0.01, unbalance=0.002),
    "base_displacement": Machine(**SPRING, damping_ratio=0.01, base_displacement=2e-4),
    "base_acceleration": Machine(**SPRING, damping_ratio=0.01, base_acceleration=3.0),
}
HARD = Machine(**SPRING, cubic_stiffness=4e9, damping_ratio=0.005, force=40)
FREQUENCIES = [18.0, 20.5, 23.0]
PERIODS, SAMPLES = 200, 64


def exact_optimum(mass) -> tuple:
    """Return tuning and damping ratio of the best absorber on an undamped machine with a force.

    Nishihara and Asami, "Closed-form solutions to the exact optimizations of dynamic vibration
    absorbers", J. Vib. Acoust. 124(4), 576-582, 2002, doi 10.1115/1.1500335.
    """
    root = np.sqrt(4 + 3 * mass)
    squared = 16 + 23 * mass + 9 * mass**2 + 2 * (2 + mass) * root
    frequency = 2 / (1 + mass) * np.sqrt(2 * squared / (3 * (64 + 80 * mass + 27 * mass**2)))
    return frequency, np.sqrt((8 + 9 * mass - 4 * root) / (1 + mass)) / 4


@pytest.mark.parametrize("mass", [0.12, 0.6, 6])
def test_without_damping_the_optimum_is_the_closed_form(mass):
    absorber, (tuning, damping) = exact_absorber(UNDAMPED, mass), exact_optimum(mass / 12)
    own = 2 * math.pi * UNDAMPED.natural_frequency * tuning
    closed = TunedAbsorber(mass=mass, stiffness=mass * own**2, damping=2 * mass * damping * own)
    sizes = [
        response(UNDAMPED, each, np.linspace(5, 50, 9001)).max() for each in (absorber, closed)
    ]
    assert_allclose(*sizes, rtol=3e-4)
    found = math.sqrt(absorber.stiffness / mass), absorber.damping
    assert_allclose(found, (own, closed.damping), rtol=0.02)


def test_an_absorber_of_ones_own_moves_as_the_two_masses_do():
    """The amplitudes solve (K + i w C - w^2 M) x = F of machine and absorber."""
    own = TunedAbsorber(mass="0.5 kg", stiffness="8 N/mm", damping=12)
    found = absorber_responses(LINEAR, 0.6, FREQUENCIES, own=own)["competitor_displacement"]
    for hertz in FREQUENCIES:
        w = 2 * math.pi * hertz
        link, spring = 8e3 + 12j * w, 2e5 + 1j * w * LINEAR.viscous_damping
        matrix = [[spring + link - 12 * w**2, -link], [-link, link - 0.5 * w**2]]
        exact = 1e3 * abs(np.linalg.solve(matrix, [40, 0])[0])
        at = {"frequency": hertz, "detuning": 0.0, "force_share": 1.0}
        assert_allclose(found.sel(competitor="own", **at), exact, rtol=1e-12)
    assert "own" not in absorber_responses(LINEAR, 0.6, FREQUENCIES).competitor
    task(absorber={"mass": 0.5, "stiffness": 8e3, "damping": 12})
    with pytest.raises(ValueError, match="stiffness = 0 N/m"):
        task(absorber={"mass": 0.5, "stiffness": 0, "damping": 12})


@pytest.mark.parametrize("name", [each for each in EXCITED if each != "base_acceleration"])
def test_peaks_are_equal_and_no_other_tuning_has_lower_ones(name):
    machine = EXCITED[name]
    absorber, frequencies = exact_absorber(machine, 0.6), np.linspace(16, 26, 4001)
    sizes = response(machine, absorber, frequencies)[:, 0]
    peaks = sizes[find_peaks(sizes)[0]]
    assert_allclose(peaks[0], peaks[1], rtol=3e-4)
    best = sizes.max()
    for stiffness, damping in ((0.99, 1), (1.01, 1), (1, 0.97), (1, 1.03)):
        other = replace(
            absorber, stiffness=stiffness * absorber.stiffness, damping=damping * absorber.damping
        )
        assert response(machine, other, frequencies).max() >= best * (1 - 1e-5)


def test_in_a_band_an_end_is_as_high_as_another_place():
    absorber = exact_absorber(LINEAR, 0.6, (20, 21.5))
    sizes = response(LINEAR, absorber, np.linspace(20, 21.5, 4001))[:, 0]
    places = [sizes[0], sizes[-1], *sizes[find_peaks(sizes)[0]]]
    assert_allclose(np.sort(places)[-1], np.sort(places)[-2], rtol=1e-4)


@pytest.mark.parametrize("name", EXCITED)
def test_linear_machines_by_the_equations_in_si_units(name):
    machine = EXCITED[name]
    data = absorber_responses(machine, 0.6, FREQUENCIES, [1.0, 2.0], band=(10, 40))
    absorber = exact_absorber(machine, 0.6, (10, 40))
    w = 2 * np.pi * np.array(FREQUENCIES)
    link = absorber.stiffness + 1j * w * absorber.damping
    machine_side = 2e5 + 1j * w * machine.viscous_damping + link - 12 * w**2
    matrix = np.array([[machine_side, -link], [-link, link - 0.6 * w**2]])
    # The acceleration of a moving base acts on both masses; displacements are relative to the base.
    shaken = {"base_displacement": 2e-4 * w**2, "base_acceleration": np.full(3, 3.0)}
    pulled = 0.002 * w**2 if name == "unbalance" else np.full(3, 40.0)
    loads = np.outer([12, 0.6], shaken[name]) if name in shaken else np.array([pulled, 0 * w])
    solved = np.linalg.solve(matrix.transpose(2, 0, 1), loads.T[..., None])
    expected = 1e3 * np.abs(solved[:, 0, 0])
    tuned = data["competitor_displacement"].sel(competitor="tuned", detuning=0)
    assert_allclose(tuned.sel(force_share=1), expected, rtol=1e-11)
    assert_allclose(tuned.sel(force_share=2), 2 * expected, rtol=1e-11)
    assert (data["competitor_status"] == flag("competitor_status", "exact")).all()


@pytest.mark.parametrize(("hertz", "tolerance"), [(19.0, 0.01), (20.5, 0.01), (24.5, 0.02)])
def test_a_cubic_machine_by_scipy(hertz, tolerance):
    """One harmonic has an error of 1 or 2 % at frequencies at which the motion is periodic."""
    data = absorber_responses(HARD, 0.6, [hertz], [1.0], detunings=[0.0]).squeeze()
    absorber = exact_absorber(HARD, 0.6)

    def rate(t, y):
        x, v, u, w = y
        link = absorber.stiffness * u + absorber.damping * w
        total = 40 * np.cos(2 * np.pi * hertz * t) - HARD.viscous_damping * v
        a = (total - 2e5 * x - 4e9 * x**3 - link) / 12
        return [v, a, w, a - link / 0.6]

    times = np.arange((PERIODS - 10) * SAMPLES, PERIODS * SAMPLES + 1) / (SAMPLES * hertz)
    run = solve_ivp(rate, (0, times[-1]), np.zeros(4), "DOP853", times, rtol=1e-8, atol=1e-12)
    found = data["competitor_displacement"].sel(competitor="tuned")
    assert_allclose(found, 1e3 * np.abs(run.y[0]).max(), rtol=tolerance)
    assert (data["competitor_status"] == flag("competitor_status", "one_harmonic")).all()


def test_a_softening_machine_escapes_where_no_motion_below_the_barrier_exists():
    soft = replace(HARD, cubic_stiffness=-1.5e9)
    sizes = response(soft, None, [20.0], [0.1, 100.0])[0]
    assert sizes[0] < math.sqrt(2e5 / 1.5e9)
    assert sizes[1] == math.inf


def test_without_a_linear_spring_no_absorber_is_possible():
    cubic = Machine(mass=12, cubic_stiffness=4e9, damping=15.0, force=40)
    data = absorber_responses(cubic, 0.6, FREQUENCIES, [1.0])
    assert data["competitor_status"][1] == flag("competitor_status", "not_possible")
    known = np.isfinite(data["competitor_displacement"])
    assert known.sel(competitor="bare").all() and not known.sel(competitor="tuned").any()
