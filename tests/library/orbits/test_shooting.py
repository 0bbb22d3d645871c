"""Periodic orbits: residual, Liouville's theorem, multipliers; multiple shooting."""

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER, STARTS, polished_orbit
from numpy.testing import assert_allclose
from references import extended

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions.strobe_map import STROBE
from impact_damper.orbits import segments
from impact_damper.orbits.orbit import TURN
from impact_damper.orbits.shooting import find_orbit, polish, shoot


@pytest.fixture(scope="module", params=list(STARTS))
def orbit(request):
    known_orbit = polished_orbit(request.param)
    return find_orbit(known_orbit.parameters, known_orbit.state)


def test_multipliers_by_80_bit_arithmetic(orbit):
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    begin, length = orbit.phase / orbit.p[0], orbit.periods * TURN / orbit.p[0]
    run = extended.run(orbit.p, orbit.state, begin, [begin + length])
    assert_allclose(run.states[-1].astype(float), orbit.state, atol=1e-11)
    expected = np.linalg.eigvals(run.flow[: orbit.active, : orbit.active].astype(float))
    found = orbit.multipliers[: orbit.active]
    order = np.lexsort((-expected.imag.round(9), -np.abs(expected).round(9)))
    again = np.lexsort((-found.imag.round(9), -np.abs(found).round(9)))
    assert_allclose(found[again], expected[order], atol=1e-9)


# Damping of a hardening oscillator, damper, W, and a state at W T = pi/2 near a stable orbit.
# Rounding errors leave a residual of the orbit above 1e-12 of the state.
STIFF = [
    (0.005, Damper(0.0138, 8.0, 0.683, 3.2e5), 0.836, (0.15442, -2.4314, -3.1677, 3.2239)),
    (0.0289, Damper(0.0229, 8.73, 0.962, 6.54e5), 0.801, (0.19783, -2.2068, -0.68975, 3.6161)),
]


@pytest.mark.parametrize(("damping", "damper", "frequency", "state"), STIFF)
def test_an_orbit_between_stiff_walls_is_accepted(damping, damper, frequency, state):
    """In 80-bit arithmetic the motion from the orbit's state repeats."""
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    orbit = find_orbit(pack(Oscillator(damping, 1.0, 0.01), damper, frequency), state)
    assert orbit.converged
    begin = extended.Real(orbit.phase) / extended.Real(frequency)
    period = 2 * np.arccos(extended.Real(-1)) / extended.Real(frequency)
    end = extended.run(orbit.p, orbit.state, begin, [begin + period]).states[-1]
    assert_allclose(end.astype(float), orbit.state, rtol=0, atol=1e-10)


def test_without_an_orbit_the_result_has_not_converged():
    """Far from all orbits Newton's method does not converge, or finds an orbit of period 1."""
    orbit = find_orbit(pack(PAPER, Damper(0.12, 2.0), 2.0), np.array([1.0, 1.0, 0.0, 4.0]), 2)
    assert not orbit.converged or orbit.repeats_sooner()


def test_phase_leaves_a_contact():
    """From a state in contact, the orbit is found with a state at a later phase, in flight."""
    known_orbit = polished_orbit("design")
    reference = find_orbit(known_orbit.parameters, known_orbit.state)
    inside = reference.p[0] * (reference.contacts[1, 1] + 0.01)
    found = find_orbit(reference.p, reference.at(inside), 1, inside % TURN)
    assert found.converged and found.margin(found.phase) > 0.1
    assert found.is_same(reference)


# A state of a chaotic motion at W = 1.55 that nearly repeats after 12 forcing cycles.
RETURNING = (0.8012827850447051, -2.722120432592939, -0.22602951074616787, -3.910829733843885)


@pytest.fixture(scope="module")
def saddle():
    """Return an orbit of period 12 whose largest multiplier is about 1.6e11."""
    guess = shoot(pack(PAPER, DESIGN, 1.55), np.array(RETURNING), 12, STROBE)
    return polish(guess)


def exact_sums(factors):
    """Return for k = 1 to n the sum of all products of k eigenvalues of a product of matrices."""
    n = factors.shape[1]
    product = [[Fraction(i == j) for j in range(n)] for i in range(n)]
    for factor in factors:
        rows = [[Fraction(float(x)) for x in row] for row in factor]
        columns = list(zip(*product, strict=True))
        product = [[sum(map(Fraction.__mul__, row, col)) for col in columns] for row in rows]

    def determinant(chosen):
        if not chosen:
            return Fraction(1)
        matrix = [[product[i][j] for j in chosen] for i in chosen]
        value = Fraction(1)
        for k in range(len(matrix)):
            pivot = next(i for i in range(k, len(matrix)) if matrix[i][k])
            if pivot != k:
                matrix[k], matrix[pivot], value = matrix[pivot], matrix[k], -value
            value *= matrix[k][k]
            for i in range(k + 1, len(matrix)):
                share = matrix[i][k] / matrix[k][k]
                matrix[i] = [x - share * y for x, y in zip(matrix[i], matrix[k], strict=True)]
        return value

    return [
        sum(determinant(chosen) for chosen in combinations(range(n), k)) for k in range(1, n + 1)
    ]


def assert_eigenvalues(values, factors, rtol):
    """Compare for each k the sum of all products of k eigenvalues with the exact sum."""
    for k, exact in enumerate(exact_sums(factors), 1):
        found = sum(np.prod(chosen) for chosen in combinations(values, k))
        assert_allclose(found.real / float(exact), 1, rtol=rtol)


@pytest.mark.parametrize("seed", range(5))
def test_multipliers_of_a_product_that_loses_all_digits(seed):
    """The moduli of the product's eigenvalues range over some 60 decades."""
    random = np.random.default_rng(seed)
    factors = random.normal(size=(20, 4, 4)) * [30.0, 1.0, 0.1, 0.001]
    assert_eigenvalues(segments.multipliers(factors), factors, 1e-9)


def test_strongly_unstable_orbit_in_80_bit(saddle):
    """In 80 bits each segment ends where the next segment begins, and derivatives agree."""
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    chain, factors, largest, begun = saddle, [], 0.0, 0
    for k, state in enumerate(chain.states):
        begin, end = chain.phases[k : k + 2] / chain.p[FREQUENCY]
        run = extended.run(chain.p, state, begin, [end])
        ahead = chain.states[(k + 1) % len(chain.states)]
        assert np.max(np.abs(run.states[-1] - ahead)) < 2e-12
        assert_allclose(chain.factors[k], run.flow.astype(float), rtol=0, atol=1e-8)
        factors.append(run.flow.astype(float))
        largest, begun = max(largest, np.max(np.abs(run.extremes))), begun + run.begun
    assert_allclose(chain.record["maximum_displacement"], float(largest), rtol=1e-9)
    assert chain.record["contacts"] == begun / 12  # in a forcing cycle
    again = segments.multipliers(np.array(factors))
    assert_allclose(np.sort(abs(again)), np.sort(abs(saddle.multipliers)), rtol=1e-8)
