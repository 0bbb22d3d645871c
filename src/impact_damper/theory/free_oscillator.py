"""Single-term harmonic balance of the oscillator without the damper: Z1 = a cos(W T + t1).

Equation (3) without contact gives

    (a wl^2 - a W^2 + (3/4) a^3)^2 + (h a W)^2 = 1,

a cubic in a^2 at a fixed frequency W and a quadratic in W^2 at a fixed amplitude a. Every quantity
is dimensionless, angles are in radian.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.system.checks import check_frequency
from impact_damper.theory.roots import polynomial_roots


class FreeSolutions(NamedTuple):
    """Solutions without the damper at one frequency.

    Attributes
    ----------
    amplitude : numpy.ndarray, shape (count,)
        a > 0, ascending.
    phase : numpy.ndarray, shape (count,)
        t1 in (-pi, pi], phase of Z1 to the forcing.
    """

    amplitude: np.ndarray
    phase: np.ndarray


class Point(NamedTuple):
    """A point of the free response curve: frequency W and amplitude a."""

    frequency: float
    amplitude: float


def free_solutions(oscillator, frequency) -> FreeSolutions:
    """All solutions without the damper at one frequency, by ascending amplitude.

    Raises
    ------
    TypeError, ValueError
        If the frequency is not a number or out of range.
    """
    detuning = oscillator.linear_frequency**2 - check_frequency(frequency) ** 2
    drag, hardening = oscillator.damping * frequency, oscillator.hardening
    squares = polynomial_roots([-1, detuning**2 + drag**2, 2 * hardening * detuning, hardening**2])
    amplitude = np.sqrt(squares)
    inline = amplitude * (detuning + hardening * squares)
    return FreeSolutions(amplitude, np.arctan2(-drag * amplitude, inline))


def maximum_response(oscillator) -> Point:
    """Maximum of the free response curve over W, exact within single-term harmonic balance.

    The two frequencies at which the curve has the amplitude a are the roots
    W^2 = m - h^2/2 +- sqrt(1/a^2 - h^2 m + h^4/4), with m = wl^2 + (3/4) a^2. They coincide at
    the maximum.

    Raises
    ------
    ValueError
        If the damping is so large that the amplitude decreases from W = 0 on.
    """
    damping, stiffness = oscillator.damping**2, oscillator.linear_frequency**2
    linear, hardening = damping * (stiffness - damping / 4), oscillator.hardening
    amplitude = (-linear + np.sqrt(linear**2 + 4 * hardening * damping)) / (2 * hardening * damping)
    square = stiffness + hardening * amplitude - damping / 2
    if square <= 0:
        raise ValueError(f"damping = {oscillator.damping:g}: too large, the response has no peak")
    return Point(float(np.sqrt(square)), float(np.sqrt(amplitude)))


def free_folds(oscillator) -> list[Point]:
    """Folds of the free response curve, by ascending amplitude; two or none.

    On the branch W^2 = m - h^2/2 + S, where S is the square root in `maximum_response`, the
    condition dW/da = 0 reads (3/2) S = 1/u^2 + (3/4) h^2 with u = a^2. Squared, it is a polynomial
    of degree five in u.
    """
    damping, stiffness = oscillator.damping**2, oscillator.linear_frequency**2
    g = oscillator.hardening
    fifth, fourth = 4 * g**3 * damping, 4 * g**2 * damping * stiffness
    squares = polynomial_roots([1, 0, 2 * g * damping, -4 * g**2, fourth, fifth])
    squares = squares[squares > 0]
    root = (1 / squares**2 + g * damping) / (2 * g)
    frequencies = stiffness + g * squares - damping / 2 + root
    return [
        Point(float(np.sqrt(square)), float(np.sqrt(u)))
        for square, u in zip(frequencies, squares, strict=True)
        if square > 0
    ]
