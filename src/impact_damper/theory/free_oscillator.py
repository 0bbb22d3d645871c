"""Single-term harmonic balance of the free oscillator (without damper): Z1 = a cos(W T + t1).

(a wl^2 - a W^2 + g a^3)^2 + (h a W)^2 = f^2 with g = (3/4) k3 and the forcing amplitude f.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from impact_damper.model.bounds import check_frequency
from impact_damper.theory.roots import polynomial_roots

# Rounding may lift an amplitude above its bound. ROUNDING is the relative excess that is allowed.
ROUNDING = 1e-9


class FreeSolutions(NamedTuple):
    """All solutions at one frequency: ascending amplitudes a, and phases t1, shape (count,)."""

    amplitude: np.ndarray
    phase: np.ndarray


class Point(NamedTuple):
    """A point of the free response curve: frequency W and amplitude a."""

    frequency: float
    amplitude: float


class Resonance(NamedTuple):
    """Amplitude and phase on the free resonance branch. Beyond its fold the phase is None."""

    amplitude: float
    phase: float | None


def free_solutions(oscillator, frequency) -> FreeSolutions:
    """Return all solutions without the damper at one frequency, by ascending amplitude."""
    detuning = oscillator.linear_frequency**2 - check_frequency(frequency) ** 2
    force = oscillator.forcing_amplitude(frequency)
    if force == 0:
        return FreeSolutions(np.zeros(1), np.zeros(1))
    drag, hardening = oscillator.damping * frequency, oscillator.hardening
    terms = [-(force**2), detuning**2 + drag**2, 2 * hardening * detuning, hardening**2]
    squares = polynomial_roots(terms)
    # Amplitudes are at most f/(h W). If k3 is tiny, rounding adds a root far above this bound.
    squares = squares[squares <= (force / drag) ** 2 * (1 + ROUNDING)]
    amplitude = np.sqrt(squares)
    inline = amplitude * (detuning + hardening * squares)
    return FreeSolutions(amplitude, np.arctan2(-drag * amplitude, inline))


def main_solutions(oscillator, frequency) -> FreeSolutions:
    """Return the free solutions, with a softening spring only up to the peak amplitude."""
    free = free_solutions(oscillator, frequency)
    if oscillator.hardening >= 0:
        return free
    kept = free.amplitude <= maximum_response(oscillator).amplitude * (1 + ROUNDING)
    return FreeSolutions(free.amplitude[kept], free.phase[kept])


def balance_amplitudes(oscillator, frequency):
    """Return the amplitudes of `main_solutions`. If there is no peak, return only the smallest."""
    try:
        return main_solutions(oscillator, frequency).amplitude
    except ValueError:
        return free_solutions(oscillator, frequency).amplitude[:1]


def resonance(oscillator, frequency) -> Resonance:
    """Return amplitude and phase on the branch of the response curve that has the peak.

    Beyond the fold at the end of this branch, return the amplitude at the fold and the phase None.
    """
    free = main_solutions(oscillator, frequency)
    folds = free_folds(oscillator)
    if oscillator.hardening < 0:
        most = maximum_response(oscillator).amplitude
        folds = [fold for fold in folds if fold.amplitude < most]
    if folds and np.sign(oscillator.hardening) * (frequency - folds[-1].frequency) > 0:
        return Resonance(folds[-1].amplitude, None)
    return Resonance(free.amplitude[-1], free.phase[-1])


def maximum_response(oscillator) -> Point:
    """Return the maximum of the free response curve over W.

    A point of the curve obeys (1 - U^2/a^2) W^4 + (h^2 - 2 m - 2 F U/a^2) W^2 + m^2 - F^2/a^2 = 0
    with the amplitude a and m = wl^2 + (3/4) k3 a^2. At the maximum both roots W^2 are equal.
    """
    damping, stiffness = oscillator.damping**2, oscillator.linear_frequency**2
    force, unbalance, hardening = oscillator.force, oscillator.unbalance, oscillator.hardening
    static = force + unbalance * stiffness
    linear = damping * (stiffness - damping / 4) - 2 * hardening * unbalance * static
    constant = force * unbalance * damping - static**2
    squares = polynomial_roots([constant, linear, hardening * (damping - hardening * unbalance**2)])
    for square in squares[squares > unbalance**2]:
        middle = stiffness + hardening * square
        leading = 1 - unbalance**2 / square
        frequency = (middle + force * unbalance / square - damping / 2) / leading
        forcing = force + unbalance * frequency
        slope = 2 * hardening * (middle - frequency) + (forcing / square) ** 2
        if frequency > 0 and slope > 0:
            return Point(float(np.sqrt(frequency)), float(np.sqrt(square)))
    raise ValueError(
        f"{oscillator.told('damping')}: the response has no peak, with "
        f"{oscillator.told('force', 'unbalance', 'cubic')}: it falls from W = 0 on, "
        "rises without end, or goes over the barrier of a softening spring"
    )


@lru_cache
def free_folds(oscillator) -> tuple[Point, ...]:
    """Return the folds of the free response curve, by ascending amplitude."""
    # The docstring of `maximum_response` gives the curve: P(u, W^2) = 0, u = a^2. At a fold also
    # dP/du = 0 at constant W. Eliminating W^2 from both equations leaves a polynomial in u.
    damping, stiffness = oscillator.damping**2, oscillator.linear_frequency**2
    force, unbalance, g = oscillator.force, oscillator.unbalance, oscillator.hardening
    if g == 0 or force == unbalance == 0:
        return ()
    fifth, fourth = 4 * g**3 * damping, 4 * g**2 * damping * stiffness
    second, third = 2 * g * damping * force**2, -4 * g**2 * force**2
    resultant = Polynomial([force**4, 0, second, third, fourth, fifth])
    resultant += unbalance * _by_unbalance(oscillator)
    squares = polynomial_roots(resultant.coef)
    squares = squares[squares > 0]
    root = (force**2 / squares**2 + g * damping) / (2 * g)
    linear = damping - 2 * stiffness - 4 * g * squares
    bend = stiffness**2 + 4 * g * stiffness * squares + 3 * (g * squares) ** 2
    leading = 1 - unbalance * (2 * force - unbalance * linear) / (2 * g * squares**2)
    frequencies = stiffness + g * squares - damping / 2 + root
    frequencies = (frequencies - unbalance**2 * bend / (2 * g * squares**2)) / leading
    return tuple(
        Point(float(np.sqrt(square)), float(np.sqrt(u)))
        for square, u in zip(frequencies, squares, strict=True)
        if square > 0
    )


def _by_unbalance(oscillator):
    damping, stiffness = oscillator.damping**2, oscillator.linear_frequency**2
    force, unbalance, g = oscillator.force, oscillator.unbalance, oscillator.hardening
    u = Polynomial([0, 1])
    spring = (stiffness + g * u) ** 2 * u - force**2
    bend = spring.deriv()
    linear = (damping - 2 * stiffness) * u - 2 * g * u**2
    slope = linear.deriv()
    own = force**2 + 2 * g * stiffness * u**2 + 2 * g**2 * u**3
    first = (damping - 2 * stiffness) * u * bend - spring * slope
    second = bend * (4 * force**2 - 2 * own + slope * linear) - spring * slope**2
    return (
        -2 * force * first
        + unbalance * second
        - 2 * force * unbalance**2 * slope * bend
        + unbalance**3 * bend**2
    )
