"""The tuned mass damper on an undamped linear oscillator under a harmonic force.

Frequencies are divided by the natural frequency of the oscillator, and displacements by the static
deflection.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from impact_damper.model.bounds import check_number

# Grid of frequencies on which peaks are found before they are refined.
FREQUENCIES = np.linspace(0.3, 1.7, 1401)


class Tuning(NamedTuple):
    """A tuned mass damper.

    mass_ratio, frequency, damping_ratio: m, f and z.
    """

    mass_ratio: float
    frequency: float
    damping_ratio: float


def response(tuning, frequency):
    """Return the amplitude of the primary mass over the static deflection, at frequencies r."""
    mass, tuned, damping = tuning
    r = np.asarray(frequency)
    coupling = tuned**2 + 2j * damping * tuned * r
    absorber = coupling - r**2
    return np.abs(absorber / ((1 - r**2) * absorber - mass * r**2 * coupling))


def peaks(tuning):
    """Return frequencies and amplitudes of the maxima of the response, each of shape (count,)."""
    sizes = response(tuning, FREQUENCIES)
    places = 1 + np.flatnonzero((sizes[1:-1] > sizes[:-2]) & (sizes[1:-1] >= sizes[2:]))
    frequencies = [
        minimize_scalar(
            lambda r: -response(tuning, r),
            bounds=(FREQUENCIES[k - 1], FREQUENCIES[k + 1]),
            method="bounded",
            options={"xatol": 1e-12},
        ).x
        for k in places
    ]
    return np.array(frequencies), response(tuning, frequencies)


def den_hartog(mass_ratio) -> Tuning:
    """Return the tuning for which both fixed points are equally high, and the damping of Brock.

    The tuning f = 1/(1 + m) is from Den Hartog, Mechanical Vibrations, 4th ed. 1956, sections 3.2
    and 3.3. The damping z^2 = 3 m/(8 (1 + m)) is from Brock, "A note on the damped vibration
    absorber", J. Appl. Mech. 13, A-284, 1946.
    """
    mass = _checked(mass_ratio)
    return Tuning(mass, 1 / (1 + mass), np.sqrt(3 * mass / (8 * (1 + mass))))


def fixed_point(mass_ratio) -> float:
    """Return the amplitude at the fixed points with the tuning of `den_hartog`, sqrt(1 + 2/m)."""
    return np.sqrt(1 + 2 / _checked(mass_ratio))


def exact_optimum(mass_ratio) -> Tuning:
    """Return the tuning and damping for which the maximum of the response is smallest.

    The closed form is from Nishihara and Asami, "Closed-form solutions to the exact optimizations
    of dynamic vibration absorbers", J. Vib. Acoust. 124(4), 576-582, 2002, doi 10.1115/1.1500335.
    """
    mass = _checked(mass_ratio)
    root = np.sqrt(4 + 3 * mass)
    squared = 16 + 23 * mass + 9 * mass**2 + 2 * (2 + mass) * root
    frequency = 2 / (1 + mass) * np.sqrt(2 * squared / (3 * (64 + 80 * mass + 27 * mass**2)))
    damping = np.sqrt((8 + 9 * mass - 4 * root) / (1 + mass)) / 4
    return Tuning(mass, frequency, damping)


def least_maximum(mass_ratio) -> float:
    """Return the amplitude of both peaks with `exact_optimum`, by Nishihara and Asami."""
    mass = _checked(mass_ratio)
    root = np.sqrt(4 + 3 * mass)
    difference = (8 + 9 * mass) ** 2 * (16 + 9 * mass) - 128 * root**3
    return np.sqrt(difference / (3 * (32 + 27 * mass))) / (3 * mass)


def _checked(mass_ratio):
    return check_number("mass_ratio", mass_ratio, above=0.0, most=10.0)
