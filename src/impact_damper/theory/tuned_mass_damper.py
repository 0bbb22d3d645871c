"""Tunings of a mass damper on an undamped linear oscillator under a harmonic force."""

from typing import NamedTuple

import numpy as np


class Tuning(NamedTuple):
    """A tuned mass damper: its frequency is divided by the natural frequency of the oscillator."""

    mass_ratio: float
    frequency: float
    damping_ratio: float


def den_hartog(mass_ratio) -> Tuning:
    """Return the tuning with equally high fixed points, and the damping of Brock.

    f = 1/(1 + m): Den Hartog, Mechanical Vibrations, 4th ed. 1956, sections 3.2 and 3.3. z^2 = 3 m/
    (8 (1 + m)): Brock, "A note on the damped vibration absorber", J. Appl. Mech. 13, A-284, 1946.
    """
    return Tuning(
        mass_ratio, 1 / (1 + mass_ratio), np.sqrt(3 * mass_ratio / (8 * (1 + mass_ratio)))
    )


def exact_optimum(mass_ratio) -> Tuning:
    """Return the tuning and damping for which the maximum of the response is smallest.

    Nishihara and Asami, "Closed-form solutions to the exact optimizations of dynamic vibration
    absorbers", J. Vib. Acoust. 124(4), 576-582, 2002, doi 10.1115/1.1500335.
    """
    mass = mass_ratio
    root = np.sqrt(4 + 3 * mass)
    squared = 16 + 23 * mass + 9 * mass**2 + 2 * (2 + mass) * root
    frequency = 2 / (1 + mass) * np.sqrt(2 * squared / (3 * (64 + 80 * mass + 27 * mass**2)))
    damping = np.sqrt((8 + 9 * mass - 4 * root) / (1 + mass)) / 4
    return Tuning(mass, frequency, damping)
