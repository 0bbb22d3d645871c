"""Springs of any sign, any forcing: linear limit, folds, peaks, and SciPy.

Symbols are as in `system.parameters`. Numbers in brackets are equations of the paper.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from references import equation
from references.equation import KNOWN, SPRINGS
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from impact_damper.data.datasets import flag
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory import hill
from impact_damper.theory.design_rule import peak_frequency, rule_clearance
from impact_damper.theory.free_oscillator import (
    free_folds,
    free_solutions,
    main_solutions,
    maximum_response,
    resonance,
)
from impact_damper.theory.harmonic_balance import suppression_band
from impact_damper.theory.many_harmonics import Balance, refine, single_term, solve, state_of
from impact_damper.theory.optimum_clearance import rule_ratios
from impact_damper.theory.single_harmonic import (
    contact_amplitude,
    impacting_solutions,
    resting_solutions,
    rigid_solutions,
)
from impact_damper.theory.slow_flow import (
    fixed_points,
    growth_rate,
    jacobian,
    slow_flow,
    stability,
)

LINEAR, SOFTENING = SPRINGS["linear"], SPRINGS["softening"]


@pytest.fixture(params=KNOWN)
def oscillator(request):
    return SPRINGS[request.param]


def balance(a, phase, oscillator, frequency):
    """Return the residual of the first harmonic of equation (3) without contact."""
    spring = oscillator.linear_frequency**2 - frequency**2 + 0.75 * oscillator.cubic * a**2
    force = oscillator.force + oscillator.unbalance * frequency**2
    force += oscillator.shaker / frequency**2
    return a * (spring + 1j * oscillator.damping * frequency) - force * np.exp(-1j * phase)


def defect(a, oscillator, frequency):
    """Return the squared amplitude of spring, inertia and damping minus the squared force."""
    force = oscillator.force + oscillator.unbalance * frequency**2
    force += oscillator.shaker / frequency**2
    spring = oscillator.linear_frequency**2 - frequency**2 + 0.75 * oscillator.cubic * a**2
    return (a * spring) ** 2 + (a * oscillator.damping * frequency) ** 2 - force**2


def test_peak_of_a_linear_oscillator_in_closed_form():
    square = 1.3**2 - 0.1**2 / 2
    peak = maximum_response(LINEAR)
    assert_allclose(peak.frequency, np.sqrt(square), rtol=1e-12)
    assert_allclose(peak.amplitude, 0.7 / (0.1 * np.sqrt(1.3**2 - 0.1**2 / 4)), rtol=1e-12)
    assert_allclose(peak_frequency(LINEAR), 1.3, rtol=1e-12)
    assert_allclose(rule_clearance(LINEAR, 0.2), 0.7 / (0.2 * 1.3**2), rtol=1e-12)
    assert free_folds(LINEAR) == []


def test_peak_of_a_rotating_unbalance_in_closed_form():
    """x = U W^2/|wl^2 - W^2 + i h W| is largest at W = wl/sqrt(1 - h^2/(2 wl^2))."""
    peak = maximum_response(Oscillator(0.3, 1.2, cubic=0.0, force=0.0, unbalance=0.5))
    assert_allclose(peak.frequency, 1.2 / np.sqrt(1 - 0.3**2 / (2 * 1.2**2)), rtol=1e-12)
    ratio = 0.3 / (2 * 1.2)
    assert_allclose(peak.amplitude, 0.5 / (2 * ratio * np.sqrt(1 - ratio**2)), rtol=1e-12)


def test_peak_on_a_shaker_in_closed_form():
    """x = V/(W^2 |wl^2 - W^2 + i h W|): the slope of 1/x^2 is a quadratic in W^2."""
    least = 2 * 1.2**2 - 0.3**2
    square = (3 * least + np.sqrt(9 * least**2 - 32 * 1.2**4)) / 8
    peak = maximum_response(Oscillator(0.3, 1.2, cubic=0.0, force=0.0, shaker=0.5))
    assert_allclose(peak.frequency, np.sqrt(square), rtol=1e-12)
    assert_allclose(
        peak.amplitude, 0.5 / square / abs(1.2**2 - square + 0.3j * np.sqrt(square)), rtol=1e-12
    )
    with pytest.raises(ValueError, match="shaker = 0.5 it falls"):
        maximum_response(Oscillator(0.8, 1.2, cubic=0.0, force=0.0, shaker=0.5))


def test_all_free_solutions_are_found(oscillator):
    amplitudes = np.concatenate([[0], np.geomspace(1e-4, 100, 200001)])
    for frequency in np.linspace(0.3, 2.5, 23):
        a, phase = free_solutions(oscillator, frequency)
        assert_allclose(balance(a, phase, oscillator, frequency), 0, atol=1e-9)
        values = defect(amplitudes, oscillator, frequency)
        assert len(a) == np.sum(values[:-1] * values[1:] < 0)


@pytest.mark.thorough
def test_folds_are_where_solutions_appear(oscillator):
    """The number of solutions changes at folds, and there one solution is double."""

    def count(frequency):
        return len(free_solutions(oscillator, frequency).amplitude)

    grid = np.linspace(0.02, 4, 1991)
    counts = [count(frequency) for frequency in grid]
    found = []
    for k in np.flatnonzero(np.diff(counts)):
        low, high = grid[k], grid[k + 1]
        while high - low > 1e-11:
            middle = (low + high) / 2
            low, high = (middle, high) if count(middle) == counts[k] else (low, middle)
        found.append(low)
    folds = free_folds(oscillator)
    seen = sorted(fold.frequency for fold in folds if grid[0] < fold.frequency < grid[-1])
    assert_allclose(seen, found, atol=1e-9)
    for fold in folds:
        slope = minimize_scalar(
            lambda a, w=fold.frequency: abs(defect(a, oscillator, w)),
            bounds=(0.99 * fold.amplitude, 1.01 * fold.amplitude),
            method="bounded",
            options={"xatol": 1e-12},
        )
        assert slope.fun < 1e-9
        assert_allclose(slope.x, fold.amplitude, rtol=1e-5)


def test_the_resonance_of_a_softening_spring_ends_below_its_peak():
    peak, folds = maximum_response(SOFTENING), free_folds(SOFTENING)
    end = [fold for fold in folds if fold.amplitude < peak.amplitude][-1]
    assert end.frequency < peak.frequency < 1
    below, above = (resonance(SOFTENING, end.frequency * x) for x in (1 - 1e-6, 1 + 1e-6))
    assert below.phase is None and below.amplitude == end.amplitude
    assert_allclose(above.amplitude, end.amplitude, rtol=1e-2)
    assert resonance(SOFTENING, peak.frequency).amplitude > 0.99 * peak.amplitude


@pytest.mark.thorough
def test_maximum_response_against_a_search(oscillator):
    maximum = maximum_response(oscillator)
    near = minimize_scalar(
        lambda w: -main_solutions(oscillator, w).amplitude[-1],
        bounds=(maximum.frequency * (1 - 1e-3), maximum.frequency * (1 + 1e-3)),
        method="bounded",
        options={"xatol": 1e-10},
    )
    assert_allclose(-near.fun, maximum.amplitude, rtol=1e-6)
    assert -near.fun <= maximum.amplitude * (1 + 1e-12)
    # towards W = 0 the response on a shaker grows without end
    grid = np.linspace(0.6 * maximum.frequency if oscillator.shaker else 0.01, 6, 1000)
    assert all(main_solutions(oscillator, w).amplitude[-1] <= maximum.amplitude for w in grid)


def test_at_the_peak_frequency_the_motion_lags_by_a_quarter_period(oscillator):
    peak = peak_frequency(oscillator)
    a, phase = main_solutions(oscillator, peak)
    assert_allclose(phase[-1], -np.pi / 2, atol=1e-5)
    force = oscillator.forcing_amplitude(peak)
    assert_allclose(a[-1], force / (oscillator.damping * peak), rtol=1e-8)


@pytest.mark.parametrize(
    "oscillator, message",
    [
        (Oscillator(0.05, 1.0, cubic=-0.5, force=0.5), "force = 0.5: .* over the barrier"),
        (Oscillator(0.1, 0.5, cubic=2.0, unbalance=1.0), "unbalance = 1: .* without end"),
        (Oscillator(0.1, 0.0, cubic=0.0), "linear_frequency = 0, cubic = 0.* nothing restores"),
        (Oscillator(0.1, 0.0, cubic=-1.0), "force = 1: .* over the barrier"),
    ],
)
def test_a_response_without_a_peak_says_so(oscillator, message):
    with pytest.raises(ValueError, match=message):
        peak_frequency(oscillator)
    with pytest.raises(ValueError, match="the response has no peak"):
        maximum_response(oscillator)
    band = suppression_band(oscillator, Damper(0.1, 1.0))
    assert band.band_status == flag("band_status", "no_peak")
    assert np.isnan(band.edge_frequency).all() and np.isnan(band.band_width)
    with pytest.raises(ValueError, match="no peak"):
        rule_clearance(oscillator, 0.1)


def test_without_force_there_is_rest():
    free = Oscillator(0.1, 1.0, force=0.0)
    assert free_solutions(free, 1.2).amplitude.tolist() == [0]
    assert slow_flow(fixed_points(free_solutions(free, 1.2)), free, None, 1.2).tolist() == [[0, 0]]
    damper = Damper(0.1, 1.0)
    assert len(impacting_solutions(free, damper, 1.2).phase) == 0
    assert len(rigid_solutions(free, damper, 1.2).phase) == 0
    assert resting_solutions(free, damper, 1.2).amplitude.tolist() == [0]
    with pytest.raises(ValueError, match="needs a forcing"):
        rule_clearance(free, 0.1)
    with pytest.raises(ValueError, match="needs a forcing"):
        rule_ratios(free, damper, 1.2)


DAMPER = Damper(0.12, 1.5, contact_stiffness=400.0)


def test_no_solution_with_contacts_is_missed(oscillator):
    """Against changes of sign on a grid of amplitudes b of Z2, which may miss a close pair."""
    b = 1.5 * (1 + np.concatenate([[0], np.geomspace(1e-9, 1e3, 100000)]))
    escaped = 0
    for frequency in np.linspace(0.4, 2.4, 11):
        push = 400 * contact_amplitude(b, 1.5)[0]
        a = b - push / (0.12 * frequency**2)
        spring = oscillator.linear_frequency**2 - frequency**2 + 0.75 * oscillator.cubic * a**2
        left = (a * spring + push) ** 2 + (oscillator.damping * frequency * a) ** 2
        values = left - oscillator.forcing_amplitude(frequency) ** 2
        scanned = np.sum(values[:-1] * values[1:] < 0)
        found = impacting_solutions(oscillator, DAMPER, frequency)
        assert len(found.phase) >= scanned and (len(found.phase) - scanned) % 2 == 0
        escaped += len(found.phase) > scanned
        assert_allclose(slow_flow(fixed_points(found), oscillator, DAMPER, frequency), 0, atol=1e-8)
    assert escaped <= 1


def test_rigid_solutions_solve_13(oscillator):
    for frequency in (0.6, 1.1, 1.9):
        found = rigid_solutions(oscillator, DAMPER, frequency)
        force = oscillator.forcing_amplitude(frequency)
        sine = -oscillator.damping * frequency * found.amplitude / force
        assert_allclose(np.sin(found.phase), sine, atol=1e-9)
        assert np.all(np.abs(found.residual) < 1e-9 * (1 + np.abs(found.amplitude) ** 3))
        phase = np.linspace(-np.pi, np.pi, 200001)
        a = -force * np.sin(phase) / (oscillator.damping * frequency)
        left = a * (oscillator.linear_frequency**2 - frequency**2) + 0.75 * oscillator.cubic * a**3
        left += 0.12 * frequency**2 * (1.5 - a) - force * np.cos(phase)
        assert len(found.phase) == np.sum(left[:-1] * left[1:] < 0)


def test_rule_19_gives_a_root_of_zero(oscillator):
    peak = peak_frequency(oscillator)
    damper = Damper(0.2, rule_clearance(oscillator, 0.2))
    assert np.min(np.abs(rigid_solutions(oscillator, damper, peak).amplitude)) < 1e-9


def test_jacobian_of_the_slow_flow_against_differences(oscillator):
    generator = np.random.default_rng(7)
    for _ in range(20):
        state = generator.uniform(-2, 2, 4)
        given = oscillator, DAMPER, 1.4
        differences = [
            (slow_flow(state + d, *given) - slow_flow(state - d, *given)) / 2e-6
            for d in 1e-6 * np.eye(4)
        ]
        assert_allclose(jacobian(state, *given), np.transpose(differences), rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize(
    "name, frequency",
    [("softening", 0.9), ("linear", 1.2), ("shaken", 1.2), ("unbalance", 1.1), ("hard", 2.5)],
)
def test_many_harmonics_are_the_motion_that_scipy_integrates(name, frequency):
    """A free period-1 motion over one period by DOP853, and its multipliers by differences."""
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
    assert_allclose(end(state), state, atol=1e-8)
    columns = [(end(state + d) - end(state - d)) / 2e-4 for d in 1e-4 * np.eye(2)]
    expected = np.linalg.eigvals(np.transpose(columns))
    found = hill.exponents(solution).multipliers(period)
    away = np.abs(found[:, None] - expected).min(axis=1)
    assert np.max(away) < 1e-5


@pytest.mark.parametrize("restitution", [1.0, 0.8])
@pytest.mark.parametrize("oscillator", SPRINGS.values(), ids=SPRINGS)
def test_balance_with_contacts_in_other_springs(oscillator, restitution):
    """The Jacobian against differences of the residual, and a single harmonic against (7)."""
    damper = Damper(0.2, 1.0, restitution, 300.0)
    many = Balance(oscillator, damper, 1.7, 7)
    generator = np.random.default_rng(2)
    series = generator.standard_normal((2, 4)) + 1j * generator.standard_normal((2, 4))
    series /= 4.0 * (1 + many.harmonics) ** 2
    series[1, 0] = 0.6
    unknowns = many.to_real(series)

    def residual(x):
        trial = many.to_complex(x)
        return many.to_real(many.residual(trial, many.contacts(trial)))

    differences = [
        (residual(unknowns + d) - residual(unknowns - d)) / 2e-6
        for d in 1e-6 * np.eye(len(unknowns))
    ]
    matrix = many.operator(series, many.contacts(series))
    assert_allclose(matrix, np.transpose(differences), atol=1e-6 * np.max(np.abs(matrix)))
    if restitution == 1 and oscillator in KNOWN.values():
        one = Balance(oscillator, damper, 1.7, 1)
        for a, b, phase in zip(*impacting_solutions(oscillator, damper, 1.7), strict=True):
            term = np.array([[a], [b]]) * np.exp(1j * phase) / 2
            assert solve(one, term).coefficients == pytest.approx(term, abs=1e-10)


def test_the_band_of_a_softening_spring_ends_below_with_its_resonance():
    oscillator = Oscillator(0.15, 1.5, cubic=-0.3, force=0.3)
    damper = Damper(0.6, rule_clearance(oscillator, 0.6))
    band = suppression_band(oscillator, damper)
    assert band.band_status == flag("band_status", "found")
    assert band.edge_event[0] == flag("edge_event", "resonance_branch_ends")
    highest = maximum_response(oscillator).amplitude
    end = [fold for fold in free_folds(oscillator) if fold.amplitude < highest][-1]
    assert_allclose(band.edge_frequency[0], end.frequency, atol=2e-10)
    below = float(band.break_even_frequency)
    assert below < end.frequency < band.peak_frequency < band.edge_frequency[1]
    solutions = impacting_solutions(oscillator, damper, below)
    signs = stability(growth_rate(fixed_points(solutions), oscillator, damper, below))
    quiet = np.min(np.abs(solutions.amplitude[signs == 1]))
    assert_allclose(quiet, free_solutions(oscillator, below).amplitude[0], rtol=1e-8)
