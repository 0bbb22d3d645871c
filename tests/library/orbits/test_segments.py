"""Multiple shooting compared with single shooting, exact arithmetic and 80-bit motions."""

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, IMPACTING, PAPER, polished_orbit
from numpy.testing import assert_allclose
from references import extended

from impact_damper.model.packed import CLEARANCE, FREQUENCY, pack
from impact_damper.orbits import segments
from impact_damper.orbits.orbit import STROBE
from impact_damper.orbits.shooting import find_orbit, polish, shoot

# A state of a chaotic motion at W = 1.55 that nearly repeats after 12 forcing cycles.
RETURNING = (0.8012827850447051, -2.722120432592939, -0.22602951074616787, -3.910829733843885)


@pytest.fixture(scope="module")
def saddle():
    """Return an orbit of period 12 whose largest multiplier is about 1.6e11."""
    guess = shoot(pack(PAPER, DESIGN, 1.55), np.array(RETURNING), 12, STROBE)
    return polish(guess)


def exact_sums(factors):
    """Return the sums of products of k eigenvalues, k = 1 to n, of a product of matrices."""
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
    """Compare the sums of products of the k largest eigenvalues with exact ones."""
    for k, exact in enumerate(exact_sums(factors), 1):
        found = sum(np.prod(chosen) for chosen in combinations(values, k))
        assert_allclose(found.real / float(exact), 1, rtol=rtol)


@pytest.mark.parametrize("seed", range(5))
def test_multipliers_of_a_product_that_loses_all_digits(seed):
    """Moduli of the eigenvalues of the product range over some 60 decades."""
    random = np.random.default_rng(seed)
    factors = random.normal(size=(20, 4, 4)) * [30.0, 1.0, 0.1, 0.001]
    assert_eigenvalues(segments.multipliers(factors), factors, 1e-9)


def test_a_complex_pair_between_real_multipliers_is_not_taken_for_two_real_ones():
    """The pair turns on a long ellipse, so that the lengths of its axes differ by more than 30."""
    generator = np.random.default_rng(1)
    for angle in generator.uniform(0.3, 2.8, 100):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        product = np.triu(generator.normal(size=(4, 4)), 1)
        product[[0, 3], [0, 3]] = 9e2, 1e-2
        product[1:3, 1:3] = 0.68 * turn * [[1, 30], [1 / 30, 1]]
        bases = [np.linalg.qr(generator.normal(size=(4, 4)))[0] for _ in range(4)]
        factors = [after @ before.T for before, after in zip(bases, bases[1:], strict=False)]
        factors.append(bases[0] @ product @ bases[-1].T)
        assert_eigenvalues(segments.multipliers(np.array(factors)), np.array(factors), 1e-8)


@pytest.mark.parametrize("name", IMPACTING)
@pytest.mark.parametrize("symmetric", [False, True])
def test_chain_is_the_orbit_of_single_shooting(name, symmetric, monkeypatch):
    """An orbit that amplifies little has the same properties if it is cut at every contact."""
    known = polished_orbit(name)
    single = find_orbit(known.parameters, known.state)
    if symmetric and single.record["asymmetry"] > 1e-6:
        pytest.skip("the orbit is not symmetric")
    if symmetric:
        single = shoot(single.p, single.state, 1, single.phase, symmetric=True)
    monkeypatch.setattr(segments, "AMPLIFIED", 0.0)
    chain = polish(single)
    assert len(chain.states) >= len(single.contacts) // (2 if symmetric else 1)
    assert chain.converged and chain.sequence == single.sequence
    for phase in single.phase + np.linspace(7, 19, 9):
        assert_allclose(chain.at(phase), single.at(phase), atol=1e-10)
    for power in (1, 2, 3, 4):  # sums of powers do not depend on the order of the multipliers
        sums = [np.sum(orbit.multipliers**power) for orbit in (chain, single)]
        assert_allclose(sums[0], sums[1], atol=1e-9)
    assert_allclose(chain.touching, single.touching, rtol=1e-9)
    assert_allclose(np.sort(chain.contacts[:, 3]), np.sort(single.contacts[:, 3]), atol=1e-9)
    for name, value in zip(single.record.dtype.names, single.record, strict=True):
        if name in ("maximum_displacement", "contacts", "asymmetry"):
            assert_allclose(chain.record[name], value, atol=1e-9)
        if name.startswith("harmonic"):
            assert_allclose(chain.record[name], value, atol=1e-9)


def test_strongly_unstable_orbit_in_80_bit(saddle):
    """In 80-bit arithmetic each segment ends where the next begins, and has the same derivative."""
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    chain, factors = saddle, []
    for k, state in enumerate(chain.states):
        begin, end = chain.phases[k : k + 2] / chain.p[FREQUENCY]
        run = extended.run(chain.p, state, begin, [end])
        ahead = chain.states[(k + 1) % len(chain.states)]
        assert np.max(np.abs(run.states[-1] - ahead)) < 2e-12
        assert_allclose(chain.factors[k], run.flow.astype(float), rtol=0, atol=1e-8)
        factors.append(run.flow.astype(float))
    again = segments.multipliers(np.array(factors))
    assert_allclose(np.sort(abs(again)), np.sort(abs(saddle.multipliers)), rtol=1e-8)


def test_turns_are_the_extrema_of_a_sampled_motion(saddle):
    turns, samples = saddle.turns(), np.linspace(*saddle.phases[[0, -1]], 4000)
    for _, phase, _, height in turns:
        _, _, place, speed = saddle.at(phase)
        assert abs(speed) < 1e-8
        assert_allclose(height, abs(place) - saddle.p[CLEARANCE], rtol=0, atol=1e-11)
    speeds = np.array([saddle.at(phase)[3] for phase in samples])
    assert np.sum(speeds[:-1] * speeds[1:] < 0) == len(turns)
