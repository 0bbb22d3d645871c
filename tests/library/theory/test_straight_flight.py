"""Closed forms for the optimum clearance, against sampled motions, laws, and exact orbits."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from chatterjee1995.methods.quiet_orbits import elastic_ratios, least_harmonic_ratio
from chatterjee1995.stages.design_rules import QuietMotion
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.straight_flight import Flight, flight_of, least_displacement_ratio

PHASES = np.linspace(0, np.pi, 8001)


def straight(mass_ratio, restitution, impulse):
    """Return Z1 over half a cycle after an impact at a rigid wall, rm W^2 d0, and the lag."""
    mean_speed = 2 * impulse / np.pi * (1 + 1 / mass_ratio)
    lag = np.arcsin(mean_speed * (1 - restitution) / (1 + restitution))
    flight = impulse * (1 - 2 * PHASES / np.pi)
    primary = flight - np.cos(PHASES + lag)
    loose = -flight / mass_ratio
    return primary, mass_ratio * (primary - loose)[0], lag


CASES = [(0.05, 1.0), (0.4, 1.0), (0.12, 0.97), (0.12, 0.75), (0.4, 0.5)]


@pytest.mark.parametrize(("mass_ratio", "restitution"), CASES)
def test_optima_of_sampled_straight_flights(mass_ratio, restitution):
    """Optima of displacement and of first harmonic are compared with samples of the motion."""
    loss = 2 / np.pi * (1 + 1 / mass_ratio) * (1 - restitution) / (1 + restitution)
    most = min(1.5, 0.999 / loss) if loss else 1.5

    def largest(impulse):
        return np.max(np.abs(straight(mass_ratio, restitution, impulse)[0]))

    def harmonic(impulse):
        wave = straight(mass_ratio, restitution, impulse)[0] * np.exp(-1j * PHASES)
        return abs(np.trapezoid(wave, PHASES))

    flight = Flight(mass_ratio, restitution)
    for size, rule in ((largest, least_displacement_ratio), (harmonic, least_harmonic_ratio)):
        grid = np.linspace(0.02, most, 100)
        k = np.argmin([size(impulse) for impulse in grid])
        bounds = grid[max(k - 1, 0)], grid[min(k + 1, 99)]
        best = minimize_scalar(size, bounds=bounds, method="bounded", options={"xatol": 1e-9}).x
        assert_allclose(rule(flight), straight(mass_ratio, restitution, best)[1], rtol=2e-4)


@pytest.mark.parametrize(
    ("damping", "stiffness"), [(0, 0), (0.2, 0), (0, 0.6), (0.3, 0.15), (0.1, 0.5)]
)
def test_flight_of_the_primary_mass_solves_its_equation(damping, stiffness):
    """The motion solves x'' + g x' + l^2 x = cos(phi) between two impulses of 4 q/pi."""
    flight, impulse = Flight(0.12, 0.9, damping=damping, stiffness=stiffness), 0.9
    lag = flight.lag(impulse)

    def rates(phase, x):
        forcing = np.cos(phase - flight.forced_lag)
        return x[1], forcing - damping * x[1] - stiffness**2 * x[0]

    start = flight.motion(lag, impulse)[:2]
    end = solve_ivp(rates, (lag, lag + np.pi), start, rtol=1e-11, atol=1e-12).y[:, -1]
    assert_allclose(end, flight.motion(lag + np.pi, impulse)[:2], atol=1e-8)
    assert_allclose(end[0], -start[0], atol=1e-4 if damping == stiffness == 0 else 1e-8)
    before = -end[1]
    assert_allclose(before - start[1], 4 * impulse / np.pi, rtol=1e-8)
    # the relative velocities before and after an impact have the ratio -e, with e = 0.9
    loose = 2 * impulse / (np.pi * flight.mass_ratio)
    assert_allclose(start[1] - loose, -0.9 * (before + loose), rtol=1e-8)


def optima(oscillator, mass_ratio, restitution, contact_stiffness, frequency):
    """Return the optima of rm W^2 d0 by exact orbits, by closed forms, and the `Flight`."""
    damper = Damper(mass_ratio, 1.0, restitution, contact_stiffness)
    flight = flight_of(oscillator, damper, frequency)
    motion = QuietMotion(oscillator, damper, frequency)
    rules = least_displacement_ratio(flight), least_harmonic_ratio(flight)
    exact = np.array([motion.least(i, rule)[0] for i, rule in enumerate(rules)])
    return exact, np.array(rules), flight


@pytest.mark.parametrize("restitution", [1.0, 0.75])
def test_what_a_contact_of_finite_duration_leaves_is_of_second_order(restitution):
    """With r1 16 times as large, a contact lasts a quarter as long."""
    errors, uncorrected = [], []
    for stiffness in (4e3, 6.4e4):
        exact, rules, flight = optima(Oscillator(0.02), 0.25, restitution, stiffness, 8.0)
        rigid = flight._replace(contact=0.0)
        uncorrected.append(least_displacement_ratio(rigid) - exact[0])
        errors.append(np.abs(rules - exact))
    assert_allclose(uncorrected[0] / uncorrected[1], 4, rtol=0.1)
    assert np.all(errors[0] / errors[1] > 8)
    assert np.all(errors[1] < 2e-4)


@pytest.mark.parametrize(
    ("oscillator", "mass_ratio", "restitution"),
    [
        (Oscillator(0.8), 0.12, 1.0),
        (Oscillator(0.8), 0.25, 0.85),
        (Oscillator(0.1, 2.0), 0.4, 1.0),
        (Oscillator(0.4, 2.4), 0.12, 0.9),
    ],
)
def test_damping_and_linear_stiffness_are_exact(oscillator, mass_ratio, restitution):
    exact, rules, _ = optima(oscillator, mass_ratio, restitution, 1e8, 4.0)
    assert_allclose(rules, exact, rtol=3e-4)


def test_explicit_ratios_are_of_first_order():
    """Half the time in contact and half the damping quarter the error of the explicit formulas."""
    left = []
    for half in (1.0, 0.5):
        flight = Flight(0.2, 1.0, 0.02 * half, 0.04 * half)
        whole = least_displacement_ratio(flight), least_harmonic_ratio(flight)
        left.append(np.subtract(whole, elastic_ratios(flight)))
    assert_allclose(left[0] / left[1], 4, rtol=0.1)
    assert np.isnan(elastic_ratios(Flight(0.2, 0.9))).all()


def test_frequency_lies_above_the_linear_one():
    with pytest.raises(ValueError, match=r"frequency = 1.5: must be greater than 1.5"):
        flight_of(Oscillator(0.1, 1.5), Damper(0.12, 1.0), 1.5)
