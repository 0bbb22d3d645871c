"""Find periodic orbits, stable or unstable, by Newton's method."""

from dataclasses import replace

import numpy as np

from impact_damper.motions.strobe_map import STROBE
from impact_damper.orbits import segments
from impact_damper.orbits.orbit import TURN, Orbit, integrate

# Newton's method stops after ITERATIONS corrections, or before a single correction of FAR or more.
ITERATIONS, FAR = 20, 10.0
# The phase at which an orbit begins is changed only if the orbit's residual is below NEAR.
NEAR = 1e-6
# Multiple shooting is used if a small disturbance can grow by more than this factor on an orbit.
AMPLIFYING = 100.0
# An orbit is divided into new segments, at most CUTS times, until small disturbances grow along
# each segment by less than the factor ROUGH x `segments.AMPLIFIED`.
CUTS, ROUGH = 4, 4.0


def shoot(p, state, periods, phase, *, symmetric=False) -> Orbit:
    """Integrate a state over `periods` forcing cycles. Return an `Orbit` with a single segment.

    The orbit need not be periodic. If `symmetric`, only half of the cycles are integrated.
    """
    cycle = periods * TURN * (0.5 if symmetric else 1.0)
    return integrate(p, periods, (phase, phase + cycle), [state], -1 if symmetric else 1)


def find_orbit(p, state, periods=1, phase=STROBE) -> Orbit:
    """Find the orbit near a state at a phase W T. `Orbit.converged` tells whether this succeeded.

    Without contacts only Z1 and Z1' are unknown. Z2 - Z1 and Z2' - Z1', which describe the loose
    mass alone, stay as in `state`. If `phase` is in a contact, the orbit found begins in a flight.
    """
    orbit = newton(shoot(p, state, periods, phase))
    if orbit.amplification > AMPLIFYING:
        chain = polish(orbit if orbit.residual < NEAR else shoot(p, state, periods, phase))
        if chain.residual < orbit.residual:
            return replace(chain, maps=orbit.maps + chain.maps)
    # If the orbit begins in a contact, rounding errors grow and Newton's method cannot converge. If
    # the orbit's residual is below NEAR, the orbit is computed again from a phase in a flight.
    if not orbit.residual < NEAR or orbit.flight_phase() == orbit.phase:
        return orbit
    phase = orbit.flight_phase()
    moved = newton(shoot(p, orbit.at(phase), periods, phase % TURN))
    return replace(moved, maps=orbit.maps + moved.maps)


def newton(orbit, reach=None) -> Orbit:
    """Return the orbit with the smallest residual that Newton's method finds from `orbit`.

    If `reach` is given, the method stops at the first converged orbit. It also stops before a state
    would differ from its value in `orbit` by `reach` or more.
    """
    states, best, maps = orbit.states, orbit, 1
    for _ in range(ITERATIONS):
        n = orbit.active
        if reach is not None and best.converged:
            break
        try:
            matrix = segments.cyclic(orbit.factors[:, :n, :n])
            change = np.linalg.solve(matrix, -orbit.defects[:, :n].ravel()).reshape(-1, n)
        except np.linalg.LinAlgError:
            break
        moved = orbit.states + np.tile(change, (1, 4 // n))
        away = np.max(np.abs(change)) if reach is None else np.max(np.abs(moved - states))
        if not away < (FAR if reach is None else reach):
            break
        orbit = integrate(orbit.p, orbit.periods, orbit.phases, moved, orbit.sign)
        maps += 1
        if best.converged and orbit.residual >= best.residual:
            break
        if orbit.residual < best.residual:
            best = orbit
    return replace(best, maps=maps)


def polish(orbit) -> Orbit:
    """Divide an approximate orbit into segments, and return the orbit found by Newton's method."""
    maps = orbit.maps
    for _ in range(CUTS):
        phases = segments.cut(orbit, orbit.cycle)
        states = [orbit.at(phase) for phase in phases[:-1]]
        orbit = newton(integrate(orbit.p, orbit.periods, phases, states, orbit.sign))
        maps += orbit.maps
        if np.max(np.linalg.norm(orbit.factors, 2, axis=(1, 2))) < ROUGH * segments.AMPLIFIED:
            break
    return replace(orbit, maps=maps)
