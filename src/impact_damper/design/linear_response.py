"""Response of a linear machine with a linear absorber in closed form, and its exact maxima.

Frequencies r are divided by the natural frequency of the machine, and s = r^2. The machine has the
damping ratio z1. The absorber has the mass ratio m, the tuning f (its natural frequency divided by
the machine's) and the damping ratio z. The square of the machine's displacement, in the unit of the
table, is g(s) N(s)/D(s) with

    N = (f^2 - s)^2 + 4 z^2 f^2 s
    D = [(1 - s)(f^2 - s) - 4 z1 z f s - m f^2 s]^2 + 4 s [z1 (f^2 - s) + z f (1 - s) - m z f s]^2

    excitation                        unit of displacement    g
    force F                           F/k                     1
    unbalance m_e r_e                 m_e r_e/m1              s^2
    displacement A of the base        A                       1 + 4 z1^2 s
    acceleration B of the base        B/w1^2                  (1 + 4 z1^2 s)/s^2

m1, k and w1 are mass, stiffness and natural frequency (rad/s) of the machine. g N and D are
polynomials, apart from the denominator s^2, so all maxima of the response follow from the roots of
a polynomial.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from impact_damper.model.machine import Machine
from impact_damper.theory.tuned_mass_damper import Tuning

# A root counts as real if its imaginary part is at most REAL times the width of the resonance.
REAL = 1e-6


class LinearMachine(NamedTuple):
    """The dimensionless numbers of a linear machine.

    Attributes
    ----------
    damping_ratio : float
        z1.
    forcing : numpy.ndarray
        Coefficients of the polynomial g(s) without its denominator, lowest power first.
    falling : int
        2 if g(s) has the denominator s^2, else 0.
    unit : float
        Unit of displacement, m.
    natural_frequency : float
        Hz.
    """

    damping_ratio: float
    forcing: np.ndarray
    falling: int
    unit: float
    natural_frequency: float


def linear_machine(machine: Machine) -> LinearMachine:
    """Return the dimensionless numbers of a machine. Its cubic stiffness is ignored.

    Raises
    ------
    ValueError
        If the machine has no linear stiffness.
    """
    stiffness, mass = machine.linear_stiffness, machine.mass
    if stiffness == 0:
        raise ValueError(
            "linear_stiffness = 0 N/m: must be greater than 0 N/m for a tuned absorber (the "
            "machine has no natural frequency to tune to)"
        )
    ratio = machine.viscous_damping / (2 * math.sqrt(stiffness * mass))
    based = np.array([1.0, 4 * ratio**2])
    kinds = {
        "force": (np.ones(1), 0, (machine.force or 0.0) / stiffness),
        "unbalance": (np.array([0.0, 0.0, 1.0]), 0, (machine.unbalance or 0.0) / mass),
        "base_displacement": (based, 0, machine.base_displacement),
        "base_acceleration": (based, 2, (machine.base_acceleration or 0.0) * mass / stiffness),
    }
    kind = next(name for name in kinds if getattr(machine, name) is not None)
    return LinearMachine(ratio, *kinds[kind], machine.natural_frequency)


def squared(linear, tuning, frequency):
    """Return the squared displacement, in units of `LinearMachine.unit` squared, at frequencies r.

    Without an absorber `tuning` is None. The arguments are broadcast.
    """
    s = np.square(frequency)
    forcing = polynomial.polyval(s, linear.forcing) / s**linear.falling
    if tuning is None:
        return forcing / ((1 - s) ** 2 + 4 * linear.damping_ratio**2 * s)
    (mass, f, z), z1 = tuning, linear.damping_ratio
    real = (1 - s) * (f**2 - s) - 4 * z1 * z * f * s - mass * f**2 * s
    imaginary = 2 * (z1 * (f**2 - s) + z * f * (1 - s) - mass * z * f * s)
    return forcing * ((f**2 - s) ** 2 + (2 * z * f) ** 2 * s) / (real**2 + s * imaginary**2)


def response(machine, absorber, frequencies):
    """Return the amplitude of a linear machine, m, at forcing frequencies in Hz.

    The cubic stiffnesses are ignored.

    Parameters
    ----------
    machine : Machine
    absorber : TunedAbsorber or None
    frequencies : array_like
        Hz.
    """
    linear = linear_machine(machine)
    tuning = None if absorber is None else tuning_of(machine, absorber)
    r = np.asarray(frequencies) / linear.natural_frequency
    return linear.unit * np.sqrt(squared(linear, tuning, r))


def tuning_of(machine, absorber) -> Tuning:
    """Return mass ratio, tuning and damping ratio of an absorber on a machine.

    The absorber must have a linear stiffness.
    """
    own = math.sqrt(absorber.stiffness / absorber.mass)
    frequency = own / (2 * math.pi * machine.natural_frequency)
    return Tuning(
        absorber.mass / machine.mass, frequency, absorber.damping / (2 * absorber.mass * own)
    )


def maxima(linear, tuning, band):
    """Return frequencies r and squared displacements at the stationary points within a band.

    The stationary points are roots of a polynomial. The polynomial is written in t with
    s = 1 + w t, where w is the width of the resonance. In s the roots for a light absorber would be
    so close together that rounding errors merge them.

    Parameters
    ----------
    linear : LinearMachine
    tuning : Tuning
    band : tuple of 2 floats
        Lowest and highest r; the highest may be infinite.

    Returns
    -------
    tuple of numpy.ndarray, shape (count,)
        Frequencies of all stationary points within the band and of the finite ends of the band, in
        ascending order, and the values there. The largest value is the maximum over the band.
    """
    (mass, f, z), z1 = tuning, linear.damping_ratio
    width = min(math.sqrt(mass) + z1, 1.0)
    s, host, own = np.array([1.0, width]), np.array([0.0, -width]), np.array([f**2 - 1, -width])
    carried = (4 * z1 * z * f + mass * f**2) * s
    real = np.convolve(host, own) - np.append(carried, 0.0)
    imaginary = 2 * (z1 * own + z * f * host - mass * z * f * s)
    above = np.convolve(own, own) + np.append((2 * z * f) ** 2 * s, 0.0)
    below = polynomial.polyadd(
        np.convolve(real, real), np.convolve(s, np.convolve(imaginary, imaginary))
    )
    above = np.convolve(above, _composed(linear.forcing, s))
    for _ in range(linear.falling):
        below = np.convolve(below, s)
    slope = polynomial.polysub(
        np.convolve(polynomial.polyder(above), below),
        np.convolve(above, polynomial.polyder(below)),
    )
    roots = 1 + width * polynomial.polyroots(slope)
    places = np.sqrt(roots.real[(np.abs(roots.imag) <= REAL * width) & (roots.real > 0)])
    ends = np.array([end for end in band if math.isfinite(end)])
    inside = places[(places > band[0]) & (places < band[1])]
    stationary = np.sort(np.concatenate([ends, inside]))
    return stationary, squared(linear, tuning, stationary)


def _composed(coefficients, inner):
    """Return the coefficients of a polynomial whose argument is the polynomial `inner`."""
    composed = np.zeros(1)
    for coefficient in coefficients[::-1]:
        composed = np.convolve(composed, inner)
        composed[0] += coefficient
    return composed
