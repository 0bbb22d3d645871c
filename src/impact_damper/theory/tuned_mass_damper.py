"""Tunings of a mass damper on an undamped linear oscillator under a harmonic force."""

from typing import NamedTuple

import numpy as np


class Tuning(NamedTuple):
    """A tuned mass damper: its frequency is divided by the natural frequency of the oscillator."""

    mass_ratio: float
    frequency: float
    damping_ratio: float


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
