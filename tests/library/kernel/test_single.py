"""Events against exact arithmetic, steps against their order, tangents against differences."""

from fractions import Fraction

import numpy as np
import pytest
from helpers.known_orbits import PAPER
from helpers.pointed import part
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

from impact_damper.kernel import single
from impact_damper.kernel.instances import FLIGHT_ORDER, SERIES, SINGLE, instance
from impact_damper.model.packed import pack

# Bound on the rounding error of the polynomials in this module. If a penetration exceeds this
# bound, a search has missed the contact.
HAIR = Fraction(1, 10**12)
DEGREE = 7
coefficients = st.lists(st.integers(-200, 200), min_size=2, max_size=DEGREE + 1)
examples = settings(max_examples=100)
widths = pytest.mark.parametrize("lanes", [1, 16])
expected = pytest.mark.parametrize("expecting", [(), ("expect_contact",)], ids=["any", "expected"])


def evaluate(c, t):
    value = Fraction(0)
    for a in reversed(c):
        value = value * t + a
    return value


def sturm_chain(c):
    """Return Sturm's chain of a polynomial with rational coefficients, lowest power first."""

    def trimmed(c):
        while c and c[-1] == 0:
            c = c[:-1]
        return [a / abs(c[-1]) for a in c]

    chain = [trimmed(c), trimmed([k * a for k, a in enumerate(c)][1:])]
    while len(chain[-1]) > 0:
        left, divisor = list(chain[-2]), chain[-1]
        while len(left) >= len(divisor):
            factor = left[-1] / divisor[-1]
            for k in range(len(divisor)):
                left[len(left) - len(divisor) + k] -= factor * divisor[k]
            left.pop()
        chain.append(trimmed([-a for a in left]))
    return chain[:-1]


def roots_within(c, end):
    """Return the number of different real roots in (0, end], by Sturm's theorem."""
    chain = sturm_chain([Fraction(a) for a in c])

    def changes(t):
        signs = [s for s in (evaluate(link, t) for link in chain) if s != 0]
        return sum((a > 0) != (b > 0) for a, b in zip(signs, signs[1:], strict=False))

    return changes(Fraction(0)) - changes(Fraction(end))


def found(lanes, searched, series_given, length, **numbers):
    """Return the time at which a search ends, whether it found an event, and the wall.

    `searched` names the kernels that are called. A lane holds one trajectory. With several lanes
    one lane has the given series, and the other lanes have similar series.
    """
    module = instance(lanes)
    a = np.zeros((module.SIZE // lanes, lanes))
    rows = {name: getattr(module, name) // lanes for name in [*SINGLE, *SERIES]}
    lane = lanes // 3
    for i in range(lanes):
        # The other lanes have the initial state of this lane, but other higher coefficients.
        for name, c in series_given(1.0 if i == lane else 1.0 + 0.1 * i).items():
            a[rows[name] : rows[name] + len(c), i] = c
    for name, number in (numbers | {"LENGTH": length, "T": length}).items():
        a[rows[name]] = number
    flat = a.ravel()
    for each in searched:
        part(module, each)(flat)
    return a[rows["T"], lane], a[rows["MODE"], lane] == module.MET, a[rows["WALL"], lane]


def first_contact(lanes, c, offset, drift, clearance, length, expecting=()):
    """Return time and wall (0 for none) of the first contact, with Z2 = Z1 + offset + drift t."""

    def series_given(bend):
        x = Polynomial([*c[:2], *(bend * np.array(c[2:]))])
        return {"X": x.coef, "G": x.deriv(2).coef}

    c = [*c, *[0.0] * (3 - len(c))]
    state = {"Y0": c[0], "Y1": c[1], "Y2": c[0] + offset, "Y3": c[1] + drift}
    searched = [*expecting, "flight_slope", "flight_change", "find_contact"]
    t, met, wall = found(lanes, searched, series_given, length, CLEARANCE=clearance, **state)
    return t, int(wall) if met else 0


def check_contact(lanes, c, offset, drift, clearance, length, expecting=()):
    """Assert that the distance to a wall is zero at the time found, and not negative before."""
    t, side = first_contact(lanes, c, offset, drift, clearance, length, expecting)
    path = [Fraction(float(a)) for a in [*c, *[0.0] * (2 - len(c))]]
    path[0] += Fraction(offset)
    path[1] += Fraction(drift)
    for sign in (1, -1):
        wall = [sign * a for a in path]
        wall[0] -= Fraction(clearance) + HAIR
        assert roots_within(wall, t) == 0
    if side == 0:
        assert 0 < t <= length if expecting else t == length
    else:
        assert 0 <= t <= length
        assert abs(side * evaluate(path, Fraction(t)) - Fraction(clearance)) < HAIR
        slope = evaluate([k * a for k, a in enumerate(path)][1:], Fraction(t))
        assert side * slope > -Fraction(1, 10**5)
    return t, side


@pytest.mark.thorough
@widths
@expected
@examples
@given(coefficients, st.integers(-64, 64), st.integers(-128, 128), st.floats(0.1, 3.0))
def test_first_contact_of_random_polynomials(lanes, expecting, c, offset, drift, length):
    c = [a / 64 for a in c]
    offset, drift = offset / 64, drift / 64
    check_contact(lanes, c, offset, drift, abs(c[0] + offset) + 0.25, length, expecting)


@pytest.mark.thorough
@widths
@expected
@examples
@given(coefficients, st.integers(2, 14), st.booleans())
def test_first_contact_of_grazing_polynomials(lanes, expecting, c, exponent, beyond):
    """The wall is close to the largest |Z2|: the distance to the wall has nearly a double root."""
    c = [0.0, *(a / 64 for a in c)]
    t = np.linspace(0, 1, 10001)
    largest = np.max(np.abs(Polynomial(c)(t)))
    if largest < 0.1:
        return
    clearance = largest * (1 + (1 if beyond else -1) * 10.0**-exponent)
    check_contact(lanes, c, 0.0, 0.0, clearance, 1.0, expecting)


def integrated(p, state, side, length, steps, tolerance):
    """Return the state after `steps` equal steps over the time `length`, without an event."""
    y, work = np.array(state), single.workspace()
    for i in range(steps):
        taken, side = single.step(p, y, side, i * length / steps, length / steps, tolerance, work)
        assert taken == length / steps
    return y


def test_order_of_flight_steps():
    """Halving the step divides the error by 2 to the power of the order of the series."""
    p = pack(PAPER, None, 2.0)
    state = [1.5, 0.5, 1.5, 0.5]
    exact = integrated(p, state, 0, 2.4, 24, 1.0)
    errors = [np.max(np.abs(integrated(p, state, 0, 2.4, n, 1e15) - exact)) for n in (3, 4, 6)]
    orders = np.log(np.divide(errors[:-1], errors[1:])) / np.log([4 / 3, 3 / 2])
    assert np.all(orders > FLIGHT_ORDER - 2)
