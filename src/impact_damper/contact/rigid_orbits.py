"""Orbits of the rigid-impact model with two impacts a forcing period, without and with corrections.

The corrected ("mended") rigid walls imitate a compliant contact of finite stiffness r1. Such a
contact takes the time tc, and the loose mass must leave it at the right time with the right speed.
Time: rigid walls further out by delta = v tc e/(1 + e), v the approach speed, make the loose mass
return to |Z2| = d0 when the compliant contact ends. Speed: the load, that is the other forces
during the contact, changes the speed at this end; `mended_walls` gives the restitution e' of the
rigid wall that yields the same speed. The error of the orbit is of order 1/sqrt(r1) between plain
rigid walls and of order 1/r1 between corrected ones.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.contact.contact_law import damping_ratio, natural_frequency
from impact_damper.contact.rigid_impacts import MOST_IMPACTS, rigid_map
from impact_damper.motions.strobe_map import CONVERGED, POLISH_TOLERANCE
from impact_damper.system.packed import CLEARANCE, DASHPOT, pack

# Number of impacts in a forcing period of an orbit; largest number of corrections of Newton's
# method; largest relative difference between the approach speeds of impacts that count as
# symmetric.
IMPACTS = 2
ITERATIONS = 12
SAME_SPEED = 1e-6


class RigidOrbit(NamedTuple):
    """A symmetric orbit of the rigid model.

    Attributes
    ----------
    state : numpy.ndarray, shape (4,)
        Z1, Z1', Z2, Z2' at W T = pi/2.
    multiplier : complex
        Dominant Floquet multiplier.
    displacement : float
        max |Z1|.
    speed : float
        Approach speed |Z2'| of the impacts.
    acceleration : float
        Acceleration of Z1 towards the wall before an impact.
    maps : int
        Number of maps over a forcing period that Newton's method computed.
    """

    state: np.ndarray
    multiplier: complex
    displacement: float
    speed: float
    acceleration: float
    maps: int


def rigid_orbit(oscillator, damper, frequency, guess, reach):
    """Find an orbit of the rigid model by Newton's method; r1 of the damper has no effect.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequency : float
    guess : array, shape (4,)
        State near the orbit at W T = pi/2.
    reach : float
        Largest difference of a component of the state from the guess.

    Returns
    -------
    orbit : RigidOrbit or None
    status : str
        "found"; "not_followed" if Newton's method fails; "other_contacts" if the orbit has other
        than two symmetric impacts a period; "chatter" if there are MOST_IMPACTS in a period.
    """
    p = pack(oscillator, damper, frequency)
    return _solve(p, damper.restitution, guess, reach)


def _solve(p, restitution, guess, reach):
    """Return what `rigid_orbit` does, for packed parameters and any restitution."""
    p = p.copy()
    p[DASHPOT] = 0.0
    restitution = float(restitution)  # for an int numba would compile the map again
    y = np.array(guess, float)
    for k in range(ITERATIONS):
        state, matrix, impacts, slowest, first, largest = rigid_map(
            p, restitution, y, POLISH_TOLERANCE
        )
        if impacts == MOST_IMPACTS:
            return None, "chatter"
        if impacts == 0:
            break
        change = np.linalg.solve(np.eye(4) - matrix, state - y)
        if np.max(np.abs(change)) < CONVERGED:
            if impacts != IMPACTS or abs(first[0] - slowest) > SAME_SPEED * first[0]:
                return None, "other_contacts"
            values = np.linalg.eigvals(matrix)
            largest_value = values[np.argmax(np.abs(values))]
            dominant = complex(largest_value.real, abs(largest_value.imag))
            return RigidOrbit(y, dominant, largest, *first, k + 1), "found"
        y = y + change
        if not np.max(np.abs(y - guess)) < reach:
            break
    return None, "not_followed"


def mended_walls(oscillator, damper, orbit):
    """Return clearance d0 + delta and restitution e' of rigid walls that replace compliant ones.

    The corrections are of first order in 1/wn, with the natural frequency wn and the damping ratio
    z of the contact (`contact_law`), v the approach speed and a the acceleration of Z1 towards the
    wall before the contact. Three effects change the restitution e:

    - the damping h of Z1 damps the relative motion in contact by h rm/(1 + rm), which adds to z;
    - the load of the contact, G = (a + h rm/(1 + rm) v)/(wn v), adds -2 z (1 + e) G to e;
    - between d0 and the wall at d0 + delta the loose mass flies under the acceleration a before and
      a_after after the impact. To undo its effect, (delta/v^2) (a_after/e - e a) is added.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    orbit : RigidOrbit
        Orbit between plain rigid walls, which gives v and a.

    Returns
    -------
    clearance, restitution : float
        The restitution e' may exceed 1.
    """
    e, h, v, before = damper.restitution, oscillator.damping, orbit.speed, orbit.acceleration
    share = damper.mass_ratio / (1 + damper.mass_ratio)
    z, natural = damping_ratio(e), natural_frequency(damper)
    duration = np.pi / (natural * np.sqrt(1 - z * z))
    shift = v * duration * e / (1 + e)
    after = before + h * (1 + e) * share * v
    load = (before + h * share * v) / (natural * v)
    damped = e * np.pi * h * share / (2 * natural * (1 - z * z) ** 1.5)
    returned = e - damped - 2 * z * (1 + e) * load
    return damper.clearance + shift, returned + shift / v**2 * (after / e - e * before)


def mended_orbit(oscillator, damper, frequency, orbit, reach):
    """Return orbit and status as `rigid_orbit`, between the corrected walls of `mended_walls`.

    Newton's method starts from `orbit`, the orbit between plain rigid walls.
    """
    clearance, restitution = mended_walls(oscillator, damper, orbit)
    p = pack(oscillator, damper, frequency)
    p[CLEARANCE] = clearance
    return _solve(p, restitution, orbit.state, reach)
