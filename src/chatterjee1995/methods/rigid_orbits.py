"""Orbits of the rigid-impact model with two impacts in a forcing cycle, and corrections of them.

The model replaces compliant walls of finite stiffness r1 by rigid walls. A contact with a compliant
wall takes the time tc. The corrected ("mended") rigid walls imitate it in two ways.

- They are further out by delta = v tc e/(1 + e), with the approach speed v. The loose mass then
  returns to |Z2| = d0 at the time at which the contact with the compliant wall ends.
- They have another restitution e', which `mended_walls` returns. The loose mass then has the speed
  at |Z2| = d0 that it has at the end of the compliant contact, which depends on the load (the
  acceleration by other forces during the contact).

The error of the orbit is of order 1/sqrt(r1) between plain rigid walls and of order 1/r1 between
corrected walls.

Symbols are as in `system.parameters`.
"""

from typing import NamedTuple

import numpy as np

from chatterjee1995.methods.rigid_impacts import MOST_IMPACTS, rigid_map
from impact_damper.model.packed import CLEARANCE, DASHPOT, pack
from impact_damper.motions.strobe_map import CONVERGED, POLISH_TOLERANCE
from impact_damper.theory.contact_law import damping_ratio, natural_frequency

# IMPACTS     number of impacts of an orbit in a forcing cycle
# ITERATIONS  largest number of steps of Newton's method
# SAME_SPEED  largest relative difference of the approach speeds of the impacts of a symmetric orbit
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
        Number of integrations over a forcing cycle that Newton's method took.
    """

    state: np.ndarray
    multiplier: complex
    displacement: float
    speed: float
    acceleration: float
    maps: int


def rigid_orbit(oscillator, damper, frequency, guess, reach):
    """Find an orbit of the rigid model by Newton's method. The damper's r1 has no effect.

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
        "found"; "not_followed" if Newton's method fails; "other_contacts" if the orbit does not
        have two symmetric impacts in a cycle; "chatter" if a cycle has MOST_IMPACTS impacts.
    """
    p = pack(oscillator, damper, frequency)
    return _solve(p, damper.restitution, guess, reach)


def _solve(p, restitution, guess, reach):
    """Return orbit and status as `rigid_orbit`, for packed parameters and any restitution."""
    p = p.copy()
    p[DASHPOT] = 0.0
    restitution = float(restitution)  # numba would compile the map a second time for an int
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

    The corrections are of first order in 1/wn. Here wn is the natural frequency and z the damping
    ratio of the contact (`contact_law`), v the approach speed, and a the acceleration of Z1 towards
    the wall before the contact. Three effects change the restitution e:

    - The damping h of Z1 also damps the relative motion in contact, by h rm/(1 + rm), and thereby
      increases z.
    - The load of the contact, G = (a + h rm/(1 + rm) v)/(wn v), adds -2 z (1 + e) G to e.
    - Between d0 and the rigid wall at d0 + delta the loose mass flies under the acceleration a
      before and a_after after the impact. Adding (delta/v^2) (a_after/e - e a) to e compensates
      this flight, which the compliant contact does not have.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    orbit : RigidOrbit
        Orbit between plain rigid walls, from which v and a are taken.

    Returns
    -------
    clearance, restitution : float
        The restitution e' may exceed 1.
    """
    e, h, v, before = damper.restitution, oscillator.damping, orbit.speed, orbit.acceleration
    reduced = damper.mass_ratio / (1 + damper.mass_ratio)
    z, natural = damping_ratio(e), natural_frequency(damper)
    duration = np.pi / (natural * np.sqrt(1 - z * z))
    shift = v * duration * e / (1 + e)
    after = before + h * (1 + e) * reduced * v
    load = (before + h * reduced * v) / (natural * v)
    damped = e * np.pi * h * reduced / (2 * natural * (1 - z * z) ** 1.5)
    returned = e - damped - 2 * z * (1 + e) * load
    return damper.clearance + shift, returned + shift / v**2 * (after / e - e * before)


def mended_orbit(oscillator, damper, frequency, orbit, reach):
    """Return orbit and status as `rigid_orbit`, but between the corrected walls of `mended_walls`.

    Newton's method begins at `orbit`, the orbit between plain rigid walls.
    """
    clearance, restitution = mended_walls(oscillator, damper, orbit)
    p = pack(oscillator, damper, frequency)
    p[CLEARANCE] = clearance
    return _solve(p, restitution, orbit.state, reach)
