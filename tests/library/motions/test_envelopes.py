"""Envelopes against samples of a motion, and the largest values of polynomials."""

import math

import numpy as np
from helpers.known_orbits import DESIGN, PAPER
from helpers.sampling import sample

from impact_damper.model.packed import pack
from impact_damper.motions.records import envelope

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
