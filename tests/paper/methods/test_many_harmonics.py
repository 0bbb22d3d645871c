"""Many harmonics and Hill's method against sampled forces, differences, SciPy, and exact orbits."""

from dataclasses import replace

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER
from references import equation
from references.equation import KNOWN, SPRINGS
from scipy.integrate import solve_ivp

from chatterjee1995.methods import fourier, hill, many_harmonics
from chatterjee1995.methods.many_harmonics import Balance, refine, single_term, solve, state_of
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper
from impact_damper.orbits.shooting import find_orbit
from impact_damper.theory import single_harmonic


def arbitrary(balance, seed=1):
    """Return the coefficients of random series of Z1 and Z2. Z2 touches both walls."""
    generator = np.random.default_rng(seed)
    shape = 2, len(balance.harmonics)
    series = generator.standard_normal(shape) + 1j * generator.standard_normal(shape)
    series /= 4.0 * (1 + balance.harmonics) ** 2
    series[1, 0] = 0.6 * balance.damper.clearance
    return series


@pytest.mark.parametrize("damper", [DESIGN, INELASTIC])
def test_residual_is_that_of_the_sampled_equations(damper):
    """The forces (22) to (24) of the paper are sampled at many phases."""
    balance = Balance(PAPER, damper, 2.0, 9)
    series, k = arbitrary(balance), balance.harmonics
    count = 2**17
    angle = 2 * np.pi * np.arange(count) / count
    (x, v, a), (z, w, b) = (
        [fourier.samples(each * (1j * k * 2.0) ** n, k, count) for n in range(3)] for each in series
    )
    touching = np.abs(z) > damper.clearance
    force = damper.contact_stiffness * (z - np.sign(z) * damper.clearance) + damper.dashpot * w
    force = np.where(touching, force, 0)
    first = a + PAPER.damping * v + x**3 + force - np.cos(angle)
    second = b - a + force / damper.mass_ratio
    sampled = np.fft.rfft([first, second])[:, k] / count
    found = balance.residual(series, balance.contacts(series))
    assert found == pytest.approx(sampled, abs=1e-4 * np.max(np.abs(found)))


@pytest.mark.parametrize("restitution", [1.0, 0.8])
@pytest.mark.parametrize("oscillator", KNOWN.values(), ids=KNOWN)
def test_balance_with_contacts_in_other_springs(oscillator, restitution):
    """The Jacobian agrees with differences of the residual, and a single harmonic with (7)."""
    damper = Damper(0.2, 1.0, restitution, 300.0)
    many = Balance(oscillator, damper, 1.7, 7)
    series = arbitrary(many)
    unknowns = many.to_real(series)

    def residual(x):
        trial = many.to_complex(x)
        return many.to_real(many.residual(trial, many.contacts(trial)))

    differences = [
        (residual(unknowns + d) - residual(unknowns - d)) / 2e-6
        for d in 1e-6 * np.eye(len(unknowns))
    ]
    matrix = many.operator(series, many.contacts(series))
    assert matrix == pytest.approx(np.transpose(differences), abs=1e-6 * np.max(np.abs(matrix)))
    if restitution == 1:
        one = Balance(oscillator, damper, 1.7, 1)
        found = single_harmonic.impacting_solutions(oscillator, damper, 1.7)
        for a, b, phase in zip(*found, strict=True):
            term = np.array([[a], [b]]) * np.exp(1j * phase) / 2
            assert solve(one, term).coefficients == pytest.approx(term, abs=1e-10)


@pytest.mark.parametrize(
    "name, frequency",
    [("softening", 0.9), ("linear", 1.2), ("shaken", 1.2), ("unbalance", 1.1), ("hard", 2.5)],
)
def test_a_free_motion_is_the_one_that_scipy_integrates(name, frequency):
    """DOP853 integrates a free period-1 motion over a cycle. Differences give the multipliers."""
    oscillator = SPRINGS[name]
    balances = [Balance(oscillator, None, frequency, n) for n in (1, 3, 7, 15, 31)]
    solution = refine(balances, single_term(oscillator, None, frequency))[-1]
    assert solution.status == "converged"
    p = pack(oscillator, None, frequency)
    begin, period = 0.5 * np.pi / frequency, 2 * np.pi / frequency

    def end(state):
        span, both = (begin, begin + period), np.tile(state, 2)
        run = solve_ivp(equation.rates(p), span, both, "DOP853", rtol=1e-12, atol=1e-13)
        return run.y[:2, -1]

    state = state_of(solution)[:2]
    assert end(state) == pytest.approx(state, abs=1e-8)
    columns = [(end(state + d) - end(state - d)) / 2e-4 for d in 1e-4 * np.eye(2)]
    expected = np.linalg.eigvals(np.transpose(columns))
    found = hill.exponents(solution).multipliers(period)
    assert np.max(np.abs(found[:, None] - expected).min(axis=1)) < 1e-5


@pytest.mark.thorough
@pytest.mark.parametrize("damper", [DESIGN, INELASTIC])
def test_approaches_the_exact_orbit_and_its_multipliers(damper):
    balances = [Balance(PAPER, damper, 2.0, n) for n in (1, 3, 7, 15, 31, 63, 127, 255)]
    solutions = refine(balances, single_term(PAPER, damper, 2.0))
    assert all(each.status == "converged" for each in solutions)
    state = state_of(solutions[-1])
    exact = find_orbit(pack(PAPER, damper, 2.0), state)
    assert state == pytest.approx(exact.strobe_states[0], abs=5e-3 if damper is INELASTIC else 5e-4)
    found = hill.exponents(solutions[-1])
    assert found.status == "found"
    away = np.abs(found.multipliers(np.pi)[:, None] - exact.multipliers[: exact.active])
    assert np.max(away.min(axis=1)) < 1e-3


def test_failures_say_so(monkeypatch):
    first = single_term(PAPER, DESIGN, 2.0)
    lost = solve(Balance(PAPER, replace(DESIGN, contact_stiffness=1e8), 2.0, 63), first)
    assert lost.status in ("stalled", "iteration_limit")
    monkeypatch.setattr(many_harmonics, "ITERATIONS", 2)
    assert solve(Balance(PAPER, DESIGN, 2.0, 15), first).status == "iteration_limit"
