"""Hill's method against the exact variational equations and Liouville's theorem."""

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper
from impact_damper.orbits.shooting import find_orbit
from impact_damper.theory import hill
from impact_damper.theory.many_harmonics import Balance, refine, single_term, solve, state_of

CASES = {"free": (None, 1.9, 21), "elastic": (DESIGN, 2.0, 255), "inelastic": (INELASTIC, 2.0, 255)}


@pytest.fixture(
    scope="module",
    params=[
        "free",
        pytest.param("elastic", marks=pytest.mark.thorough),
        pytest.param("inelastic", marks=pytest.mark.thorough),
    ],
)
def case(request):
    damper, frequency, highest = CASES[request.param]
    steps = [n for n in (1, 3, 7, 15, 31, 63, 127, 255) if n < highest] + [highest]
    balances = [Balance(PAPER, damper, frequency, n) for n in steps]
    solution = refine(balances, single_term(PAPER, damper, frequency))[-1]
    return solution, find_orbit(pack(PAPER, damper, frequency), state_of(solution))


def test_multipliers_are_the_exact_ones(case):
    solution, exact = case
    found = hill.exponents(solution)
    assert found.status == "found"
    multipliers = found.multipliers(2 * np.pi / solution.balance.frequency)
    away = np.abs(multipliers[:, None] - exact.multipliers[: exact.active]).min(axis=1)
    assert np.max(away) < (1e-10 if solution.balance.damper is None else 1e-3)


def test_eigenvalues_near_zero_are_those_of_the_whole_problem(monkeypatch):
    """The iteration for eigenvalues near zero, used for large problems, against all eigenvalues."""
    solution = solve(Balance(PAPER, INELASTIC, 2.0, 15), single_term(PAPER, INELASTIC, 2.0))
    whole = hill.exponents(solution).values
    monkeypatch.setattr(hill, "DENSE", 0)
    assert hill.exponents(solution).values == pytest.approx(whole, abs=1e-10)


def test_all_harmonics_give_the_same_multipliers():
    """With all harmonics in the disturbances the multipliers are the same as with odd ones."""
    odd = solve(Balance(PAPER, None, 1.9, 15), single_term(PAPER, None, 1.9))
    spread = np.zeros((1, 16), complex)
    spread[:, 1::2] = odd.coefficients
    whole = solve(Balance(PAPER, None, 1.9, 15, symmetric=False), spread)
    period = 2 * np.pi / 1.9
    assert np.sort_complex(hill.exponents(whole).multipliers(period)) == pytest.approx(
        np.sort_complex(hill.exponents(odd).multipliers(period)), abs=1e-6
    )


@pytest.mark.thorough
def test_the_orbit_must_be_of_the_same_truncation():
    """With N harmonics the errors fall as N^-4 if the contacts are those of the same solution.

    With the contacts of the exact orbit they fall as N^-3 only.
    """
    damper = Damper(0.12, 2.0, contact_stiffness=200.0)
    highest = [1, 3, 7, 15, 31, 63, 127, 255, 511]
    balances = [Balance(PAPER, damper, 2.0, n) for n in highest]
    solutions = refine(balances, single_term(PAPER, damper, 2.0))
    exact, multipliers = solutions[-1], hill.exponents(solutions[-1]).multipliers(np.pi)
    rows = exact.balance.contacts(exact.coefficients)

    def error(solution):
        away = hill.exponents(solution).multipliers(np.pi)[:, None] - multipliers
        return np.max(np.min(np.abs(away), axis=1))

    class Frozen(Balance):
        def contacts(self, coefficients):
            return rows

    frozen, own = [], []
    for solution in solutions[6:8]:
        balance = Frozen(PAPER, damper, 2.0, solution.balance.highest)
        kept = exact.coefficients[:, : len(balance.harmonics)]
        frozen.append(error(solution._replace(balance=balance, coefficients=kept)))
        own.append(error(solution))
    assert np.log2(frozen[0] / frozen[1]) == pytest.approx(3, abs=0.3)
    assert max(own) < 1e-3 * min(frozen)
