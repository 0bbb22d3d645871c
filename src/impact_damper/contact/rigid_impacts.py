"""The rigid-impact model: free flight between rigid walls, and instantaneous impacts.

Z1 is the displacement of the primary mass and Z2 that of the primary mass relative to the loose
mass. An impact changes Z2' to -e Z2', with the restitution e, and keeps the momentum
Z1' + rm (Z1' - Z2'), with the mass ratio rm. This is the limit of
the contact of equations (20) to (25) as the contact stiffness r1 goes to infinity: an impact takes
no time, so only the force of the contact changes velocities in it.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.equation import acceleration
from impact_damper.kernel.instances import FLIGHT_ORDER
from impact_damper.kernel.single import X, step, workspace
from impact_damper.motions.extrema import extremum
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.system.packed import DAMPING, FREQUENCY, INVERSE_MASS_RATIO

# Impacts in a forcing period at which it is given up: with e < 1 infinitely many may follow.
MOST_IMPACTS = 200


@kernel
def rebound(p, restitution, y, tangents, t):
    """Apply an instantaneous impact in place: to a state y, and its derivative S to `tangents`.

    S, the saltation matrix, maps a small change d of the state before the impact to that after it;
    each row of `tangents` is such a d.

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
    """Integrate the rigid model over one forcing period, from the forcing phase W T = pi/2.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters (`packed.pack`); the dashpot must be 0, r1 has no effect.
    restitution : float
        e.
    y : array, shape (4,)
        Z1, Z1', Z2, Z2' at the beginning, with the loose mass between the walls.
    tolerance : float
        Local error allowed in a step.

    Returns
    -------
    state : array, shape (4,)
        State after the period.
    matrix : array, shape (4, 4)
        Derivative of this state with respect to `y`.
    impacts : int
        Number of impacts. If it is MOST_IMPACTS, the period was not finished, and the other return
        values are invalid.
    speed : float
        Smallest |Z2'| at which a wall is approached, infinite without impacts.
    first : tuple of two floats
        |Z2'| just before the first impact, and the acceleration of Z1 then, positive towards the
        wall that is hit; NaN without impacts.
    largest : float
        Largest |Z1|.
    """
    state = y.copy()
    tangents = np.eye(4)
    work = workspace()
    flight = np.int64(0)  # not the literal 0, for which numba would compile `step` again
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
