"""Coefficients of the Taylor series put back into the equations of motion.

A lane holds one of several trajectories that a kernel integrates side by side. Z1 is the
displacement of the primary mass, W the forcing frequency, and T the time.
"""

import math

import numpy as np
import pytest
from helpers.pointed import part
from numpy.polynomial import Polynomial
from numpy.testing import assert_allclose
from references import equation
from references.equation import SPRINGS

from impact_damper.kernel.instances import CONTACT_ORDER, FLIGHT_ORDER, instance
from impact_damper.model import packed
from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    DAMPING,
    DASHPOT,
    FREQUENCY,
    INVERSE_MASS_RATIO,
    STIFFNESS,
    pack,
)
from impact_damper.model.parameters import Damper

ANGLE = 0.7
LANE = 5
ORDERS = {"flight": FLIGHT_ORDER, "contact": CONTACT_ORDER}
LENGTH = max(ORDERS.values()) + 1
widths = pytest.mark.parametrize("lanes", [1, 16])
SIGNS = [(0.3, -1.1, 0.02, 0.9), (-1.7, 0.4, -0.01, -2.0), (0.0, 0.0, 0.0, 1.0)]


@pytest.fixture(scope="module", params=SPRINGS)
def p(request):
    return pack(SPRINGS[request.param], Damper(0.2, 1.5, 0.6, 40.0), 1.9)


def drive(p):
    """Return the Taylor series of the forcing, whose phase at t = 0 is ANGLE."""
    k = np.arange(LENGTH)
    factorials = np.array([math.factorial(i) for i in k], float)
    return Polynomial(
        equation.amplitude(p) * p[FREQUENCY] ** k * np.cos(ANGLE + k * np.pi / 2) / factorials
    )


def filled(lanes, p, state, phase):
    """Return the kernel for a number of lanes, and its array filled with the series of a step.

    Every lane has a different motion.
    """
    module = instance(lanes)
    a = np.zeros((module.SIZE // lanes, lanes))
    for i in range(lanes):
        a[: packed.COUNT, i] = np.multiply(p, 1.0 + 0.01 * (i - LANE % lanes))
        a[packed.COUNT : packed.COUNT + 4, i] = np.multiply(state, 1.0 + 0.1 * (i - LANE % lanes))
    a[module.SIDE // lanes] = 1.0
    a[module.Y2 // lanes] += p[CLEARANCE]
    for i in range(lanes):
        size = equation.amplitude(a[: packed.COUNT, i])
        a[module.COSINE // lanes, i] = size * math.cos(ANGLE)
        a[module.SINE // lanes, i] = size * math.sin(ANGLE)
    flat = a.ravel()
    if lanes == 1:
        part(module, "constant_series")(flat)
    part(module, f"{phase}_series")(flat)
    return module, flat


def row(module, a, first, count):
    """Return the coefficients of a series in the lane LANE."""
    lanes = module.LANES
    return a[first + LANE % lanes :: lanes][:count].copy()


def state_series(lanes, p, state, phase):
    """Return Z1 and the penetration (None in flight) as polynomials."""
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
    """Assert that all coefficients of an equation vanish, up to the order of the series."""
    coefficients = np.zeros(order - 1)
    known = polynomial.coef[: order - 1]
    coefficients[: len(known)] = known
    assert_allclose(coefficients / scale, 0, atol=3e-14)


def size(*polynomials):
    """Return the largest modulus of each coefficient, plus 1, as the scale of rounding errors."""
    width = LENGTH
    padded = [np.pad(np.abs(q.coef[:width]), (0, max(0, width - len(q.coef)))) for q in polynomials]
    return 1 + np.maximum.reduce(padded)


def contact_force(p, q):
    return p[CONTACT_STIFFNESS] * q + p[DASHPOT] * q.deriv()


def spring(p, x):
    """Return the linear and the nonlinear part of the spring's force, which may cancel."""
    linear = p[STIFFNESS] * x
    return linear, equation.spring(p, x) - linear


@widths
@pytest.mark.parametrize("state", SIGNS)
def test_flight_solves_the_duffing_equation(lanes, p, state):
    x, _ = state_series(lanes, p, state, "flight")
    terms = [x.deriv(2), p[DAMPING] * x.deriv(), *spring(p, x), -drive(p)]
    vanishes(sum(terms, Polynomial([0.0])), FLIGHT_ORDER, size(*terms)[: FLIGHT_ORDER - 1])


@widths
@pytest.mark.parametrize("state", SIGNS)
def test_contact_solves_20_to_24(lanes, p, state):
    x, q = state_series(lanes, p, state, "contact")
    force = contact_force(p, q)
    terms = [
        x.deriv(2),
        p[DAMPING] * x.deriv(),
        *spring(p, x),
        force,
        -drive(p),
    ]
    order = CONTACT_ORDER
    vanishes(sum(terms, Polynomial([0.0])), order, size(*terms)[: order - 1])
    relative = [q.deriv(2), p[INVERSE_MASS_RATIO] * force, -x.deriv(2)]
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
    part(module, f"{phase}_squares")(a)
    part(module, f"{phase}_tangent_series")(a, d)
    first, second = (
        Polynomial(d[columns * place + lane :: columns][: order + 1]) for place in (4, 4 + LENGTH)
    )
    force = contact_force(p, second) if phase == "contact" else Polynomial([0.0])
    terms = [
        first.deriv(2),
        p[DAMPING] * first.deriv(),
        equation.slope(p, x) * first,
        force,
    ]
    vanishes(sum(terms, Polynomial([0.0])), order, size(*terms)[: order - 1])
    if phase == "contact":
        relative = [second.deriv(2), p[INVERSE_MASS_RATIO] * force, -first.deriv(2)]
        vanishes(sum(relative, Polynomial([0.0])), order, size(*relative)[: order - 1])
