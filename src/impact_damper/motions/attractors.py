"""Attracting orbits of the free oscillator at one frequency, each with a proven neighbourhood.

A strobe is a time at which the forcing has the phase W T = pi/2. A neighbourhood is an ellipse
around a state of the orbit at a strobe. Every motion that is in the ellipse at a strobe tends to
the orbit, so the integration of such a motion can stop.

Proof. Let x(t) be the orbit and P its period. Let F(t) be the matrix of its variational equations,
with F(0) = 1 and F(P) = V R V^-1, where the norm |R| is the largest modulus of a multiplier and is
below 1. Write the difference of a motion from the orbit as d = F(t) V w(t). The equation of motion
with the spring k3 Z1^3 then gives, without approximation,

    w' = -k3 c(t) [3 x1(t) d1^2 + d1^3],    c = V^-1 F(t)^-1 (0, 1),    d1 = (F(t) V w)_1.

With g = |first row of F(t) V| it follows that |w|' <= |k3| |c| (3 |x1| g^2 |w|^2 + g^3 |w|^3). Let
r(t) solve this relation as an equation, from r(0) = r0. It bounds |w(t)| for all |w(0)| <= r0.
After a period V^-1 d = R w(P). If |R| r(P) < r0, the ellipse |V^-1 d| < r0 is therefore mapped into
itself. The ratio r(P)/r0 grows with r0, so smaller ellipses contract too, and all motions in the
ellipse tend to the orbit.

The scalar equation for r is integrated numerically. In each of STEPS steps in a forcing cycle a
coefficient has the larger of its values at the ends of the step. In place of |R| r(P) < r0 the
program requires |R| r(P) < FACTOR r0.

Z1 is the displacement of the primary mass, W the forcing frequency, and T the time.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import is_settled
from impact_damper.kernel.single import workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import FREQUENCY, cubic_spring
from impact_damper.motions import ensemble
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, strobe_time

# STEPS     number of steps in a forcing cycle in the proof
# FACTOR    largest ratio |R| r(P)/r0 that is accepted as a contraction
# HALVINGS  number of bisections that determine the size r0 of the ellipse
STEPS = 256
FACTOR = 0.98
HALVINGS = 30
# Two orbits are the same if their states at a strobe differ by less than ALIKE.
ALIKE = 1e-6
# Half width of the region that is searched for stable and unstable orbits, divided by the largest
# displacement and speed of the free motions.
REACH = 3.0
# Number of starts on each axis of the grid whose motions lead to the attractors.
SEARCHED = 24


class Attractors(NamedTuple):
    """Attracting orbits of the free oscillator, by ascending max |Z1|, and their neighbourhoods.

    Attributes
    ----------
    records : numpy.ndarray of records.MOTION, shape (k,)
    owner : numpy.ndarray of int, shape (m,)
        Index of the orbit of each neighbourhood. An orbit of period n has n neighbourhoods.
    centre : numpy.ndarray, shape (m, 2)
        States Z1, Z1' at strobes.
    shape : numpy.ndarray, shape (m, 2, 2)
        Matrices S such that |S (z - c)| < 1 is the neighbourhood of a centre c. If no neighbourhood
        was proven, S is infinite, so the neighbourhood is empty.
    """

    records: np.ndarray
    owner: np.ndarray
    centre: np.ndarray
    shape: np.ndarray


def find_attractors(p, states, settling, workers=1) -> Attractors:
    """Return the attracting orbits that the motions from given states at a strobe lead to.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters without a damper.
    states : array, shape (n, 2)
        Z1 and Z1' at the strobe.
    settling : Settling
    workers : int
        Number of threads.
    """
    starts = np.tile(np.asarray(states, float).reshape(-1, 2), 2)
    motions = ensemble.settle(
        np.tile(p, (len(starts), 1)), starts, settling, from_strobe=True, workers=workers
    )
    return with_neighbourhoods(p, _distinct(p, motions[is_settled(motions)]))


def free_attractors(p, window, settling, workers=1) -> Attractors:
    """Return the attractors to which a grid of states leads; `window` are its half widths."""
    grid = [np.linspace(-half, half, SEARCHED) for half in window]
    states = np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 2)
    return find_attractors(p, states, settling, workers)


def with_neighbourhoods(p, records) -> Attractors:
    """Return the `Attractors` of orbits, which are passed as records of type `records.MOTION`."""
    owner, centres, shapes = [], [], []
    for index, record in enumerate(records):
        for state in strobe_states(p, record):
            owner.append(index)
            centres.append(state)
            shapes.append(neighbourhood(p, state, int(record["period"])))
    return Attractors(
        records,
        np.array(owner, np.int64),
        np.array(centres).reshape(-1, 2),
        np.array(shapes).reshape(-1, 2, 2),
    )


def strobe_states(p, record):
    """Return the states Z1, Z1' of a free orbit at its strobes, shape (period, 2)."""
    y, none, work = record["state"].copy(), np.empty((0, 4)), workspace()
    states, begin = [], strobe_time(p)
    for _ in range(record["period"]):
        states.append(y[:2].copy())
        advance(p, y, none, 0, begin, begin + 2 * np.pi / p[FREQUENCY], POLISH_TOLERANCE, work)
    return np.array(states)


