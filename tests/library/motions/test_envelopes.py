"""Envelopes against samples of a motion, and the largest values of polynomials.

An envelope is the largest |Z1| in each of several windows of time. Z1 is the displacement of the
primary mass.
"""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from helpers.sampling import sample
from numpy.polynomial import Polynomial

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Oscillator
from impact_damper.motions.records import AT_ONCE, envelope, extremum

VIOLENT = np.array([1.0, 0.5, -0.3, 2.0])


def test_envelope_is_that_of_the_samples():
    p = pack(PAPER, DESIGN, 1.9)
    period, strobe, count, points = 2 * math.pi / 1.9, 0.5 * math.pi / 1.9, 20, 4000
    largest, contacts = envelope(
        np.tile(p, (count, 1)), np.full(count, period), VIOLENT.copy(), 1e-13
    )
    times = strobe + period * np.arange(count * points + 1) / points
    states, log = sample(p, VIOLENT, strobe, times)
    x = np.abs(states[:, 0])
    dense = [x[k * points : (k + 1) * points + 1].max() for k in range(count)]
    # between two samples |x| exceeds both by at most (spacing/2)^2 |x''|/2
    assert np.all(largest - dense > -1e-9)
    assert np.all(largest - dense < 1e-5)
    begun = np.floor((log[:, 1] - strobe) / period).astype(int)
    np.testing.assert_array_equal(contacts, np.bincount(begun, minlength=count))


def test_windows_of_one_call_are_those_of_several():
    p = pack(PAPER, DESIGN, 1.9)
    count = AT_ONCE + 100
    rows = np.tile(p, (count, 1))
    rows[:, FREQUENCY] = np.linspace(1.9, 2.0, count)
    lengths = 2 * np.pi / rows[:, FREQUENCY]
    y = VIOLENT.copy()
    largest, contacts = envelope(rows, lengths, y, 1e-9)
    z, parts = VIOLENT.copy(), []
    for part in (slice(0, AT_ONCE - 7), slice(AT_ONCE - 7, count)):
        parts.append(envelope(rows[part], lengths[part], z, 1e-9))
    np.testing.assert_array_equal(y, z)
    np.testing.assert_array_equal(largest, np.concatenate([each[0] for each in parts]))
    np.testing.assert_array_equal(contacts, np.concatenate([each[1] for each in parts]))


def test_after_an_escape_nothing_is_known():
    p = pack(Oscillator(0.1, linear_frequency=1.0, cubic=-1.0), DESIGN, 1.0)
    rows, lengths = np.tile(p, (5, 1)), np.full(5, 2 * math.pi)
    largest, contacts = envelope(rows, lengths, np.array([0.95, 0.2, 0, 0]), 1e-9)
    assert largest[0] == np.inf
    assert np.isnan(largest[1:]).all()
    assert np.isnan(contacts).all()


@pytest.mark.parametrize("seed", range(5))
def test_extremum_is_that_of_all_turning_points(seed):
    """The series have several turning points in the interval, or none."""
    generator = np.random.default_rng(seed)
    for _ in range(200):
        rate, phase, shift = generator.uniform([0.2, 0, -1], [3, 7, 1])
        k = np.arange(25)
        factorials = np.array([math.factorial(each) for each in k], float)
        c = rate**k / factorials * np.cos(phase + k * np.pi / 2)
        c[0] += shift
        length = generator.uniform(0.1, 1.5)
        series = Polynomial(c)
        turns = series.deriv().roots()
        turns = turns.real[(np.abs(turns.imag) < 1e-9) & (turns.real > 0) & (turns.real < length)]
        values = np.abs(series(np.concatenate([[0, length], turns])))
        assert extremum(c, 24, length, 0.0) == pytest.approx(values.max(), rel=1e-13)
        assert extremum(c, 24, length, 10.0) == 10.0
