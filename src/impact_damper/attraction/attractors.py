"""The attracting motions of the free oscillator at one frequency, with proven neighbourhoods.

A neighbourhood is an ellipse around a state of the orbit at a strobe, the phase W T = pi/2 of the
forcing. Every motion that passes through it at a strobe tends to the orbit, so that it need not be
run any further.

Proof. Let x(t) be the orbit of period T and F(t) the matrix of its variational equations, F(0) = 1,
M = F(T) = V R V^-1 with |R| = max |multiplier| < 1. A difference d from the orbit is written as
d = F(t) V w(t). The equation of motion with the spring k3 Z1^3 then gives exactly

    w' = -k3 c(t) [3 x1(t) d1^2 + d1^3],    c = V^-1 F(t)^-1 (0, 1),    d1 = (F(t) V w)_1,

so that |w|' <= |k3| |c| (3 |x1| g^2 |w|^2 + g^3 |w|^3) with g = |first row of F(t) V|. The bound
r(T) on |w(T)| that follows from |w(0)| = r solves the scalar equation with equality. After a period
V^-1 d = R w(T): if |R| r(T) < r, the ellipse |V^-1 d| < r is mapped into itself, and since
r(T)/r grows with r, with a contraction at each return: its motions tend to the orbit. The scalar
equation is integrated numerically, with STEPS steps a period in which each coefficient has the
largest value at the ends of the step; FACTOR is kept as a reserve.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import is_settled
from impact_damper.kernel.single import advance, workspace
from impact_damper.motions import ensemble
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, strobe_time
from impact_damper.system.packed import CUBIC, FREQUENCY

# Steps per forcing period in the proof, contraction that is asked for, and halvings of an interval
# that holds the radius.
STEPS = 256
FACTOR = 0.98
HALVINGS = 30
# Displacements by which the same motion, found twice, may differ.
ALIKE = 1e-6


class Attractors(NamedTuple):
    """Attracting orbits of the free oscillator, by rising max |Z1|, and their neighbourhoods.

    Attributes
    ----------
    records : numpy.ndarray of records.MOTION, shape (k,)
    owner : numpy.ndarray of int, shape (m,)
        Index of the orbit that each neighbourhood belongs to: an orbit of period n has n of them.
    centre : numpy.ndarray, shape (m, 2)
        States Z1, Z1' at strobes.
    shape : numpy.ndarray, shape (m, 2, 2)
        Matrices S: the neighbourhood of a centre c is |S (z - c)| < 1. Infinite where no
        neighbourhood could be proven; it then holds the centre only.
    """

    records: np.ndarray
    owner: np.ndarray
    centre: np.ndarray
    shape: np.ndarray


def find_attractors(p, states, settling, workers=1) -> Attractors:
    """Return the attracting orbits that states at a strobe lead to.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters without a damper.
    states : array, shape (n, 2)
        Z1 and Z1' at the strobe.
    settling : Settling
    workers : int
        Threads.
    """
    starts = np.tile(np.asarray(states, float).reshape(-1, 2), 2)
    found = ensemble.settle(
        np.tile(p, (len(starts), 1)), starts, settling, from_strobe=True, workers=workers
    )
    return with_neighbourhoods(p, _distinct(p, found[is_settled(found)]))


def with_neighbourhoods(p, records) -> Attractors:
    """Return orbits, given by their records, with the neighbourhoods of their strobe states."""
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


def _distinct(p, found):
    """Return one record of each orbit, by rising max |Z1|; mirror images are two orbits."""
    kept, seen = [], []
    for record in found[np.argsort(found["maximum_displacement"], kind="stable")]:
        known = any(
            len(orbit) == record["period"]
            and np.min(np.max(np.abs(orbit - record["state"][:2]), axis=1)) < ALIKE
            for orbit in seen
        )
        if not known:
            kept.append(record)
            seen.append(strobe_states(p, record))
    return np.array(kept, found.dtype)


def linear_flow(p, state, periods):
    """Return Z1 of an orbit and its matrices F(t) at STEPS times a forcing period, with the end.

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

    Infinite if the proof fails, as for an orbit that is not stable.
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
    cubic = abs(p[CUBIC])
    coefficients = np.array(
        [3 * cubic * kick * np.abs(displacement) * gain**2, cubic * kick * gain**3]
    )
    largest = np.maximum(coefficients[:, :-1], coefficients[:, 1:])
    radius = _radius(largest, 2 * np.pi / (STEPS * p[FREQUENCY]), np.max(np.abs(values)))
    with np.errstate(divide="ignore"):
        return np.linalg.inv(vectors) / radius


def _radius(coefficients, step, contraction):
    """Return the largest r whose bound after the period, times the contraction, is below r.

    In a step the bound r' = a r^2 + b r^3 is at most a r^2 + b r^3 with the r at the end of the
    step, so that r(end) solves r = r(begin) + step (a r^2 + b r^3); three iterations from above.
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
