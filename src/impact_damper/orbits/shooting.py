"""Find periodic orbits, stable or unstable, by Newton's method on the event-driven flow.

The map over the period integrates a state over this time; an orbit is one of its fixed points. The
state of an orbit is stored at a phase W T of the forcing at which the loose mass is in flight, far
from contacts, so that the map is smooth and well scaled. The derivative of the map comes from the
variational equations, with saltation matrices (jumps of the derivative) where the dashpot's force
jumps. Multiple shooting (`segments`) cuts an orbit into several segments.

Z1 is the displacement of the primary mass.
"""

from dataclasses import replace
from functools import reduce

import numpy as np

from impact_damper.model.packed import FREQUENCY
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, flow_map
from impact_damper.orbits import segments
from impact_damper.orbits.orbit import STROBE, TURN, Orbit

# Newton's method.
# ITERATIONS: largest number of corrections.
# FAR: largest size of a correction.
ITERATIONS = 20
FAR = 10.0
# If the residual is below NEAR, the state of an orbit can be integrated to another phase.
NEAR = 1e-6
# If the norm of the derivative of the map over the period exceeds AMPLIFYING, Newton's method on
# this map (single shooting) is not accurate enough, and multiple shooting is used.
AMPLIFYING = 100.0
# Multiple shooting: while the derivative of the map over a segment has a norm of more than
# ROUGH * `segments.AMPLIFIED`, the orbit is cut again into segments, at most CUTS times.
CUTS, ROUGH = 4, 4.0


def shoot(p, state, periods, phase, *, symmetric=False):
    """Apply the map over a period to a state, without iteration.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters.
    state : array, shape (4,)
    periods : int
        Period n in forcing cycles, odd if symmetric.
    phase : float
        Phase W T of the state, radian.
    symmetric : bool
        If True, the map over n/2 cycles followed by a change of sign is used. Its fixed points are
        the symmetric orbits.

    Returns
    -------
    orbit : Orbit
        The orbit with this state. Its residual states how far the state is from being periodic.
    end : numpy.ndarray, shape (4,)
        The state after the map.
    """
    whole, sign = (periods // 2, -1) if symmetric else (periods, 1)
    begin = phase / p[FREQUENCY]
    end, matrix, touching = flow_map(p, state, begin, whole, symmetric, POLISH_TOLERANCE)
    end, matrix = sign * end, sign * matrix
    residual = float(np.max(np.abs(end - state)))
    converged = residual <= segments.RESIDUAL * max(1.0, np.max(np.abs(state)))
    if symmetric:
        results = matrix @ matrix, matrix, residual, 2 * touching, converged
    else:
        results = matrix, None, residual, touching, converged
    return Orbit(p, periods, phase, state, *results), end


def find_orbit(p, state, periods=1, phase=STROBE):
    """Find the orbit near a state by Newton's method, and move its phase into a flight.

    If no wall is touched, only Z1 and Z1' are unknown, and the loose mass rests. An orbit that
    amplifies disturbances by more than AMPLIFYING is found by multiple shooting.

    Parameters
    ----------
    p, state, periods, phase
        As in `shoot`.

    Returns
    -------
    Orbit
        Its attribute `converged` states whether Newton's method converged.
    """
    state = np.array(state, float)
    orbit = _newton(p, state, periods, phase)
    if orbit.amplification > AMPLIFYING:
        chain = polish(orbit if orbit.residual < NEAR else shoot(p, state, periods, phase)[0])
        if chain.residual < orbit.residual:
            return replace(chain, maps=orbit.maps + chain.maps)
    # The first phase may lie in a contact, where rounding errors grow, so that the orbit cannot
    # converge. It is moved to a flight if its residual is below NEAR.
    if not orbit.residual < NEAR or orbit.flight_phase() == orbit.phase:
        return orbit
    phase = orbit.flight_phase()
    moved = _newton(p, orbit.at(phase), periods, phase % TURN)
    return replace(moved, maps=orbit.maps + moved.maps)


def _newton(p, state, periods, phase):
    """Return the orbit with the smallest residual among the iterates of Newton's method."""
    best, end = shoot(p, state, periods, phase)
    orbit = best
    maps = 1
    for _ in range(ITERATIONS):
        n = orbit.active
        matrix = np.eye(n) - orbit.monodromy[:n, :n]
        try:
            change = np.linalg.solve(matrix, (end - orbit.state)[:n])
        except np.linalg.LinAlgError:
            break
        if not np.max(np.abs(change)) < FAR:
            break
        moved = orbit.state.copy()
        moved[:n] += change
        if n == 2:
            moved[2:] += change
        orbit, end = shoot(p, moved, periods, phase)
        maps += 1
        if best.converged and orbit.residual >= best.residual:
            break
        if orbit.residual < best.residual or not best.converged:
            best = orbit
    return replace(best, maps=maps)


def orbit_of(chain, periods):
    """Return the orbit of a `segments.Chain`.

    The residual of the orbit is the largest defect of the chain, the difference between the end of
    a segment and the beginning of the next segment.

    Parameters
    ----------
    chain : segments.Chain
    periods : int
        Period n of the orbit in forcing cycles, odd if the chain is half of the orbit.
    """
    product = reduce(lambda product, factor: factor @ product, chain.factors)
    half = chain.sign < 0
    matrices = (product @ product, product) if half else (product, None)
    touching = (1 + half) * chain.touching
    return Orbit(
        chain.p,
        periods,
        chain.phases[0],
        chain.states[0],
        *matrices,
        chain.residual,
        touching,
        chain.converged,
        chain=chain,
    )


def polish(orbit):
    """Return an orbit by multiple shooting, near an approximate orbit.

    Parameters
    ----------
    orbit : Orbit
        The approximate orbit, which need not have converged.

    Returns
    -------
    Orbit
        Its attribute `converged` states whether Newton's method converged.
    """
    maps = orbit.maps
    for _ in range(CUTS):
        phases = segments.cut(orbit, orbit.cycle)
        states = np.array([orbit.at(phase) for phase in phases[:-1]])
        orbit, more = _newton_of_chain(orbit, phases, states)
        maps += more
        if np.max(np.linalg.norm(orbit.factors, 2, axis=(1, 2))) < ROUGH * segments.AMPLIFIED:
            break
    return replace(orbit, maps=maps)


def _newton_of_chain(orbit, phases, states):
    """Return the best iterate of Newton's method by multiple shooting, and the number of maps.

    The best iterate has the smallest residual. `phases` and `states` are those of the segments.
    """

    def shot(states):
        sign = 1 if orbit.root is None else -1
        return orbit_of(segments.chain_of(orbit.p, phases, states, sign), orbit.periods)

    current = best = shot(states)
    maps = 1
    for _ in range(ITERATIONS):
        matrix = segments.cyclic(current.factors)
        try:
            change = np.linalg.solve(matrix, -current.chain.defects.ravel())
        except np.linalg.LinAlgError:
            break
        if not np.max(np.abs(change)) < FAR:
            break
        before = current.residual
        current = shot(current.chain.states + change.reshape(states.shape))
        maps += 1
        if current.residual < best.residual:
            best = current
        if best.converged and current.residual > before / 2:
            break
    return best, maps
