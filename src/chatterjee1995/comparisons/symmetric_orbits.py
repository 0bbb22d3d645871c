"""Symmetric orbits with two compliant contacts in a cycle, found by the speed of the loose mass.

An orbit is a periodic motion. It is symmetric if half a forcing cycle later the motion is its
mirror image. Let s be the speed of the loose mass between contacts, divided by the clearance. For a
linear spring and a given force and frequency, the clearance of a symmetric orbit is a function of
s. Two orbits may have the same clearance, but only one orbit has a given s. Therefore orbits are
computed for a given s.

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass and d0
the clearance. Multipliers are Floquet multipliers.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from chatterjee1995.comparisons.masri_caughey import flight_with_speed
from impact_damper.model.packed import pack
from impact_damper.orbits.compliant_orbits import CONTACTS
from impact_damper.orbits.orbit import Orbit
from impact_damper.orbits.shooting import shoot

# Newton's method. ITERATIONS: largest number of corrections. RESIDUAL: largest residual of an
# orbit, relative to its state.
ITERATIONS = 15
RESIDUAL = 1e-9
# Relative change of the clearance in difference quotients of the map over half a cycle.
NUDGE = 1e-6
# The closed form for rigid walls has its loss of stability at a ratio s. The loss of stability of
# the orbits is searched for between 1 - width and 1 + width times s, with the smallest width first.
WIDTHS = 0.005, 0.02, 0.08


class SymmetricOrbit(NamedTuple):
    """A symmetric orbit with two contacts.

    Attributes
    ----------
    orbit : Orbit
        The orbit. Its state is taken in the middle of the flight from the wall Z2 = -d0 to the
        other wall.
    clearance : float
        d0.
    ratio : float
        s, the speed of the loose mass in the middle of this flight divided by d0.
    """

    orbit: Orbit
    clearance: float
    ratio: float

    @property
    def modulus(self) -> float:
        """Largest modulus of the multipliers of the map over half a cycle; above 1 if unstable."""
        return float(np.max(np.abs(np.linalg.eigvals(self.orbit.root))))

    @property
    def displacement(self) -> float:
        """max |Z1|."""
        return float(self.orbit.record["maximum_displacement"])


def orbit_at_clearance(oscillator, damper, frequency, motion) -> SymmetricOrbit:
    """Return the orbit with the damper's clearance near a `masri_caughey.TwoImpactMotion`.

    Raises
    ------
    ArithmeticError
        If Newton's method does not converge to an orbit with two contacts.
    """
    p = pack(oscillator, damper, frequency)
    rigid = flight_with_speed(oscillator, damper, frequency, motion.speed / motion.clearance)
    state = rigid.state
    for _ in range(ITERATIONS):
        orbit, end = shoot(p, state, 1, rigid.phase, symmetric=True)
        if orbit.converged:
            break
        state = state + np.linalg.solve(np.eye(4) - orbit.root, end - state)
    return _checked(orbit, damper.clearance)


def orbit_with_speed(oscillator, damper, frequency, ratio) -> SymmetricOrbit:
    """Return the orbit with a given ratio s of the speed of the loose mass to the clearance.

    Newton's method finds the state and the clearance. Its first guess is the motion between rigid
    walls. The clearance of `damper` has no effect.

    Raises
    ------
    ArithmeticError
        If Newton's method does not converge to an orbit with two contacts.
    """
    rigid = flight_with_speed(oscillator, damper, frequency, ratio)
    unknowns = np.append(rigid.state, rigid.clearance)

    def mapped(state, clearance):
        p = pack(oscillator, replace(damper, clearance=clearance), frequency)
        return shoot(p, state, 1, rigid.phase, symmetric=True)

    # The first guess is close to the orbit, because the walls are nearly rigid. So the derivative
    # of the map with respect to the clearance is computed only once.
    step = NUDGE * rigid.clearance
    ahead, behind = (mapped(rigid.state, rigid.clearance + h)[1] for h in (step, -step))
    matrix = np.zeros((5, 5))
    matrix[:4, 4], matrix[4] = (ahead - behind) / (2 * step), (0, 1, 0, -1, ratio)
    for _ in range(ITERATIONS):
        state, clearance = unknowns[:4], float(unknowns[4])
        orbit, end = mapped(state, clearance)
        off = state[1] - state[3] + ratio * clearance
        if orbit.converged and abs(off) < RESIDUAL * clearance:
            break
        matrix[:4, :4] = orbit.root - np.eye(4)
        unknowns = unknowns - np.linalg.solve(matrix, np.append(end - state, off))
    return _checked(orbit, clearance)


def _checked(orbit, clearance):
    """Return the `SymmetricOrbit` of an orbit.

    Raises
    ------
    ArithmeticError
        If the orbit has not converged or does not have two contacts.
    """
    size = np.max(np.abs(orbit.state))
    if not orbit.residual < RESIDUAL * max(1.0, size) or orbit.record["contacts"] != CONTACTS:
        raise ArithmeticError(
            f"clearance = {clearance:g}: no symmetric orbit with two contacts, "
            f"residual {orbit.residual:.1e}"
        )
    return SymmetricOrbit(orbit, clearance, (orbit.state[3] - orbit.state[1]) / clearance)


def boundary_near(oscillator, damper, frequency, boundary) -> SymmetricOrbit:
    """Return the orbit at which stability is lost, near a `masri_caughey_stability.Boundary`.

    Raises
    ------
    ArithmeticError
        If there is no such orbit within the largest of WIDTHS.
    """
    rigid = boundary.motion.speed / boundary.motion.clearance

    def at(ratio):
        return orbit_with_speed(oscillator, damper, frequency, ratio)

    for width in WIDTHS:
        ends = rigid * (1 - width), rigid * (1 + width)
        if boundary.event == "fold":
            fold = minimize_scalar(
                lambda ratio: -at(ratio).clearance,
                bounds=ends,
                method="bounded",
                options={"xatol": 1e-8 * rigid},
            ).x
            if min(fold - ends[0], ends[1] - fold) > 0.01 * width * rigid:
                return at(fold)
        elif np.prod([at(end).modulus - 1 for end in ends]) < 0:
            return at(brentq(lambda ratio: at(ratio).modulus - 1, *ends, xtol=1e-13 * rigid))
    raise ArithmeticError(f"no {boundary.event} near the clearance {boundary.motion.clearance:g}")
