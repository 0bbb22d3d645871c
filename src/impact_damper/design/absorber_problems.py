"""Machines with and without an absorber at many frequencies and forces, as an array of parameters.

A problem is a row of parameters that the kernel `motions.smooth_runs.run` reads. Lengths are in the
scale of the machine. The unit of time is the phase of the forcing in radian.
"""

import numpy as np

from impact_damper.design.smooth_runs import (
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

# COARSE       longest integration step in the search for an orbit, as a phase (radian) of the
#              fastest vibration
# FINE         longest integration step in the last corrections of the orbit, in the same unit
# LEAST_STEPS  smallest number of steps in a forcing cycle
COARSE, FINE = 0.7, 0.35
LEAST_STEPS = 8


def problems_of(machine, absorber, frequencies, shares):
    """Return the problems of a machine at all pairs of a frequency and a force share.

    Parameters
    ----------
    machine : Machine
    absorber : TunedAbsorber or None
    frequencies : sequence of float
        Hz.
    shares : sequence of float
        Force shares: factors of the machine's excitation.

    Returns
    -------
    numpy.ndarray, shape (len(frequencies) len(shares), COUNT)
        The problem of frequency i and share j has the index i len(shares) + j.
    """
    scales = machine.scales
    w = np.repeat(scales.from_si(np.asarray(frequencies, float), "frequency"), len(shares))
    oscillators = [
        each for hertz in frequencies for each in [machine.oscillator(hertz)] * len(shares)
    ]
    force = np.array(
        [each.forcing_amplitude(angular) for each, angular in zip(oscillators, w, strict=True)]
    )
    problems = np.zeros((len(w), COUNT))
    problems[:, FORCE] = force * np.tile(shares, len(frequencies)) / w**2
    problems[:, DAMPING] = oscillators[0].damping / w
    problems[:, STIFFNESS] = oscillators[0].linear_frequency ** 2 / w**2
    problems[:, CUBIC] = oscillators[0].cubic / w**2
    if absorber is not None:
        problems[:, INVERSE_MASS] = 1 / scales.from_si(absorber.mass, "mass")
        problems[:, LINK_STIFFNESS] = scales.from_si(absorber.stiffness, "stiffness") / w**2
        problems[:, LINK_DAMPING] = scales.from_si(absorber.damping, "damping") / w
        cubic = scales.from_si(absorber.cubic_stiffness, "cubic_stiffness")
        problems[:, LINK_CUBIC] = cubic / w**2
    return problems


def active_size(problems) -> int:
    """Return the number of components of a state that are used: 4, or 2 without an absorber."""
    return 4 if problems[:1, INVERSE_MASS].any() else 2


def springs(problems):
    """Return stiffness and cubic stiffness of the machine's spring and of the absorber's spring.

    The values of the machine's spring are divided by the mass of the machine. The values of the
    absorber's spring are divided by the reduced mass of absorber and machine.

    Returns
    -------
    tuple of pairs of numpy.ndarray, shape (n,)
        (stiffness, cubic stiffness) of the machine's spring, then of the absorber's spring.
    """
    inverse = 1 + problems[:, INVERSE_MASS]
    return (
        (problems[:, STIFFNESS], problems[:, CUBIC]),
        (inverse * problems[:, LINK_STIFFNESS], inverse * problems[:, LINK_CUBIC]),
    )


def steps_for(problems, states, longest):
    """Return the number of integration steps in a forcing cycle for each problem, shape (n,).

    The fastest vibration is estimated from the stiffness of both springs at the largest
    displacements of unforced vibrations from the given states.

    Parameters
    ----------
    problems : numpy.ndarray, shape (n, COUNT)
    states : numpy.ndarray, shape (n, SIZE)
    longest : float
        Longest step, in radian of the fastest vibration.
    """
    fastest = 1.0
    for (stiffness, cubic), place in zip(springs(problems), (0, 2), strict=True):
        x, v = states[:, place], states[:, place + 1]
        energy = v**2 / 2 + (stiffness / 2 + cubic / 4 * x**2) * x**2
        root = np.sqrt(np.maximum(stiffness**2 + 4 * cubic * energy, 0.0))
        # The largest displacement X is given by X^2 = 4 energy/(stiffness + root).
        fastest = fastest + stiffness + 3 * np.maximum(root - stiffness, 0.0)
    least = 2 * np.pi * np.sqrt(fastest) / longest
    # After an escape a state is not finite, and the number of steps does not matter.
    return np.ceil(
        np.where(np.isfinite(least), np.maximum(least, LEAST_STEPS), LEAST_STEPS)
    ).astype(int)
