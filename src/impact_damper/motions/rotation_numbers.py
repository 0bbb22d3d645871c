"""Rotation numbers of quasi-periodic motions, by weighted Birkhoff averages.

On a closed curve that a map turns by a fixed share of a revolution, the rotation number, the
average of a smooth function over N iterates converges as 1/N. With weights that vanish at both ends
with all derivatives it converges faster than any power of 1/N (S. Das, Y. Saiki, E. Sander and
J. A. Yorke, Nonlinearity 30, 4111-4140, 2017). On a chaotic orbit the weights do not help: there
the error falls as N^(-1/2). Averages over parts of an orbit therefore tell the two apart.
"""

import math
from typing import NamedTuple

import numpy as np

# Largest difference of the rotation number between parts of an orbit, if it is known.
AGREEMENT = 1e-8
# Least share of a revolution that no advance of the angle takes; there the advances are cut.
GAP = 0.02
# In the order of their phases: largest turn from point to point, and sum of all turns, whatever
# their sense, in revolutions.
TURN = 0.05
WANDERING = 3.0
# Fewest points of an orbit.
FEWEST = 100


class Rotation(NamedTuple):
    """How a map turns a closed curve.

    Attributes
    ----------
    number : float
        Rotation number, revolutions per iterate, from 0 to 1/2.
    error : float
        Largest difference between the rotation numbers of three halves of the orbit: the first, the
        middle and the last.
    """

    number: float
    error: float

    @property
    def known(self):
        """Whether the error is at most AGREEMENT."""
        return self.error <= AGREEMENT


def birkhoff_average(values):
    """Return the average of values along an orbit, weighted by exp(-1/(t (1 - t))), t from 0 to 1.

    Parameters
    ----------
    values : array, shape (n,)
    """
    t = np.arange(1, len(values) + 1) / (len(values) + 1)
    weights = np.exp(-1 / (t * (1 - t)))
    return np.sum(weights * values) / np.sum(weights)


def find_rotation(points):
    """Return how a map turns the closed curve on which an orbit lies, or None if it lies on none.

    The rotation number is the average advance of the angle around the average of the points, which
    are stretched so that they spread equally in all directions: on a slender curve the angle hardly
    advances but at the two ends, and its average converges slowly. In the order of their phases by
    this number points on a closed curve go around once; on other sets they jump from side to side.

    Parameters
    ----------
    points : array of complex, shape (n,)
        Successive points of the orbit in a plane.

    Returns
    -------
    Rotation or None
    """
    if len(points) < FEWEST:
        return None
    angle = np.angle(_rounded(points)) / (2 * math.pi)
    advance = np.diff(angle) % 1
    # the advances, a set on a circle, are cut open in the widest gap between them
    order = np.sort(advance)
    gaps = np.diff(order, append=order[0] + 1)
    widest = np.argmax(gaps)
    if gaps[widest] < GAP:
        return None
    cut = order[widest] + gaps[widest] / 2
    advance = (advance - cut) % 1 + cut
    number = birkhoff_average(advance)
    if not _goes_around_once(angle, number):
        return None
    half, quarter = len(advance) // 2, len(advance) // 4
    parts = [birkhoff_average(advance[k : k + half]) for k in (0, quarter, len(advance) - half)]
    return Rotation(float(min(number % 1, -number % 1)), float(np.ptp(parts)))


def _rounded(points):
    """Return points relative to their average, stretched to equal spread in all directions."""
    apart = points - birkhoff_average(points)
    plane = np.stack([apart.real, apart.imag])
    spread, axes = np.linalg.eigh(plane @ plane.T)
    x, y = axes.T @ plane
    return x * math.sqrt(max(spread[1], 0.0)) + 1j * y * math.sqrt(max(spread[0], 0.0))


def _goes_around_once(angle, number):
    """Return whether angles, in revolutions, go around once in the order of their phases."""
    order = np.argsort(np.arange(len(angle)) * number % 1)
    turns = np.diff(angle[order], append=angle[order[0]])
    turns -= np.round(turns)
    once = abs(round(np.sum(turns))) == 1
    return bool(once and np.max(np.abs(turns)) < TURN and np.sum(np.abs(turns)) < WANDERING)
