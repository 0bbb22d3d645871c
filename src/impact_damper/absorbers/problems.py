"""Machines with and without an absorber at many frequencies and forces, as arrays.

In the scales of the machine, with the displacement x of the machine and u of the machine relative
to the absorber,

    x'' = f cos(W T) - h x' - (k + k3 x^2) x - n
    u'' = x'' - n/m,    n = (kappa + kappa3 u^2) u + eta u'

and n = 0 without an absorber. A state is (x, x', u, u'), or (x, x') without an absorber.
"""

from typing import NamedTuple

import numpy as np


class Problems(NamedTuple):
    """Parameters of several problems, each an array of shape (n,), dimensionless.

    Attributes
    ----------
    frequency, force, damping, stiffness, cubic : numpy.ndarray
        W, f, h, k and k3.
    link : numpy.ndarray, shape (4, n), or None
        m, kappa, eta and kappa3 of the absorber; None without an absorber.
    """

    frequency: np.ndarray
    force: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    cubic: np.ndarray
    link: np.ndarray | None

    @property
    def size(self) -> int:
        """Components of a state: 4, or 2 without an absorber."""
        return 2 if self.link is None else 4

    def take(self, chosen) -> "Problems":
        """Return the problems with some indices."""
        link = None if self.link is None else self.link[:, chosen]
        return Problems(*(each[chosen] for each in self[:5]), link)


def problems_of(machine, absorber, frequencies, shares) -> Problems:
    """Return the problems of a machine at pairs of frequency and force share.

    Parameters
    ----------
    machine : Machine
    absorber : TunedAbsorber or None
    frequencies : sequence of float
        Hz.
    shares : sequence of float
        Factors of the machine's excitation.

    Returns
    -------
    Problems
        At frequency i and share j the problem with index i len(shares) + j.
    """
    scales = machine.scales
    angular = np.array([scales.from_si(each, "frequency") for each in frequencies])
    given = [machine.oscillator(each) for each in frequencies]
    forces = [each.forcing_amplitude(w) for each, w in zip(given, angular, strict=True)]
    count = len(frequencies) * len(shares)
    first = given[0]
    fixed = (first.damping, first.linear_frequency**2, first.cubic)
    link = None
    if absorber is not None:
        values = (
            scales.from_si(absorber.mass, "mass"),
            scales.from_si(absorber.stiffness, "stiffness"),
            scales.from_si(absorber.damping, "damping"),
            scales.from_si(absorber.cubic_stiffness, "cubic_stiffness"),
        )
        link = np.repeat(np.array(values)[:, None], count, axis=1)
    return Problems(
        np.repeat(angular, len(shares)),
        np.outer(forces, shares).ravel(),
        *(np.full(count, value) for value in fixed),
        link,
    )


def rate(problems, springs, force, state):
    """Return the rate of states or, without a force, of small disturbances of them.

    Parameters
    ----------
    problems : Problems
    springs : tuple of numpy.ndarray
        Stiffness of the machine's spring and of the absorber's: `secants` of the state for the
        motion, `slopes` for a disturbance.
    force : numpy.ndarray, shape (n,), or float
        Force on the machine.
    state : numpy.ndarray, shape (size, ..., n)
    """
    speed = state[1]
    acceleration = force - problems.damping * speed - springs[0] * state[0]
    if problems.link is None:
        return np.stack([speed, acceleration])
    mass, _, damping, _ = problems.link
    held = springs[1] * state[2] + damping * state[3]
    acceleration -= held
    return np.stack([speed, acceleration, state[3], acceleration - held / mass])


def secants(problems, state):
    """Return force over displacement of both springs."""
    return _springs(problems, state, 1.0)


def slopes(problems, state):
    """Return the derivative of force by displacement of both springs."""
    return _springs(problems, state, 3.0)


def _springs(problems, state, factor):
    first = problems.stiffness + factor * problems.cubic * state[0] ** 2
    if problems.link is None:
        return (first,)
    _, stiffness, _, cubic = problems.link
    return first, stiffness + factor * cubic * state[2] ** 2
