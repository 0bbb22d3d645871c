"""Rotation numbers of quasi-periodic motions, by weighted Birkhoff averages.

The states of a quasi-periodic motion at the strobe, the time of the phase W T = pi/2 in each
forcing cycle, lie on a closed curve. From one strobe to the next the states move along the curve,
on average by a fraction of a revolution that is called the rotation number. The average of a smooth
function over N successive states converges as 1/N. With weights that vanish at both ends with all
derivatives it converges faster than any power of 1/N (S. Das, Y. Saiki, E. Sander and J. A. Yorke,
Nonlinearity 30, 4111-4140, 2017). On a chaotic motion the error falls as N^(-1/2) even with these
weights. Therefore the averages over parts of an orbit agree only if the motion is quasi-periodic.
"""

import math
from typing import NamedTuple

import numpy as np

# The rotation number counts as known if the results for parts of an orbit differ by at most
# AGREEMENT.
AGREEMENT = 1e-8
# The advances of the angle from point to point, as points on a circle, must leave an interval of at
# least INTERVAL revolutions empty. The circle is cut in this interval.
INTERVAL = 0.02
# The points of an orbit are sorted by their phases. TURN: largest change of the angle between
# neighbouring points. WANDERING: largest sum of the moduli of all changes. Both in revolutions.
TURN = 0.05
WANDERING = 3.0
# Smallest number of points of an orbit.
FEWEST = 100


class Rotation(NamedTuple):
    """Rotation number of a map on a closed curve.

    Attributes
    ----------
    number : float
        Rotation number, revolutions per iterate, from 0 to 1/2.
    error : float
        Largest difference between the rotation numbers of the first, the middle and the last half
        of the orbit.
    """

    number: float
    error: float

    @property
    def known(self):
        """True if the error is at most AGREEMENT."""
        return self.error <= AGREEMENT


def birkhoff_average(values):
    """Return the average of values along an orbit, weighted by exp(-1/(t (1 - t))).

    Parameters
    ----------
    values : array, shape (n,)
        Values at the times t = k/(n + 1), k = 1 ... n, between 0 and 1.
    """
    t = np.arange(1, len(values) + 1) / (len(values) + 1)
    weights = np.exp(-1 / (t * (1 - t)))
    return np.sum(weights * values) / np.sum(weights)


def find_rotation(points):
    """Return the `Rotation` of a map on the closed curve on which an orbit lies, or None.

    The rotation number is the average advance of the angle around the average of the points.
    Before, the points are stretched to have the same spread in all directions. On a slender curve
    the angle would advance mainly at the two ends, and its average would converge slowly. The
    result is None if the orbit lies on no closed curve. To test this, the points are sorted by the
    phases that follow from the rotation number. On a closed curve the sorted points go around once;
    on other sets they jump from side to side.

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
    # The advances are points on a circle, which is cut in the widest interval between them.
    order = np.sort(advance)
    intervals = np.diff(order, append=order[0] + 1)
    widest = np.argmax(intervals)
    if intervals[widest] < INTERVAL:
        return None
    cut = order[widest] + intervals[widest] / 2
    advance = (advance - cut) % 1 + cut
    number = birkhoff_average(advance)
    if not _goes_around_once(angle, number):
        return None
    half, quarter = len(advance) // 2, len(advance) // 4
    parts = [birkhoff_average(advance[k : k + half]) for k in (0, quarter, len(advance) - half)]
    return Rotation(float(min(number % 1, -number % 1)), float(np.ptp(parts)))


def _rounded(points):
    """Return points relative to their average, stretched to the same spread in all directions."""
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
