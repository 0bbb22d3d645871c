"""Coefficients of the Taylor series put back into the equations of motion."""

import math

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from numpy.testing import assert_allclose

from impact_damper import series
from impact_damper.parameters import Damper, Oscillator, pack

ANGLE = 0.7
SIGNS = [(0.3, -1.1, 0.02, 0.9), (-1.7, 0.4, -0.01, -2.0), (0.0, 0.0, 0.0, 1.0)]


@pytest.fixture(scope="module")
def p():
    return pack(Oscillator(0.3, 1.3), Damper(0.2, 1.5, 0.6, 40.0), 1.9)


def drive(p):
    """Series of cos(W (t + t0)) from its derivatives, each a quarter turn on."""
    k = np.arange(series.LENGTH)
    factorials = np.array([math.factorial(i) for i in k], float)
    return Polynomial(p[0] ** k * np.cos(ANGLE + k * np.pi / 2) / factorials)


def state_series(p, state, contact):
    """Z1, penetration (None in flight) and Z1^2 as polynomials."""
    x, q, square = (np.zeros(series.LENGTH) for _ in range(3))
    turn = math.cos(ANGLE), math.sin(ANGLE)
    if contact:
        series.contact(p, *turn, *state, x, q, square)
        return Polynomial(x), Polynomial(q), square
    series.flight(p, *turn, *state[:2], x, square)
    return Polynomial(x[: series.FLIGHT_ORDER + 1]), None, square


def vanishes(polynomial, order, scale):
    """All coefficients of an equation vanish, up to the order to which the series holds."""
    coefficients = np.zeros(order - 1)
    known = polynomial.coef[: order - 1]
    coefficients[: len(known)] = known
    assert_allclose(coefficients / scale, 0, atol=1e-14)


def size(*polynomials):
    """Size of each coefficient, as the rounding errors scale with it."""
    width = series.LENGTH
    padded = [np.pad(np.abs(q.coef[:width]), (0, max(0, width - len(q.coef)))) for q in polynomials]
    return 1 + np.maximum.reduce(padded)


def contact_force(p, q):
    return p[4] * q + p[6] * q.deriv()


@pytest.mark.parametrize("state", SIGNS)
def test_flight_solves_the_duffing_equation(p, state):
    x, _, square = state_series(p, state, contact=False)
    terms = [x.deriv(2), p[1] * x.deriv(), p[2] * x, x**3, -drive(p)]
    order = series.FLIGHT_ORDER
    vanishes(sum(terms, Polynomial([0.0])), order, size(*terms)[: order - 1])
    assert_allclose(square[: order - 1], (x**2).coef[: order - 1], rtol=1e-13, atol=1e-15)


@pytest.mark.parametrize("state", SIGNS)
def test_contact_solves_20_to_24(p, state):
    x, q, _ = state_series(p, state, contact=True)
    force = contact_force(p, q)
    terms = [x.deriv(2), p[1] * x.deriv(), p[2] * x, x**3, force, -drive(p)]
    order = series.CONTACT_ORDER
    vanishes(sum(terms, Polynomial([0.0])), order, size(*terms)[: order - 1])
    relative = [q.deriv(2), p[5] * force, -x.deriv(2)]
    vanishes(sum(relative, Polynomial([0.0])), order, size(*relative)[: order - 1])


@pytest.mark.parametrize("contact", [False, True])
def test_tangents_solve_the_variational_equations(p, contact):
    x, _, square = state_series(p, SIGNS[0], contact)
    start = 0.5, -0.8, 0.3, 1.2
    first, second = np.zeros(series.LENGTH), np.zeros(series.LENGTH)
    order = series.CONTACT_ORDER if contact else series.FLIGHT_ORDER
    if contact:
        series.contact_tangent(p, square, *start, first, second)
    else:
        series.flight_tangent(p, square, *start[:2], first)
    dx, dq = Polynomial(first), Polynomial(second)
    force = contact_force(p, dq)
    terms = [dx.deriv(2), p[1] * dx.deriv(), p[2] * dx, 3 * x**2 * dx, force]
    vanishes(sum(terms, Polynomial([0.0])), order, size(*terms)[: order - 1])
    if contact:
        relative = [dq.deriv(2), p[5] * force, -dx.deriv(2)]
        vanishes(sum(relative, Polynomial([0.0])), order, size(*relative)[: order - 1])
