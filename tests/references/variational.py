"""Monodromy matrices by heyoka's variational equations, with jumps at events from a textbook.

At an event a tangent d becomes d + (f_after - f_before) (n d)/(n f_before), with the normal n of
the wall and the vector field f before and after the event (Leine and Nijmeijer, Dynamics and
Bifurcations of Non-Smooth Mechanical Systems, 2004, section 7).
"""

import math

import heyoka
import numpy as np

from impact_damper.system.packed import CLEARANCE, COUNT
from references.taylor_events import BEYOND_ALL_MOTIONS, PARAMETERS


def _fields():
    x, v, z, w = heyoka.make_vars("x", "v", "z", "w")
    pars = [heyoka.par[i] for i in range(COUNT + 1)]
    free, force, inverse_mass = _forces(pars, (x, v, z, w), heyoka.cos(pars[0] * heyoka.time))
    flight = [(x, v), (v, free), (z, w), (w, free)]
    contact = [(x, v), (v, free - force), (z, w), (w, free - force - inverse_mass * force)]
    return flight, contact, z, pars[CLEARANCE], pars[COUNT]


def _forces(pars, state, cosine):
    """Return acceleration in flight, force of the contact, and primary mass over loose mass."""
    frequency, damping, stiffness, cubic, amplitude, unbalance, shaker, *contact, side = pars
    clearance, spring, inverse_mass, dashpot = contact
    x, v, z, w = state
    amplitude = amplitude + unbalance * frequency**2 + shaker / frequency**2
    free = amplitude * cosine - damping * v
    free = free - stiffness * x - cubic * x * x * x
    return free, spring * (z - side * clearance) + dashpot * w, inverse_mass


def field(pars, state, t, touching):
    """Return the vector field at a state, in flight or in contact."""
    free, force, inverse_mass = _forces(pars, state, math.cos(pars[0] * t))
    force *= touching
    return np.array([state[1], free - force, state[3], free - force - inverse_mass * force])


class Variational:
    """Integrator of states and tangents through contacts."""

    def __init__(self):
        flight, contact, z, clearance, side = _fields()
        rising, falling = heyoka.event_direction.positive, heyoka.event_direction.negative
        events = {
            False: [
                heyoka.t_event(z - clearance, direction=rising),
                heyoka.t_event(z + clearance, direction=falling),
            ],
            True: [heyoka.t_event(side * z - clearance, direction=falling)],
        }
        self.integrators = {}
        for touching, system in ((False, flight), (True, contact)):
            self.integrators[touching] = heyoka.taylor_adaptive(
                heyoka.var_ode_sys(system, heyoka.var_args.vars, order=1),
                np.concatenate([np.zeros(4), np.eye(4).ravel()]),
                pars=np.zeros(PARAMETERS[touching]),
                t_events=events[touching],
                compact_mode=True,
            )

    def monodromy(self, p, state, begin, length):
        """Return state and derivative (4, 4) of the flow over a length of time from a flight."""
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
            fields = [field(before, full[:4], t, touching) for touching in (False, True)]
            old, new = fields if not side else fields[::-1]
            tangents = full[4:].reshape(4, 4)
            tangents += np.outer(new - old, tangents[2]) / old[2]
            full[2] = wall * np.nextafter(pars[CLEARANCE], beyond)
            side = after_side
