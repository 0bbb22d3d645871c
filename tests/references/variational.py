"""Monodromy matrices by heyoka's variational equations, with jumps at events from a textbook.

The monodromy matrix is the derivative of the state after a period with respect to the first state;
its columns are tangents, small disturbances of the state. At an event, the beginning or end of a
contact, a tangent d becomes d + (f_after - f_before) (n d)/(n f_before), with the normal n of the
wall and the vector field f before and after the event (Leine and Nijmeijer, Dynamics and
Bifurcations of Non-Smooth Mechanical Systems, 2004, section 7).
"""

import math

import heyoka
import numpy as np

from impact_damper.model.packed import CLEARANCE, COUNT
from references import equation
from references.taylor_events import BEYOND_ALL_MOTIONS, PARAMETERS, systems_and_events


class Variational:
    """Integrator of states and tangents through contacts."""

    def __init__(self):
        systems, events = systems_and_events()
        self.integrators = {
            touching: heyoka.taylor_adaptive(
                heyoka.var_ode_sys(systems[touching], heyoka.var_args.vars, order=1),
                np.concatenate([np.zeros(4), np.eye(4).ravel()]),
                pars=np.zeros(PARAMETERS[touching]),
                t_events=events[touching],
                compact_mode=True,
            )
            for touching in (False, True)
        }

    def monodromy(self, p, state, begin, length):
        """Return the state after a time `length` and its derivative by the first state, (4, 4).

        At the beginning the loose mass must touch no wall.
        """
        pars = np.append(p, 0.0)
        pars[CLEARANCE] = min(p[CLEARANCE], BEYOND_ALL_MOTIONS)
        full = np.concatenate([state, np.eye(4).ravel()])
        t, side, end = begin, 0, begin + length
        while True:
            motion = self.integrators[side != 0]
            pars[COUNT] = side
            motion.pars[:] = pars[: len(motion.pars)]
            motion.time = t
            motion.state[:] = full
            motion.reset_cooldowns()
            outcome = motion.propagate_until(end)[0]
            full, t = motion.state.copy(), motion.time
            if outcome == heyoka.taylor_outcome.time_limit:
                return full[:4], full[4:].reshape(4, 4)
            before = pars.copy()
            if side:
                after_side, wall, beyond = 0, side, 0.0
            else:
                after_side = wall = 1 if int(outcome) == -1 else -1
                beyond = math.inf
            pars[COUNT] = before[COUNT] = wall
            full[2] = wall * pars[CLEARANCE]
            fields = [np.array(equation.rates(before, each)(t, full[:4])) for each in (0, wall)]
            old, new = fields if not side else fields[::-1]
            tangents = full[4:].reshape(4, 4)
            tangents += np.outer(new - old, tangents[2]) / old[2]
            full[2] = wall * np.nextafter(pars[CLEARANCE], beyond)
            side = after_side
