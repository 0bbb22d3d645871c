"""Envelopes against samples of a motion, and the largest values of polynomials."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from helpers.sampling import sample
from numpy.polynomial import Polynomial

from impact_damper.model.packed import pack
from impact_damper.motions.records import envelope, extremum

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
