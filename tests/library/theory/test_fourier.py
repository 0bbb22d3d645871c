"""Series and their crossings against closed forms."""

import numpy as np
import pytest
from scipy.integrate import quad

from impact_damper.theory import fourier

ONE = np.array([1])


def test_value_and_samples_agree():
    harmonics, angle = np.arange(1, 4), 2 * np.pi * np.arange(12) / 12
    coefficients = np.array([1 - 2j, 0.5j, 0.1])
    direct = sum(
        2 * (c * np.exp(1j * k * angle)).real for k, c in zip(harmonics, coefficients, strict=True)
    )
    assert fourier.samples(coefficients, harmonics, 12) == pytest.approx(direct)
    assert fourier.value(coefficients, harmonics, angle) == pytest.approx(direct)


def test_intervals_of_a_cosine():
    found = fourier.intervals(np.array([0.5]), ONE, 0.5)
    third = np.pi / 3
    expected = [[1, 5 * third, 7 * third], [-1, 2 * third, 4 * third]]
    assert found == pytest.approx(np.array(expected), abs=1e-14)
    assert len(fourier.intervals(np.array([0.1]), ONE, 1.0)) == 0


@pytest.mark.parametrize("excess", [1e-3, 1e-6, 1e-9])
def test_no_grazing_is_missed(excess):
    """cos(s - 1) exceeds 1 - excess in a length 2 sqrt(2 excess), shorter than sample intervals."""
    found = fourier.intervals(np.array([0.5 * np.exp(-1j)]), ONE, 1 - excess)
    half = np.arccos(1 - excess)
    expected = [[1, 1 - half, 1 + half], [-1, 1 + np.pi - half, 1 + np.pi + half]]
    assert found == pytest.approx(np.array(expected), abs=1e-7)


def test_indicator_is_the_integral():
    rows = np.array([[1, 0.4, 0.9], [-1, 6.0, 7.0]])
    for order in (-7, 0, 3):
        direct = sum(
            complex(
                quad(lambda s, k=order: np.cos(k * s), a, b)[0],
                -quad(lambda s, k=order: np.sin(k * s), a, b)[0],
            )
            for _, a, b in rows
        )
        found = fourier.indicator(rows, np.array([order]))[0]
        assert found == pytest.approx(direct / (2 * np.pi), abs=1e-14)


def test_largest_of_two_harmonics():
    """The maximum of cos s + cos(2s)/4 is 1.25, at s = 0."""
    assert fourier.largest(np.array([0.5, 0.125]), np.array([1, 2])) == pytest.approx(1.25, 1e-14)
