"""Coefficients of the Taylor series put back into the equations of motion.

A lane holds one of several trajectories that a kernel integrates side by side. Z1 is the
displacement of the primary mass, W the forcing frequency, and T the time.
"""

import ast
import math
from fractions import Fraction

import numpy as np
import pytest
from helpers.pointed import part
from numpy.polynomial import Polynomial
from numpy.testing import assert_allclose
from references import equation
from references.equation import SPRINGS

from impact_damper.kernel import equation as recurrence
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
GIVEN = ("x0", "x1", "q0", "q1", "r1", "mobility", *packed.NAMES)
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


class Pair:
    """A pair of exact numbers. Operations act on both, as in `kernel.straight_lines.straight`."""

    def __init__(self, *numbers):
        self.numbers = numbers

    def __iter__(self):
        return iter(self.numbers)

    def __add__(self, other):
        return Pair(*(a + b for a, b in zip(self, other, strict=True)))

    def __mul__(self, other):
        return Pair(*(a * b for a, b in zip(self, other, strict=True)))

    def __rmul__(self, number):
        return Pair(*(number * a for a in self))


def exact(lines, numbers):
    """Return the results of lines of arithmetic, without rounding."""

    class Exactly(ast.NodeTransformer):
        def visit_Constant(self, node):
            return ast.parse(f"Fraction({node.value!r}).limit_denominator(10**6)").body[0].value

        def visit_Tuple(self, node):
            self.generic_visit(node)
            called = ast.Call(ast.Name("Pair", ast.Load()), node.elts, [])
            return called if isinstance(node.ctx, ast.Load) else node

    tree = Exactly().visit(ast.parse("\n".join(lines)))
    exec(compile(ast.fix_missing_locations(tree), "", "exec"), {"Pair": Pair}, numbers)
    return numbers


@pytest.mark.parametrize("phase", ORDERS)
@pytest.mark.parametrize("order", range(2, 28))
def test_recurrence_without_rounding(phase, order):
    """Compare the recurrence of every order with the independent equation, without rounding.

    Coefficients of the forcing and parameters are arbitrary fractions.
    """
    random = np.random.default_rng(order)
    draw = lambda: Fraction(int(random.integers(-9, 10)), 4)  # noqa: E731
    kept = [{name: draw() for name in "ehd"} for _ in range(order)]
    given = {name: draw() for name in GIVEN}
    given |= {"cosine": Fraction(1), "sine": Fraction(1), "Fraction": Fraction}
    given |= exact(recurrence.beginning(str), dict(given))
    for k, numbers in enumerate(kept):
        given |= {f"{name}{k}": number for name, number in numbers.items()}
    found = exact(recurrence.motion(order, phase, lambda k: []), dict(given))
    squares = {f"x{k}": found[f"x{k}"] for k in range(order)}
    squares = exact(recurrence.squares(order - 1), given | squares)
    cubed = {f"u{k}": squares[f"u{k}"] for k in range(order - 1)}
    tangent = exact(recurrence.tangent(order, phase, lambda k: []), given | cubed)
    p = [given[name] for name in packed.NAMES]
    x, dx = ([numbers[f"x{k}"] for k in range(order + 1)] for numbers in (found, tangent))
    slope = equation.slope(p, Polynomial(x))
    force, change = equation.spring(p, Polynomial(x)).coef, (slope * Polynomial(dx)).coef
    for k in range(order - 1):
        linear = given["STIFFNESS"] if k == 0 else 0
        assert cubed[f"u{k}"] == slope.coef[k] - linear
        for numbers, of, spring in ((found, x, force[k]), (tangent, dx, change[k])):
            a, b = (f"a{k - 1}", f"b{k - 1}") if k else ("x1", "q1")
            drive = kept[k]["e"] if numbers is found else 0
            g = drive - spring - kept[k]["h"] * numbers[a]
            assert numbers[f"g{k}"] == g
            wall = 0
            if phase == "contact":
                wall = given["r1"] * numbers[f"q{k}"] + kept[k]["d"] * numbers[b]
                b = g - given["mobility"] * wall
                assert numbers[f"b{k}"] == b and numbers[f"q{k + 2}"] == b / ((k + 1) * (k + 2))
            assert numbers[f"a{k}"] == g - wall
            assert of[k + 2] == (g - wall) / ((k + 1) * (k + 2))


def test_constant_series(p):
    module = instance(1)
    a = np.zeros(module.SIZE)
    a[: packed.COUNT] = p
    part(module, "constant_series")(a)
    k = np.arange(max(ORDERS.values()) - 1)
    signs = np.array([1, -1, -1, 1])[k % 4]
    factorials = np.array([math.factorial(i) for i in k], float)
    expected = {"E": signs * p[FREQUENCY] ** k / factorials}
    expected |= {"H": p[DAMPING] / np.maximum(k, 1), "D": p[DASHPOT] / np.maximum(k, 1)}
    for name, numbers in expected.items():
        assert_allclose(a[getattr(module, name) :][: len(k)], numbers, rtol=1e-14)


@widths
@pytest.mark.parametrize("orders", [(18, 23), (10, 13), (15, 20)])
@pytest.mark.parametrize("phase", ORDERS)
def test_tail_and_values(lanes, orders, phase):
    """Compare the last terms of the speeds' series, and the sums of all series, with NumPy."""
    module, order = instance(lanes, *orders), orders[list(ORDERS).index(phase)]
    random = np.random.default_rng(order)
    a = np.zeros((module.SIZE // lanes, lanes))
    names = ["X", "Q"] if phase == "contact" else ["X"]
    series = {}
    for name in names:
        series[name] = (
            random.uniform(-1, 1, (order + 1, lanes)) * 0.5 ** np.arange(order + 1)[:, None]
        )
        a[getattr(module, name) // lanes :][: order + 1] = series[name]
    time = random.uniform(0.3, 0.9, lanes)
    a[module.T // lanes] = a[module.LENGTH // lanes] = time
    searched = ["flight_slope"] if phase == "flight" else ["contact_bound", "contact_values"]
    flat = a.ravel()
    for each in searched:
        part(module, each)(flat)
    a = flat.reshape(a.shape)
    places = {"X": (module.Z1, module.Z1_SLOPE)}
    if phase == "contact":
        places["Q"] = module.DEPTH, module.DEPTH_SLOPE
    speeds = {name: Polynomial(c[:, 0]).deriv() for name, c in series.items()}
    last = [
        abs(speed.coef[k]) * time[0] ** k
        for speed in speeds.values()
        for k in (order - 2, order - 1)
    ]
    assert_allclose(a[module.TAIL // lanes, 0], max(last), rtol=1e-13)
    for name, (value, slope) in places.items():
        found = a[value // lanes, 0], a[slope // lanes, 0]
        expected = Polynomial(series[name][:, 0])(time[0]), speeds[name](time[0])
        assert_allclose(found, expected, rtol=1e-13)
