"""Find symmetric orbits of period 1 with two compliant contacts by Newton's method.

`chatterjee1995.methods.rigid_impacts` finds the corresponding orbits with rigid impacts.

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass and W T
the phase of the forcing.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.motions.records import measured
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, polish

# Number of contacts of the orbits in a forcing cycle.
CONTACTS = 2
# Half a cycle later the state of a symmetric orbit has changed its sign, up to this difference.
SYMMETRIC = 1e-6


class CompliantOrbit(NamedTuple):
    """A symmetric orbit with two contacts in a forcing cycle, stable or unstable.

    Attributes
    ----------
    parameters : numpy.ndarray, shape (COUNT,)
        Packed parameters.
    state : numpy.ndarray, shape (4,)
        Z1, Z1', Z2, Z2' at the strobe, W T = pi/2, where W is the forcing frequency.
    multiplier : complex
        Dominant Floquet multiplier, with an imaginary part that is not negative.
    displacement : float
        max |Z1|.
    """

    parameters: np.ndarray
    state: np.ndarray
    multiplier: complex
    displacement: float


def compliant_orbit(p, guess, reach, *, tolerance=POLISH_TOLERANCE, asymmetry=SYMMETRIC):
    """Find a symmetric orbit with two contacts in a forcing cycle by Newton's method.

    Parameters
    ----------
    p : array, shape (COUNT,)
        Packed parameters.
    guess : array, shape (4,)
        State near the orbit at W T = pi/2.
    reach : float
        Largest distance of the orbit from the guess, in all components but Z2'.
    tolerance : float
        Largest local error of a step of the integrator.
    asymmetry : float
        Largest difference between a state and the mirrored state half a cycle later.

    Returns
    -------
    orbit : CompliantOrbit or None
    status : str
        "found"; "not_followed" if Newton's method fails; or "other_contacts" if it finds an orbit
        that is not symmetric or has another number of contacts.
    """
    state = np.array(guess, float)
    converged, _, multiplier = polish(p, state, 1, reach, tolerance)
    if not converged:
        return None, "not_followed"
    record = measured(p, state, 1, tolerance)
    if record["contacts"] != CONTACTS or not record["asymmetry"] < asymmetry:
        return None, "other_contacts"
    return CompliantOrbit(p, state, multiplier, float(record["maximum_displacement"])), "found"
