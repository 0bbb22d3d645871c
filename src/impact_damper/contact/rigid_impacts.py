"""The rigid-impact model: free flight between rigid walls, and instantaneous impacts.

An impact changes Z2' to -e Z2' and keeps the momentum Z1' + rm (Z1' - Z2'). This is the limit of
the contact of equations (20) to (25) as r1 goes to infinity, where forces other than that of the
contact have no time to act.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.equation import acceleration
from impact_damper.kernel.instances import FLIGHT_ORDER
from impact_damper.kernel.single import X, step, workspace
from impact_damper.motions.records import extremum
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.system.packed import DAMPING, FREQUENCY, INVERSE_MASS_RATIO

# Largest number of impacts in a forcing period: with e < 1 infinitely many may follow each other.
MOST_IMPACTS = 200


@kernel
def rebound(p, restitution, y, tangents, t):
    """Apply an instantaneous impact to a state, and its saltation matrix to the tangents, in place.

    With k = (1 + e)/(1 + 1/rm) and the acceleration a of Z1 before the impact,

        Z1' -> Z1' - k Z2',   Z2' -> -e Z2',
        d(Z1, Z1', Z2, Z2') -> S d,   S = [1 0 -k 0; 0 1 k (a/Z2' + h) -k;
                                           0 0 -e 0; 0 0 (1 + e) a/Z2' + h k -e].

    The determinant of S is e^2, the factor by which an impact shrinks volumes of the state space.
    """
    share = (1.0 + restitution) / (1.0 + p[INVERSE_MASS_RATIO])
    speed = y[3]
    pull = acceleration(p, y, t) / speed
    for i in range(tangents.shape[0]):
        d = tangents[i]
        shift, relative = d[2], d[3]
        d[0] -= share * shift
        d[1] += share * ((pull + p[DAMPING]) * shift - relative)
        d[2] = -restitution * shift
        d[3] = ((1.0 + restitution) * pull + p[DAMPING] * share) * shift - restitution * relative
    y[1] -= share * speed
    y[3] = -restitution * speed


@kernel
def rigid_map(p, restitution, y, tolerance):
    """Integrate the rigid model over one forcing period, from W T = pi/2.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters (`packed.pack`) with dashpot 0; r1 has no effect.
    restitution : float
        e.
    y : array, shape (4,)
        Z1, Z1', Z2, Z2' between the walls.
    tolerance : float
        Local error allowed.

    Returns
    -------
    state : array, shape (4,)
    matrix : array, shape (4, 4)
        Derivative of the map.
    impacts : int
        Number of impacts. If it is MOST_IMPACTS the period was not finished: the rest is void.
    speed : float
        Smallest |Z2'| at which a wall is approached, infinite without impacts.
    first : tuple of two floats
        |Z2'| at the first impact and the acceleration of Z1 towards that wall before it, NaN
        without impacts.
    largest : float
        Largest |Z1|.
    """
    state = y.copy()
    tangents = np.eye(4)
    work = workspace()
    flight = np.int64(0)  # for a literal the step would be compiled once more
    t = strobe_time(p)
    end = t + 2.0 * math.pi / p[FREQUENCY]
    impacts, speed, first, largest = 0, math.inf, (math.nan, math.nan), abs(y[0])
    while t < end and impacts < MOST_IMPACTS:
        length, side = step(p, state, tangents, flight, t, end - t, tolerance, work)
        # Z1 may be largest at an impact, where Z1' changes its sign in a jump
        largest = max(extremum(work[X:], FLIGHT_ORDER, length, largest), abs(state[0]))
        t = end if length >= end - t else t + length
        if side != 0:
            if impacts == 0:
                first = abs(state[3]), side * acceleration(p, state, t)
            speed = min(speed, abs(state[3]))
            impacts += 1
            rebound(p, restitution, state, tangents, t)
    return state, tangents.T.copy(), impacts, speed, first, largest
