"""Coefficients of the Taylor series put back into the equations of motion."""

import math

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from numpy.testing import assert_allclose
from pointed import pointed

from impact_damper.parameters import Damper, Oscillator, pack
from impact_damper.widths import CONTACT_ORDER, FLIGHT_ORDER, instance

ANGLE = 0.7
LANE = 5
ORDERS = {"flight": FLIGHT_ORDER, "contact": CONTACT_ORDER}
LENGTH = max(ORDERS.values()) + 1
widths = pytest.mark.parametrize("lanes", [1, 16])
SIGNS = [(0.3, -1.1, 0.02, 0.9), (-1.7, 0.4, -0.01, -2.0), (0.0, 0.0, 0.0, 1.0)]


@pytest.fixture(scope="module")
def p():
    return pack(Oscillator(0.3, 1.3), Damper(0.2, 1.5, 0.6, 40.0), 1.9)


def drive(p):
    """Series of cos(W (t + t0)) from its derivatives, each a quarter turn on."""
    k = np.arange(LENGTH)
    factorials = np.array([math.factorial(i) for i in k], float)
    return Polynomial(p[0] ** k * np.cos(ANGLE + k * np.pi / 2) / factorials)


def filled(lanes, p, state, phase, orders=(FLIGHT_ORDER, CONTACT_ORDER)):
    """The array of an instance with the series of a step; every lane has a motion of its own."""
    module = instance(lanes, *orders)
    a = np.zeros((module.SIZE // lanes, lanes))
    for i in range(lanes):
        a[:7, i] = p
        a[7:11, i] = np.multiply(state, 1.0 + 0.1 * (i - LANE % lanes))
    a[module.SIDE // lanes] = 1.0
    a[module.Y2 // lanes] += p[3]
    a[module.COSINE // lanes], a[module.SINE // lanes] = math.cos(ANGLE), math.sin(ANGLE)
    flat = a.ravel()
    if lanes == 1:
        pointed(module.kept_series)(flat)
    pointed(getattr(module, f"{phase}_series"))(flat)
    return module, flat


def row(module, a, first, count):
    """Coefficients of a series in the lane looked at."""
    lanes = module.LANES
    return a[first + LANE % lanes :: lanes][:count].copy()


def state_series(lanes, p, state, phase):
    """Z1 and penetration (None in flight) as polynomials."""
    module, a = filled(lanes, p, state, phase)
    order = ORDERS[phase]
    x = Polynomial(row(module, a, module.X, order + 1))
    terms, q = [x.deriv(2)], None
    if phase == "contact":
        q = Polynomial(row(module, a, module.Q, order + 1))
        terms.append(contact_force(p, q))
    g = Polynomial(row(module, a, module.G, order - 1))
    vanishes(sum(terms, -g), order, size(*terms)[: order - 1])
    return x, q


def vanishes(polynomial, order, scale):
    """All coefficients of an equation vanish, up to the order to which the series holds."""
    coefficients = np.zeros(order - 1)
    known = polynomial.coef[: order - 1]
    coefficients[: len(known)] = known
    assert_allclose(coefficients / scale, 0, atol=1e-14)


def size(*polynomials):
    """Size of each coefficient, as the rounding errors scale with it."""
    width = LENGTH
    padded = [np.pad(np.abs(q.coef[:width]), (0, max(0, width - len(q.coef)))) for q in polynomials]
    return 1 + np.maximum.reduce(padded)


def contact_force(p, q):
    return p[4] * q + p[6] * q.deriv()


@widths
@pytest.mark.parametrize("state", SIGNS)
def test_flight_solves_the_duffing_equation(lanes, p, state):
    x, _ = state_series(lanes, p, state, "flight")
    terms = [x.deriv(2), p[1] * x.deriv(), p[2] * x, x**3, -drive(p)]
    vanishes(sum(terms, Polynomial([0.0])), FLIGHT_ORDER, size(*terms)[: FLIGHT_ORDER - 1])


@widths
@pytest.mark.parametrize("state", SIGNS)
def test_contact_solves_20_to_24(lanes, p, state):
    x, q = state_series(lanes, p, state, "contact")
    force = contact_force(p, q)
    terms = [x.deriv(2), p[1] * x.deriv(), p[2] * x, x**3, force, -drive(p)]
    order = CONTACT_ORDER
    vanishes(sum(terms, Polynomial([0.0])), order, size(*terms)[: order - 1])
    relative = [q.deriv(2), p[5] * force, -x.deriv(2)]
    vanishes(sum(relative, Polynomial([0.0])), order, size(*relative)[: order - 1])


@widths
@pytest.mark.parametrize("phase", ORDERS)
def test_tangents_solve_the_variational_equations(lanes, p, phase):
    x, _ = state_series(lanes, p, SIGNS[0], phase)
    module, a = filled(lanes, p, SIGNS[0], phase)
    order, columns = ORDERS[phase], module.TANGENTS
    lane = LANE % columns
    d = np.zeros((module.TANGENT_SIZE // columns, columns))
    d[:4, lane] = 0.5, -0.8, 0.3, 1.2
    # With several lanes a tangent belongs to the motion in its lane.
    d = d.ravel()
    pointed(getattr(module, f"{phase}_tangent_series"))(a, d)
    first, second = (
        Polynomial(d[columns * place + lane :: columns][: order + 1]) for place in (4, 4 + LENGTH)
    )
    force = contact_force(p, second) if phase == "contact" else Polynomial([0.0])
    terms = [first.deriv(2), p[1] * first.deriv(), p[2] * first, 3 * x**2 * first, force]
    vanishes(sum(terms, Polynomial([0.0])), order, size(*terms)[: order - 1])
    if phase == "contact":
        relative = [second.deriv(2), p[5] * force, -first.deriv(2)]
        vanishes(sum(relative, Polynomial([0.0])), order, size(*relative)[: order - 1])


@pytest.mark.parametrize("orders", [(10, 13), (17, 22)])
def test_series_of_other_orders_begin_alike(p, orders):
    for phase, order in zip(ORDERS, orders, strict=True):
        module, a = filled(1, p, SIGNS[0], phase, orders)
        standard, b = filled(1, p, SIGNS[0], phase)
        for name in ("X", "Q") if phase == "contact" else ("X",):
            found = row(module, a, getattr(module, name), order + 1)
            expected = row(standard, b, getattr(standard, name), order + 1)
            assert_allclose(found, expected, rtol=1e-13, atol=1e-15)
