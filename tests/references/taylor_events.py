"""Motions by heyoka.py with terminal events, independent of the package's integrators (kernels).

State and parameters are the same as for the kernels: (Z1, Z1', Z2, Z2') and the packed parameters
of `model.packed.pack`.
"""

import math
from typing import NamedTuple

import heyoka
import numpy as np

from impact_damper.model import packed
from references import equation

# Larger clearances are replaced by this one. heyoka's tolerance is relative to the largest term of
# the events, so a distant wall would make the integration inaccurate.
BEYOND_ALL_MOTIONS = 16.0
# Number of parameters in flight (False) and in contact (True). The parameters in flight come first,
# and the wall in contact is the last parameter.
PARAMETERS = {False: packed.CLEARANCE + 1, True: packed.COUNT + 1}


class Run(NamedTuple):
    """States (n, 4) at given times, and contacts (k, 5): wall, beginning, end, Z2' at both."""

    states: np.ndarray
    contacts: np.ndarray


def systems_and_events():
    """Return heyoka's equations and terminal events in flight (False) and in contact (True)."""
    x, v, z, w = heyoka.make_vars("x", "v", "z", "w")
    *p, side = [heyoka.par[i] for i in range(packed.COUNT + 1)]
    free = equation.flight(p, x, v, heyoka.cos(p[packed.FREQUENCY] * heyoka.time))
    force = equation.contact(p, side, z, w)
    clearance, inverse_mass = p[packed.CLEARANCE], p[packed.INVERSE_MASS_RATIO]
    rising, falling = heyoka.event_direction.positive, heyoka.event_direction.negative
    entries = [
        heyoka.t_event(z - clearance, direction=rising),
        heyoka.t_event(z + clearance, direction=falling),
    ]
    separation = [heyoka.t_event(side * z - clearance, direction=falling)]
    pushed = [(x, v), (v, free - force), (z, w), (w, free - force - inverse_mass * force)]
    systems = {False: [(x, v), (v, free), (z, w), (w, free)], True: pushed}
    return systems, {False: entries, True: separation}


class Reference:
    """Integrator that switches between flight and contact at terminal events.

    `longest` is the longest step. Two runs with different limits verify that no contact is missed.
    With `tangents` the state is followed by its derivative by the first state, (4, 4) in one row.
    """

    def __init__(self, longest=math.inf, tangents=False):
        self.longest, self.tangents = longest, tangents
        systems, events = systems_and_events()
        self.integrators = {}
        for touching, system in systems.items():
            if tangents:
                system = heyoka.var_ode_sys(system, heyoka.var_args.vars, order=1)
            self.integrators[touching] = heyoka.taylor_adaptive(
                system,
                np.zeros(20 if tangents else 4),
                pars=np.zeros(PARAMETERS[touching]),
                t_events=events[touching],
                compact_mode=tangents,
            )

    def _leg(self, p, side, state, t, end):
        """Integrate to the next event or to the end; return outcome, state and time."""
        motion = self.integrators[side != 0]
        motion.time = t
        motion.state[:] = state
        motion.reset_cooldowns()
        motion.pars[:] = np.append(p, side)[: len(motion.pars)]
        motion.pars[packed.CLEARANCE] = min(p[packed.CLEARANCE], BEYOND_ALL_MOTIONS)
        outcome = motion.propagate_until(end, max_delta_t=self.longest)[0]
        return outcome, motion.state.copy(), motion.time

    def run(self, p, state, start, times, side=0):
        """Integrate from `start` through increasing times; `side` is the first wall in contact."""
        t, clearance = start, min(p[packed.CLEARANCE], BEYOND_ALL_MOTIONS)
        contacts = [[side, t, np.nan, state[3], np.nan]] if side else []
        if self.tangents:
            state = np.append(state, np.eye(4))
        samples = []
        while len(samples) < len(times):
            outcome, state, t = self._leg(p, side, state, t, times[len(samples)])
            if outcome == heyoka.taylor_outcome.time_limit:
                samples.append(state)
                continue
            before, wall = side, side or (1 if int(outcome) == -1 else -1)
            if side:
                contacts[-1][2::2] = t, state[3]
                side = 0
            else:
                contacts.append([wall, t, np.nan, state[3], np.nan])
                side = wall
            if self.tangents:
                state[2] = wall * clearance
                _jump(p, before, side, t, state)
            # On the wall itself heyoka could miss a separation within the same step.
            state[2] = wall * np.nextafter(clearance, math.inf if side else 0.0)
        return Run(np.array(samples), np.array(contacts).reshape(-1, 5))


def _jump(p, before, after, t, state):
    """Change the tangents at an event, the beginning or end of a contact, in place.

    A tangent d becomes d + (f_after - f_before) (n d)/(n f_before), with the normal n of the wall
    and the vector field f before and after the event (Leine and Nijmeijer, Dynamics and
    Bifurcations of Non-Smooth Mechanical Systems, 2004, section 7).
    """
    old, new = (np.array(equation.rates(p, each)(t, state[:4])) for each in (before, after))
    tangents = state[4:].reshape(4, 4)
    tangents += np.outer(new - old, tangents[2]) / old[2]
