"""Orbits of the rigid-impact model with two impacts a forcing period, and a correction for it.

At finite r1 a contact takes the time tc, during which the loose mass penetrates the wall. If rigid
walls stand further out by delta = v tc e/(1 + e), with the approach speed v, the loose mass returns
to d0 at the time when the compliant contact ends. The load changes its speed there: `mended_walls`
gives the restitution e' that the rigid wall needs. With both corrections the error of the orbit is
of order 1/r1; without them of order 1/sqrt(r1).
"""

from typing import NamedTuple

import numpy as np

from impact_damper.contact.contact_law import damping_ratio, natural_frequency
from impact_damper.contact.rigid_impacts import MOST_IMPACTS, rigid_map
from impact_damper.motions.strobe_map import CONVERGED, POLISH_TOLERANCE
from impact_damper.system.packed import CLEARANCE, DASHPOT, pack

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
        Largest distance of the orbit from the guess.

    Returns
    -------
    orbit : RigidOrbit or None
    status : str
        "found"; "not_followed" if Newton's method fails; "other_contacts" if the orbit has not two
        symmetric impacts a period; "chatter" if impacts follow each other without end.
    """
    p = pack(oscillator, damper, frequency)
    return _solve(p, damper.restitution, guess, reach)


def _solve(p, restitution, guess, reach):
    """`rigid_orbit` for packed parameters and a restitution."""
    p = p.copy()
    p[DASHPOT] = 0.0
    restitution = float(restitution)  # a whole number would have the map compiled again
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

    All to first order in 1/wn. In contact the damping h of Z1 acts on the relative motion as a
    damping h rm/(1 + rm), whose ratio adds to z. The load is then
    G = (a + h rm/(1 + rm) v)/(wn v), with the acceleration a of Z1 towards the wall before the
    contact, and changes the restitution by -2 z (1 + e) G. With the flights over delta, before and
    after the impact at the outer wall, under the accelerations a and a_after, the restitution
    needed is e' = e + (both changes) + (delta/v^2) (a_after/e - e a).

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    orbit : RigidOrbit
        Of the plain rigid model.

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
    """`rigid_orbit` between `mended_walls`, from the orbit of the plain rigid model."""
    clearance, restitution = mended_walls(oscillator, damper, orbit)
    p = pack(oscillator, damper, frequency)
    p[CLEARANCE] = clearance
    return _solve(p, restitution, orbit.state, reach)
