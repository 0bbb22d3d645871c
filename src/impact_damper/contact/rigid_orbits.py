"""Orbits of the rigid-impact model with two impacts a forcing period, and walls to mend it.

At finite r1 a contact takes the time tc, in which the loose mass overshoots the wall. Rigid
walls that stand further out by delta = v tc e/(1 + e), v the approach speed, let it return to
d0 when the contact would end. The load changes the speed with which it does so: `mended` gives
the restitution e' that a rigid wall needs. With both the orbit is right to the order 1/r1,
where the plain rigid model is right to 1/sqrt(r1).
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
        Of Z1 towards the wall before an impact.
    maps : int
        Maps over a forcing period that Newton's method took.
    """

    state: np.ndarray
    multiplier: complex
    displacement: float
    speed: float
    acceleration: float
    maps: int


def rigid_orbit(oscillator, damper, frequency, guess, reach):
    """Newton's method onto an orbit of the rigid model, whose r1 does not count.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequency : float
    guess : array, shape (4,)
        State near the orbit at W T = pi/2.
    reach : float
        How far the orbit may be from it.

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


def mended(oscillator, damper, orbit):
    """Clearance d0 + delta and restitution e' of rigid walls that stand for soft ones.

    To first order in 1/wn: the damping h of Z1 acts on the relative motion in contact as
    another h rm/(1 + rm), whose damping ratio adds to z; without it the load would be
    G = (a + h rm/(1 + rm) v)/(wn v), with a the acceleration of Z1 towards the wall before the
    contact, and changes the restitution by -2 z (1 + e) G. To return so from the
    outer wall, after flights over delta under the accelerations before and after, takes
    e' = e + (change) + (delta/v^2) (a_after/e - e a).

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    orbit : RigidOrbit
        Of the plain rigid model.

    Returns
    -------
    clearance, restitution : float
        e' may exceed 1.
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
    """`rigid_orbit` between the walls of `mended`, from the orbit of the plain rigid model."""
    clearance, restitution = mended(oscillator, damper, orbit)
    p = pack(oscillator, damper, frequency)
    p[CLEARANCE] = clearance
    return _solve(p, restitution, orbit.state, reach)
