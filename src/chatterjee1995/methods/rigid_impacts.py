"""The rigid-impact model: flights between rigid walls, and instantaneous impacts.

Z1 is the displacement of the primary mass, and Z2 the displacement of the primary mass relative to
the loose mass. An impact changes Z2' to -e Z2', with the restitution e, and conserves the momentum
Z1' + rm (Z1' - Z2'), with the mass ratio rm. The model is the limit of equations (20) to (25) for
an infinite contact stiffness r1. In this limit an impact takes no time, so forces other than the
contact force change no velocity during the impact.

W is the forcing frequency, and T the time. Numbers in brackets are equations of the paper.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.equation import acceleration
from impact_damper.kernel.instances import FLIGHT_ORDER
from impact_damper.kernel.single import X, workspace
from impact_damper.kernel.tangents import step_with_tangents
from impact_damper.model.packed import DAMPING, FREQUENCY, INVERSE_MASS_RATIO
from impact_damper.motions.records import extremum
from impact_damper.motions.strobe_map import strobe_time

# Number of impacts in a forcing cycle at which the integration stops. With e < 1 an infinite number
# of impacts can follow each other in a finite time.
MOST_IMPACTS = 200


@kernel
def rebound(p, restitution, y, tangents, t):
    """Apply an instantaneous impact to a state y and to small changes of the state, in place.

    The saltation matrix S maps a small change d of the state before the impact to the change after
    it. Each row of `tangents` is such a d. With k = (1 + e)/(1 + 1/rm), the damping h and the
    acceleration a of Z1 before the impact,

        Z1' -> Z1' - k Z2',   Z2' -> -e Z2',
        d(Z1, Z1', Z2, Z2') -> S d,   S = [1 0 -k 0; 0 1 k (a/Z2' + h) -k;
                                           0 0 -e 0; 0 0 (1 + e) a/Z2' + h k -e].

    The determinant of S is e^2: an impact multiplies volumes of the state space by e^2.
    """
    gain = (1.0 + restitution) / (1.0 + p[INVERSE_MASS_RATIO])
    speed = y[3]
    pull = acceleration(p, y, t) / speed
    for i in range(tangents.shape[0]):
        d = tangents[i]
        shift, relative = d[2], d[3]
        d[0] -= gain * shift
        d[1] += gain * ((pull + p[DAMPING]) * shift - relative)
        d[2] = -restitution * shift
        d[3] = ((1.0 + restitution) * pull + p[DAMPING] * gain) * shift - restitution * relative
    y[1] -= gain * speed
    y[3] = -restitution * speed


@kernel
def rigid_map(p, restitution, y, tolerance):
    """Integrate the rigid model over one forcing cycle, from the forcing phase W T = pi/2.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters (`packed.pack`). The dashpot must be 0. The stiffness r1 has no effect.
    restitution : float
        e.
    y : array, shape (4,)
        Z1, Z1', Z2, Z2' at the beginning, with the loose mass between the walls.
    tolerance : float
        Largest local error of a step.

    Returns
    -------
    state : array, shape (4,)
        State after the cycle.
    matrix : array, shape (4, 4)
        Derivative of this state with respect to `y`.
    impacts : int
        Number of impacts. If it is MOST_IMPACTS, the integration stopped before the end of the
        cycle, and the other return values are invalid.
    speed : float
        Smallest |Z2'| just before an impact, infinite without impacts.
    first : tuple of two floats
        |Z2'| and the acceleration of Z1 just before the first impact, the acceleration positive
        towards the wall that is hit; NaN without impacts.
    largest : float
        Largest |Z1|.
    """
    state = y.copy()
    tangents = np.eye(4)
    work = workspace()
    flight = np.int64(0)  # not the literal 0, for which numba would compile the step again
    t = strobe_time(p)
    end = t + 2.0 * math.pi / p[FREQUENCY]
    impacts, speed, first, largest = 0, math.inf, (math.nan, math.nan), abs(y[0])
    while t < end and impacts < MOST_IMPACTS:
        length, side = step_with_tangents(p, state, tangents, flight, t, end - t, tolerance, work)
        # |Z1| can also be largest at an impact, where Z1' jumps.
        largest = max(extremum(work[X:], FLIGHT_ORDER, length, largest), abs(state[0]))
        t = end if length >= end - t else t + length
        if side != 0:
            if impacts == 0:
                first = abs(state[3]), side * acceleration(p, state, t)
            speed = min(speed, abs(state[3]))
            impacts += 1
            rebound(p, restitution, state, tangents, t)
    return state, tangents.T.copy(), impacts, speed, first, largest
