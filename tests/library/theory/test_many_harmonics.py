"""Harmonic balance against equations (7), sampled forces, differences, and exact orbits.

Z2 is the displacement of the primary mass relative to the loose mass, W the forcing frequency, and
T the time. Numbers in brackets are equations of the paper.
"""

from dataclasses import replace

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Oscillator
from impact_damper.motions import strobe_map
from impact_damper.theory import fourier, single_harmonic
from impact_damper.theory.many_harmonics import Balance, refine, single_term, solve, state_of

BALANCES = {
    "free": Balance(Oscillator(0.3, 0.7), None, 1.3, 5),
    "elastic": Balance(PAPER, DESIGN, 2.0, 9),
    "inelastic": Balance(PAPER, INELASTIC, 2.0, 9),
    "asymmetric": Balance(PAPER, INELASTIC, 2.0, 6, period=2, symmetric=False),
}


@pytest.fixture(params=list(BALANCES))
def balance(request):
    return BALANCES[request.param]


def arbitrary(balance, seed=1):
    """Return coefficients of random series, with a Z2 that touches both walls."""
    generator = np.random.default_rng(seed)
    count = len(balance.harmonics)
    shape = (1 if balance.damper is None else 2, count)
    series = generator.standard_normal(shape) + 1j * generator.standard_normal(shape)
    series /= 4.0 * (1 + balance.harmonics) ** 2
    if balance.damper is not None:
        series[1, balance.harmonics == balance.period] = 0.6 * balance.damper.clearance
    return balance.to_complex(balance.to_real(series))


@pytest.mark.parametrize("name", ["elastic", "inelastic", "asymmetric"])
def test_residual_is_that_of_the_sampled_equations(name):
    """The forces as the paper writes them, (22) to (24), at many samples."""
    balance = BALANCES[name]
    series, k, damper = arbitrary(balance), balance.harmonics, balance.damper
    count = 2**17
    nu = balance.frequency / balance.period
    angle = 2 * np.pi * np.arange(count) / count
    (x, v, a), (z, w, b) = (
        [fourier.samples(each * (1j * k * nu) ** n, k, count) for n in range(3)] for each in series
    )
    touching = np.abs(z) > damper.clearance
    force = damper.contact_stiffness * (z - np.sign(z) * damper.clearance) + damper.dashpot * w
    force = np.where(touching, force, 0)
    own = balance.oscillator
    first = a + own.damping * v + own.linear_frequency**2 * x + x**3 + force
    first -= np.cos(balance.period * angle)
    second = b - a + force / damper.mass_ratio
    sampled = np.fft.rfft([first, second])[:, k] / count
    found = balance.residual(series, balance.contacts(series))
    assert found == pytest.approx(sampled, abs=1e-4 * np.max(np.abs(found)))


def test_one_term_is_equations_7():
    first = single_harmonic.impacting_solutions(PAPER, DESIGN, 2.0)
    balance = Balance(PAPER, DESIGN, 2.0, 1)
    for amplitude, relative, phase in zip(*first, strict=True):
        series = np.array([[amplitude], [relative]]) * np.exp(1j * phase) / 2
        left = balance.residual(series, balance.contacts(series))
        assert np.max(np.abs(left)) < 1e-11
        assert solve(balance, series).coefficients == pytest.approx(series, abs=1e-12)


@pytest.mark.thorough
@pytest.mark.parametrize("damper", [DESIGN, INELASTIC])
def test_approaches_the_exact_orbit(damper):
    balances = [Balance(PAPER, damper, 2.0, n) for n in (1, 3, 7, 15, 31, 63, 127, 255)]
    solutions = refine(balances, single_term(PAPER, damper, 2.0))
    assert all(each.status == "converged" for each in solutions)
    state = state_of(solutions[-1])
    orbit = state.copy()
    found, _, _ = strobe_map.polish(pack(PAPER, damper, 2.0), orbit, 1, 0.1, 1e-13)
    assert found
    assert state == pytest.approx(orbit, abs=5e-3 if damper is INELASTIC else 5e-4)


def test_subharmonic_of_the_free_oscillator():
    """A motion with odd harmonics of W/3 repeats after three forcing cycles and not after one."""
    start = np.array([[1.2 * np.exp(0.3j), 0.0]])
    for phase in np.arange(0, 2 * np.pi, 0.25):
        start = np.array([[0.45 * np.exp(1j * phase), 0.1]])
        found = solve(Balance(PAPER, None, 1.9, 45, period=3), start)
        if found.status == "converged" and abs(found.coefficients[0, 0]) > 0.1:
            break
    balance = found.balance
    angle = np.pi / 2 / 3
    state = np.array(
        [fourier.value(found.coefficients[0], balance.harmonics, angle, n) * (1.9 / 3) ** n
         for n in (0, 1)]
    )  # fmt: skip
    p = pack(PAPER, None, 1.9)
    end, _, _ = strobe_map.period_map(p, np.tile(state, 2), 3, 1e-13)
    assert end[:2] == pytest.approx(state, abs=1e-10)
    once, _, _ = strobe_map.period_map(p, np.tile(state, 2), 1, 1e-13)
    assert np.max(np.abs(once[:2] - state)) > 0.1


def test_failures_say_so():
    first = single_term(PAPER, DESIGN, 2.0)
    assert solve(Balance(PAPER, DESIGN, 2.0, 15), first, iterations=2).status == "iteration_limit"
    lost = solve(Balance(PAPER, replace(DESIGN, contact_stiffness=1e8), 2.0, 63), first)
    assert lost.status in ("stalled", "iteration_limit")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"highest": 4}, "must be odd"),
        ({"period": 2}, "must be odd"),
        ({"highest": 0}, "highest = 0"),
        ({"period": 3, "highest": 1}, "highest = 1"),
        ({"frequency": -1.0}, "frequency"),
    ],
)
def test_wrong_arguments_are_named(change, message):
    given = {"oscillator": PAPER, "damper": DESIGN, "frequency": 2.0, "highest": 5} | change
    with pytest.raises(ValueError, match=message):
        Balance(**given)
