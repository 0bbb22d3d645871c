"""Find periodic orbits, stable or unstable, by Newton's method on the event-driven flow."""

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
    orbit = newton(p, state, periods, phase)
    if orbit.amplification > AMPLIFYING:
        chain = polish(orbit if orbit.residual < NEAR else shoot(p, state, periods, phase)[0])
        if chain.residual < orbit.residual:
            return replace(chain, maps=orbit.maps + chain.maps)
    # The first phase may lie in a contact, where rounding errors grow, so that the orbit cannot
    # converge. It is moved to a flight if its residual is below NEAR.
    if not orbit.residual < NEAR or orbit.flight_phase() == orbit.phase:
        return orbit
    phase = orbit.flight_phase()
    moved = newton(p, orbit.at(phase), periods, phase % TURN)
    return replace(moved, maps=orbit.maps + moved.maps)


def newton(p, state, periods, phase, *, symmetric=False, reach=None):
    """Return the orbit that Newton's method finds by single shooting; arguments as in `shoot`.

    With `reach` it stops at the first converged orbit, or where a component of the state is further
    than this from the guess.
    """

    def shot(states):
        orbit, end = shoot(p, states[0], periods, phase, symmetric=symmetric)
        return orbit, (end - states[0])[None]

    return _iterate(shot, np.array(state, float)[None], reach)


def _iterate(shot, first, reach=None):
    """Return the orbit with the smallest residual among the iterates of Newton's method.

    `first` are the states at the beginnings of the segments, shape (m, 4). `shot` returns the orbit
    with such states, and the defects of its segments. `reach` is that of `newton`.
    """
    orbit, defects = shot(first)
    states, best, maps = first, orbit, 1
    for _ in range(ITERATIONS):
        n = orbit.active
        if reach is not None and best.converged:
            break
        try:
            matrix = segments.cyclic(orbit.factors[:, :n, :n])
            change = np.linalg.solve(matrix, -defects[:, :n].ravel()).reshape(-1, n)
        except np.linalg.LinAlgError:
            break
        states = states + np.tile(change, (1, 4 // n))
        away = np.max(np.abs(change)) if reach is None else np.max(np.abs(states - first))
        if not away < (FAR if reach is None else reach):
            break
        orbit, defects = shot(states)
        maps += 1
        if best.converged and orbit.residual >= best.residual:
            break
        if orbit.residual < best.residual:
            best = orbit
    return replace(best, maps=maps)


def orbit_of(chain, periods):
    """Return the orbit of a `segments.Chain`.

    The residual of the orbit is the largest defect of the chain, the difference between the end of
    a segment and the beginning of the next segment.
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
    """Return the orbit that Newton's method finds by multiple shooting near an approximate one."""
    maps, sign = orbit.maps, 1 if orbit.root is None else -1
    for _ in range(CUTS):
        phases = segments.cut(orbit, orbit.cycle)

        def shot(states, p=orbit.p, phases=phases, periods=orbit.periods):
            chain = segments.chain_of(p, phases, states, sign)
            return orbit_of(chain, periods), chain.defects

        orbit = _iterate(shot, np.array([orbit.at(phase) for phase in phases[:-1]]))
        maps += orbit.maps
        if np.max(np.linalg.norm(orbit.factors, 2, axis=(1, 2))) < ROUGH * segments.AMPLIFIED:
            break
    return replace(orbit, maps=maps)
