"""Multiple shooting compared with single shooting, exact arithmetic and 80-bit motions.

In multiple shooting an orbit is a chain of segments. Factors are the derivatives of the segments.

W is the forcing frequency.
"""

import math
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
from impact_damper.orbits.shooting import find_orbit, orbit_of, polish, shoot

# A state of a chaotic motion at W = 1.55 that nearly repeats after 12 forcing cycles.
RETURNING = (0.8012827850447051, -2.722120432592939, -0.22602951074616787, -3.910829733843885)


@pytest.fixture(scope="module")
def saddle():
    """Return an orbit of period 12 whose largest multiplier is about 1.6e11."""
    guess, _ = shoot(pack(PAPER, DESIGN, 1.55), np.array(RETURNING), 12, STROBE)
    return polish(guess)


def exact_sums(factors):
    """Return the sums of products of k eigenvalues, k = 1 to n, of a product of matrices.

    The principal minors of the product are computed in fractions, without rounding.
    """
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


def test_multipliers_of_similar_modulus():
    """The product has a conjugate pair of eigenvalues between a large and a small real one."""
    random = np.random.default_rng(1)
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    middle = np.zeros((4, 4))
    middle[0, 0], middle[1:3, 1:3], middle[3, 3] = 50.0, turn, 0.01
    bases = random.normal(size=(6, 4, 4))
    factors = np.array(
        [np.roll(bases, -1, 0)[k] @ middle @ np.linalg.inv(bases[k]) for k in range(6)]
    )
    found = segments.multipliers(factors)
    assert_allclose(abs(found), [50.0**6, 1, 1, 1e-12], rtol=1e-8)
    assert_allclose(found[[1, 2]].sum(), 2 * np.cos(6 * np.angle(0.6 + 0.8j)), rtol=1e-9)


@pytest.mark.parametrize("name", IMPACTING)
@pytest.mark.parametrize("symmetric", [False, True])
def test_chain_is_the_orbit_of_single_shooting(name, symmetric, monkeypatch):
    """An orbit that amplifies little has the same properties if it is cut at every contact."""
    known = polished_orbit(name)
    single = find_orbit(known.parameters, known.state)
    if symmetric and single.record["asymmetry"] > 1e-6:
        pytest.skip("the orbit is not symmetric")
    if symmetric:
        single, _ = shoot(single.p, single.state, 1, single.phase, symmetric=True)
    monkeypatch.setattr(segments, "AMPLIFIED", 0.0)
    chain = polish(single)
    assert len(chain.chain.states) >= len(single.contacts) // (2 if symmetric else 1)
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


def test_laws_of_a_strongly_unstable_orbit(saddle):
    assert abs(saddle.multipliers[0]) > 1e10
    assert saddle.converged and saddle.residual < 1e-12 * np.abs(saddle.chain.states).max()
    assert saddle.liouville_error < 1e-9
    assert_eigenvalues(saddle.multipliers, saddle.factors, 1e-9)
    assert not any(saddle.margin(phase) < segments.CLEAR / 2 for phase in saddle.chain.phases[:-1])


def test_strongly_unstable_orbit_in_80_bit(saddle):
    """In 80-bit arithmetic each segment ends where the next begins, and has the same derivative.

    The multipliers from these derivatives are the same too.
    """
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    chain, factors = saddle.chain, []
    for k, state in enumerate(chain.states):
        begin, end = chain.phases[k : k + 2] / chain.p[FREQUENCY]
        run = extended.run(chain.p, state, begin, [end])
        ahead = chain.states[(k + 1) % len(chain.states)]
        assert np.max(np.abs(run.states[-1] - ahead)) < 2e-12
        assert_allclose(chain.factors[k], run.flow.astype(float), rtol=0, atol=1e-8)
        factors.append(run.flow.astype(float))
    again = segments.multipliers(np.array(factors))
    assert_allclose(np.sort(abs(again)), np.sort(abs(saddle.multipliers)), rtol=1e-8)


def test_mirrored_chain_is_a_chain():
    """The mirror image of an unsymmetric orbit, half a forcing cycle later, is an orbit too."""
    guess, _ = shoot(pack(PAPER, DESIGN, 1.55), np.array(RETURNING), 12, STROBE)
    chain = polish(guess).chain
    mirrored = segments.chain_of(chain.p, chain.phases + math.pi, -chain.states, 1)
    assert orbit_of(mirrored, 12).converged
    assert_allclose(mirrored.factors, chain.factors, atol=1e-8)


@pytest.mark.parametrize("angle", np.linspace(0.05, 3.0, 12))
def test_a_complex_pair_is_never_taken_for_two_real_multipliers(angle):
    """In a sheared basis the two columns of the pair grow by very different factors."""
    rng, shear = np.random.default_rng(1), 100.0
    cosine, sine = 0.24 * math.cos(angle), 0.24 * math.sin(angle)
    product = np.diag([1250.0, cosine, cosine, 7e-4])
    product[1, 2], product[2, 1] = -shear * sine, sine / shear
    basis = np.linalg.qr(rng.normal(size=(4, 4)))[0]
    first, second = rng.normal(size=(2, 4, 4))
    last = basis @ product @ basis.T @ np.linalg.inv(second @ first)
    found = segments.multipliers(np.array([first, second, last]))
    expected = [1250.0, complex(cosine, sine), complex(cosine, -sine), 7e-4]
    assert_allclose(np.sort_complex(found), np.sort_complex(expected), rtol=1e-6, atol=1e-8)


def test_turns_are_those_of_the_taylor_series(saddle):
    """Each zero of Z2' between points of the series of a segment is listed, with its height."""
    chain, found = saddle.chain, saddle.chain.turns()
    for k in range(len(chain.states)):
        _, sizes, _, times = chain.path(k).turns(1)
        own = found[found[:, 0] == k]
        assert_allclose(own[:, 1], chain.p[FREQUENCY] * times, rtol=0, atol=1e-9)
        assert_allclose(own[:, 3], np.abs(sizes) - chain.p[CLEARANCE], rtol=0, atol=1e-11)