def _distinct(p, motions):
    """Return one record of each orbit, by ascending max |Z1|; mirror images are two orbits."""
    kept, seen = [], []
    for record in motions[np.argsort(motions["maximum_displacement"], kind="stable")]:
        known = any(
            len(orbit) == record["period"]
            and np.min(np.max(np.abs(orbit - record["state"][:2]), axis=1)) < ALIKE
            for orbit in seen
        )
        if not known:
            kept.append(record)
            seen.append(strobe_states(p, record))
    return np.array(kept, motions.dtype)


def linear_flow(p, state, periods):
    """Return Z1 of an orbit and the matrices F(t), at STEPS times in each cycle and at the end.

    Returns
    -------
    displacement : numpy.ndarray, shape (n,)
    matrices : numpy.ndarray, shape (n, 2, 2)
    """
    y, tangents, work = np.tile(state, 2), np.eye(4)[:2].copy(), workspace()
    times = strobe_time(p) + np.arange(periods * STEPS + 1) * 2 * np.pi / (STEPS * p[FREQUENCY])
    displacement, matrices = [y[0]], [np.eye(2)]
    for begin, end in zip(times, times[1:], strict=False):
        advance(p, y, tangents, 0, begin, end, POLISH_TOLERANCE, work)
        displacement.append(y[0])
        matrices.append(tangents[:, :2].T.copy())
    return np.array(displacement), np.array(matrices)


def neighbourhood(p, state, periods):
    """Return the matrix S of the proven neighbourhood |S d| < 1 of a state of a free orbit.

    S is infinite if the proof fails, for example for an unstable orbit. `periods` is the period of
    the orbit in forcing cycles.
    """
    displacement, matrices = linear_flow(p, state, periods)
    values, vectors = np.linalg.eig(matrices[-1])
    if not np.max(np.abs(values)) < 1:
        return np.full((2, 2), np.inf)
    if np.iscomplexobj(vectors):
        vectors = np.stack([vectors[:, 0].real, vectors[:, 0].imag], axis=1)
    vectors = vectors / np.sqrt(abs(np.linalg.det(vectors)))
    forward = matrices @ vectors
    gain = np.linalg.norm(forward[:, 0], axis=1)
    kick = np.linalg.norm(np.linalg.inv(forward)[:, :, 1], axis=1)
    cubic = abs(cubic_spring(p)[1])
    coefficients = np.array(
        [3 * cubic * kick * np.abs(displacement) * gain**2, cubic * kick * gain**3]
    )
    largest = np.maximum(coefficients[:, :-1], coefficients[:, 1:])
    radius = _radius(largest, 2 * np.pi / (STEPS * p[FREQUENCY]), np.max(np.abs(values)))
    with np.errstate(divide="ignore"):
        return np.linalg.inv(vectors) / radius


def _radius(coefficients, step, contraction):
    """Return the largest r0 for which `contraction` r(P) < FACTOR r0 (see the module docstring).

    r grows, so in a step r' = a r^2 + b r^3 is at most its value with r at the end of the step. The
    root of r = r(begin) + step (a r^2 + b r^3) is therefore an upper bound on r at the end. The
    loop computes an upper bound on this root, by one iteration from a value `ahead` above the root.
    """
    low, high = 0.0, 10.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        r = middle
        for a, b in coefficients.T:
            ahead = r + 2 * step * (a + b * r) * r * r
            if r + step * (a + b * ahead) * ahead * ahead > ahead:
                r = np.inf
                break
            r += step * (a + b * ahead) * ahead * ahead
        low, high = (middle, high) if contraction * r < FACTOR * middle else (low, middle)
    return low
