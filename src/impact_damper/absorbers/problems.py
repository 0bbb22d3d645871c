"""Machines with and without an absorber at many frequencies and forces, as an array of parameters.

A problem is a row of parameters of `smooth_runs`. Lengths are in the scale of the machine, time is
the phase of the forcing in radian.
"""

import numpy as np

from impact_damper.motions.smooth_runs import (
    COUNT,
    CUBIC,
    DAMPING,
    FORCE,
    INVERSE_MASS,
    LINK_CUBIC,
    LINK_DAMPING,
    LINK_STIFFNESS,
    STIFFNESS,
)

# Longest step, as a phase (radian) of the fastest vibration: COARSE while an orbit is searched,
# FINE for its last corrections. Least number of steps in a forcing period.
COARSE, FINE = 0.7, 0.35
LEAST_STEPS = 8


def problems_of(machine, absorber, frequencies, shares):
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
    numpy.ndarray, shape (len(frequencies) len(shares), COUNT)
        The problem of frequency i and share j has the index i len(shares) + j.
    """
    scales = machine.scales
    w = np.repeat(scales.from_si(np.asarray(frequencies, float), "frequency"), len(shares))
    given = [each for hertz in frequencies for each in [machine.oscillator(hertz)] * len(shares)]
    force = np.array(
        [each.forcing_amplitude(angular) for each, angular in zip(given, w, strict=True)]
    )
    found = np.zeros((len(w), COUNT))
    found[:, FORCE] = force * np.tile(shares, len(frequencies)) / w**2
    found[:, DAMPING] = given[0].damping / w
    found[:, STIFFNESS] = given[0].linear_frequency ** 2 / w**2
    found[:, CUBIC] = given[0].cubic / w**2
    if absorber is not None:
        found[:, INVERSE_MASS] = 1 / scales.from_si(absorber.mass, "mass")
        found[:, LINK_STIFFNESS] = scales.from_si(absorber.stiffness, "stiffness") / w**2
        found[:, LINK_DAMPING] = scales.from_si(absorber.damping, "damping") / w
        cubic = scales.from_si(absorber.cubic_stiffness, "cubic_stiffness")
        found[:, LINK_CUBIC] = cubic / w**2
    return found


def active_size(problems) -> int:
    """Return the number of components of a state in use: 4, or 2 without an absorber."""
    return 4 if problems[:1, INVERSE_MASS].any() else 2


def springs(problems):
    """Return stiffness and cubic stiffness of the machine's spring and of the absorber's spring.

    Both are divided by the moving mass: the mass of the machine, or for the absorber's spring the
    effective mass with which absorber and machine vibrate against each other.

    Returns
    -------
    tuple of pairs of numpy.ndarray, shape (n,)
    """
    share = 1 + problems[:, INVERSE_MASS]
    return (
        (problems[:, STIFFNESS], problems[:, CUBIC]),
        (share * problems[:, LINK_STIFFNESS], share * problems[:, LINK_CUBIC]),
    )


def steps_for(problems, states, longest):
    """Return the number of steps in a forcing period for each problem.

    The fastest vibration is estimated from the stiffness of both springs at the displacements that
    free vibrations from the states reach.

    Parameters
    ----------
    problems : numpy.ndarray, shape (n, COUNT)
    states : numpy.ndarray, shape (n, SIZE)
    longest : float
        Longest step in radian of the fastest vibration.
    """
    fastest = 1.0
    for (stiffness, cubic), place in zip(springs(problems), (0, 2), strict=True):
        x, v = states[:, place], states[:, place + 1]
        energy = v**2 / 2 + (stiffness / 2 + cubic / 4 * x**2) * x**2
        root = np.sqrt(np.maximum(stiffness**2 + 4 * cubic * energy, 0.0))
        # the displacement X reached is X^2 = 4 energy/(stiffness + root)
        fastest = fastest + stiffness + 3 * np.maximum(root - stiffness, 0.0)
    least = 2 * np.pi * np.sqrt(fastest) / longest
    # a motion that has escaped needs no certain number of steps
    return np.ceil(
        np.where(np.isfinite(least), np.maximum(least, LEAST_STEPS), LEAST_STEPS)
    ).astype(int)
